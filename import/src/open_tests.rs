//! What becomes of files.

use super::*;

const TABLE: &str = "time,mag\n0.0,50000.5\n0.1,50000.6\n0.2,50000.7\n";

fn file(name: &str, bytes: impl Into<Vec<u8>>) -> Input {
    Input::File(File { name: name.into(), bytes: bytes.into() })
}

fn opened(bytes: impl Into<Vec<u8>>) -> Result<Opened, ImportError> {
    open(vec![file("a.csv", bytes)], &Options::default()).map(|mut all| all.remove(0))
}

fn refusal(bytes: impl Into<Vec<u8>>, text: TextProfile) -> String {
    let profile = crate::profile::Profile { text, ..Default::default() };
    open(vec![file("a.csv", bytes)], &Options { profile, ..Options::default() }).unwrap_err().to_string()
}

#[test]
fn what_is_not_usual_of_a_text_is_told() {
    let usual = opened(TABLE).unwrap();
    assert!(usual.findings.is_empty(), "{:?}", usual.findings);
    assert_eq!(usual.text.delimiter.as_deref(), Some("comma"));
    let odd = opened("made by x\nZeit [s];Feld [\u{b5}T];Tiefe\n0,0;50,5;1,5\n0,1;50,6;1,6\n").unwrap();
    let wanted = "fields are parted by semicolon; decimals stand behind a comma; the names stand in line 2";
    assert_eq!(odd.findings[0].text, wanted);
    let western = opened(b"time,temp [\xb0C]\n0,5\n1,6\n".to_vec()).unwrap();
    assert_eq!(western.findings[0].text, "the text is windows-1252");
    let no_header = opened("0.0,1\n0.1,2\n0.2,3\n").unwrap();
    assert_eq!(no_header.findings[0].text, "there is no header");
}

#[test]
fn what_cannot_be_read_is_answered_with_what_to_do() {
    let none = TextProfile::default;
    let asked = |delimiter: &str, decimal: &str, encoding: &str| {
        let told = |what: &str| Some(what.to_string()).filter(|what| !what.is_empty());
        TextProfile { delimiter: told(delimiter), decimal: told(decimal), encoding: told(encoding) }
    };
    let binary: Vec<u8> = (0..400_u32).map(|at| (at * 37 % 256) as u8).collect();
    for (bytes, text, wanted) in [
        (Vec::new(), none(), "copy it again"),
        (binary, none(), "export it as text"),
        (b"time,mag\n".to_vec(), none(), "has a header and no rows"),
        (b"Dear all,\nplease find it elsewhere.\n".to_vec(), none(), "--delimiter"),
        (TABLE.into(), asked("dash", "", ""), "comma, semicolon, tab, bar, blanks"),
        (TABLE.into(), asked("", "dash", ""), "point, comma"),
        (TABLE.into(), asked("", "", "klingon"), "utf-8, utf-16le, windows-1252"),
    ] {
        let refusal = refusal(bytes, text);
        assert!(refusal.contains(wanted), "{refusal}");
    }
}

#[test]
fn a_definition_takes_its_data_along() {
    let definition = "DEFN  1 ST=RECD,RT=;Line:i10\nDEFN  2 ST=RECD,RT=;Mag:f10.2;END DEFN\n";
    let data = "       101  50000.50\n       101  50000.60\n";
    for files in [[("a.dfn", definition), ("a.dat", data)], [("a.dat", data), ("a.dfn", definition)]] {
        let inputs = files.map(|(name, text)| file(name, text)).to_vec();
        let opened = open(inputs, &Options::default()).unwrap();
        assert_eq!(opened.len(), 1);
        assert_eq!((opened[0].source.format, opened[0].source.tables[0].rows), ("ASEG-GDF2", 2));
    }
}

#[test]
fn of_several_tables_the_longest_or_the_one_asked_for_is_taken() {
    let table_of = |name: &str, rows: usize| SourceTable { name: name.into(), rows, ..SourceTable::default() };
    let tables = vec![table_of("notes", 2), table_of("tow", 9), table_of("calibration", 9)];
    let source = Source { file: "a.xlsx".into(), format: "workbook", tables };
    let (taken, findings) = table(&source, None).unwrap();
    assert_eq!(taken.name, "tow");
    assert_eq!(findings[0].text, "\"tow\" was taken of its parts; there are also notes, calibration");
    assert_eq!(table(&source, Some("Calibration")).unwrap().0.name, "calibration");
    let refusal = table(&source, Some("map")).unwrap_err().to_string();
    assert!(refusal.contains("it has notes, tow, calibration"), "{refusal}");
    let empty = Source { tables: vec![table_of("tow", 0)], ..source };
    assert!(table(&empty, None).unwrap_err().to_string().contains("is it the right file"));
}
