use super::*;

const EXPORT: &str = "\
/ ------------------------------------------------------------------------------
/ XYZ EXPORT [03/14/2022]
/ DATABASE   [.\\survey.gdb]
/ ------------------------------------------------------------------------------
/
/    X          Y     MAG[nT]     CLOCK
/======== ======= ========= ==========

//Flight 7
//Date 2020/01/31
Line 101
   500.1   4200.5   49895.13   10:00:00
   500.2   4200.6          *   10:00:01
Tie 5
//Flight 8
   500.3   -1e32    oops       10:00:02
   500.3   4200.5
   500.4   4200.7   1e32       *
";

fn read(text: &str) -> SourceTable {
    let input = Input { file: "a.xyz", bytes: text.as_bytes(), companions: &[], part: None };
    GeosoftXyz.read(&input).unwrap().tables.remove(0)
}

fn texts(table: &SourceTable, column: usize) -> Vec<&str> {
    let Values::Text(texts) = &table.columns[column].values else { panic!("{:?}", table.columns[column]) };
    texts.iter().map(|text| &**text).collect()
}

#[test]
fn records_become_columns_of_text() {
    let table = read(EXPORT);
    let names: Vec<_> = table.columns.iter().map(|column| &column.name[..]).collect();
    assert_eq!(names, ["line", "flight", "date", "X", "Y", "MAG", "CLOCK"]);
    assert_eq!(texts(&table, 0), ["101", "101", "T5", "T5"]);
    assert_eq!(texts(&table, 1), ["7", "7", "8", "8"]);
    assert_eq!(texts(&table, 2), ["2020/01/31"; 4]);
    assert_eq!(texts(&table, 6), ["10:00:00", "10:00:01", "10:00:02", ""]);
    assert_eq!(table.facts.date, Some((2020, 1, 31)));
}

#[test]
fn dummies_are_missing_and_bad_cells_are_counted() {
    let table = read(EXPORT);
    let numbers = |column: usize| format!("{:?}", table.columns[column].as_numbers().unwrap());
    assert_eq!(numbers(3), "[500.1, 500.2, 500.3, 500.4]");
    assert_eq!(numbers(4), "[4200.5, 4200.6, NaN, 4200.7]");
    assert_eq!(numbers(5), "[49895.13, NaN, NaN, NaN]");
    assert_eq!(table.columns[5].unit.as_deref(), Some("nT"));
    assert_eq!((table.rows, &table.places[..]), (4, &[12, 13, 16, 18][..]));
    let notes: Vec<_> = table.notes.iter().map(|note| &note.text[..]).collect();
    let wanted = [
        "1 cell is no number and counts as missing: \"oops\" in line 16",
        "1 cell holds a mark that stands for \"missing\": \"*\" in line 13",
        "1 line without the 4 fields of the first is left out: in line 17",
    ];
    assert_eq!(notes, wanted);
}

#[test]
fn without_names_columns_have_numbers() {
    let table = read("/ of the survey\nL1\n1,2\n3,4\n");
    let names: Vec<_> = table.columns.iter().map(|column| &column.name[..]).collect();
    assert_eq!(names, ["line", "column_1", "column_2"]);
    assert_eq!(table.notes[0].kind, FindingKind::Missing);
}

#[test]
fn units_may_have_a_comment_of_their_own() {
    for units in ["m m nT -", "[m] (m) [nT] [-]"] {
        let table = read(&format!("/ of a survey again\n/ X Y MAG FID\n/ {units}\n/ = = = =\nLine 1\n1 2 3 4\n"));
        let columns: Vec<_> = table.columns.iter().map(|c| (&c.name[..], c.unit.as_deref().unwrap_or(""))).collect();
        assert_eq!(columns, [("line", ""), ("X", "m"), ("Y", "m"), ("MAG", "nT"), ("FID", "")]);
    }
}

#[test]
fn a_cut_last_line_is_left_out() {
    for end in ["3 4", "3 4.1", "3"] {
        let table = read(&format!("/ X MAG\nLine 1\n1 2.25\n2 3.25\n{end}"));
        assert_eq!((table.rows, table.notes[0].kind), (2, FindingKind::Truncated), "{end}");
    }
    let table = read("/ X MAG\nLine 1\n1 2.25\n2 3.25");
    assert_eq!((table.rows, table.notes.len()), (2, 0));
}

#[test]
fn it_is_known_by_its_records() {
    let recognised = |text: &str| GeosoftXyz.recognises(text.as_bytes());
    assert!(recognised(EXPORT));
    assert!(recognised("Line 1\n1 2\n"));
    assert!(recognised("1 2\n//date 2020/01/31\n3 4\n"));
    for text in [
        "",
        "/ X Y\n1 2\n",
        "X Y\nLine 1\n1 2\n",
        "Line 1\n",
        "Line 1\nField no 2\n",
        "// comment\n1 2\n",
        "a,b\n1,2\n",
    ] {
        assert!(!recognised(text), "{text:?}");
    }
}

#[test]
fn without_rows_it_is_refused() {
    let input = Input { file: "a.xyz", bytes: b"Line 1\n", companions: &[], part: None };
    assert_eq!(
        GeosoftXyz.read(&input).unwrap_err().to_string(),
        "a.xyz: a Geosoft XYZ file without rows: export it again, with its data"
    );
}
