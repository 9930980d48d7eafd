//! Whatever the bytes: no reader panics, and none makes more of a file than the file warrants.
use std::collections::HashSet;
use std::sync::Arc;

use proptest::prelude::*;
use towmag_import::formats::{FORMATS, Input, LARGEST_GROWTH};
use towmag_import::source::{Source, SourceTable, Values};

const XYZ: &str =
    "/ X Y MAG[nT]\n//flight 7\n//date 2020/01/31\nLine 101\n1.5 2 49895.131\n1.6 * 49895.2\nTie 5\n2,,-1e32\n";
const DEFINITION: &str = "DEFN 1 ST=RECD,RT=DATA;RT:A4;LINE:I5;MAG:F10.2:UNIT=nT:NULL=-9999.99\nDEFN 2 ST=RECD,RT=DATA;EM[2]:2f7.1;C:A4;END DEFN\n";
const DATA: &str = "COMM low\nDATA  101  49895.13    1.5    2.5good\nDATA  101  -9999.99 -999.9    2.5bad\nDATA";
const IAGA: &str = " Format                 IAGA-2002                 |\n IAGA CODE              BOU |\n\
    DATE       TIME         DOY     BOUH      BOUF   |\n2014-11-01 00:00:00.000 305     20873.75  99999.00\n2014-11-01 00:01:00.000 305     20873.75  88888.00\n";
const MGD: &str = "SURVEY_ID\tTIMEZONE\tDATE\tTIME\tLAT\tLON\tMAG_TOT\nEW1\t-2\t20200928\t1337.5\t10.5\t-20.25\t45012.3\nEW1\t0\t20200928\t1338\n";
const NMEA: &str = "$GNGGA,133753.000,5651.737132,N,02406.816782,E,2,12,0.79,8.366,M,23.853,M,,*7E\n\
    12:00:01 $GNRMC,133753.000,A,5651.737132,N,02406.816782,E,0.29,252.26,280920,,,D*78\n$GPHDT,274.07,T*03\n$SDDPT,12.5,0.5\n";
const POS: &str = "% program\n%  GPST  latitude(deg) longitude(d'\") height(m) Q\n2023/06/24 20:22:50.402 61.07 -139 08 09.5 1889.6 2\n2267 591770.402 61.07 -139 08 09.5 1889.6 2\n";
const NAMED: &str = "ULog\u{1}\u{12}5PK\u{3}\u{4}SQLite format 3\0";

const TEXTS: [&str; 8] = [XYZ, DEFINITION, DATA, IAGA, MGD, NMEA, POS, NAMED];

/// What a table holds in memory.
fn held(table: &SourceTable) -> usize {
    let mut seen: HashSet<*const u8> = HashSet::new();
    let mut words = |word: &Arc<str>| if seen.insert(word.as_ptr()) { word.len() + 16 } else { 0 };
    let mut bytes = size_of::<SourceTable>() + table.places.capacity() * 4;
    for column in &table.columns {
        bytes += size_of_val(column) + column.name.capacity() + column.unit.as_ref().map_or(0, String::capacity);
        bytes += match &column.values {
            Values::Numbers(values) | Values::Times(values) => values.capacity() * 8,
            Values::Text(texts) => texts.capacity() * 16 + texts.iter().map(&mut words).sum::<usize>(),
        };
    }
    bytes + table.notes.iter().map(|note| note.text.capacity()).sum::<usize>()
}

fn check(source: &Source, bytes: usize) {
    for table in &source.tables {
        assert!(table.columns.iter().all(|column| column.values.len() == table.rows), "{source:?}");
        assert!(table.places.is_empty() || table.places.len() == table.rows, "{source:?}");
    }
    let held: usize = source.tables.iter().map(held).sum();
    assert!(held <= bytes * LARGEST_GROWTH + 16_000_000, "{held} bytes of {bytes}");
}

/// Every reader reads it, whether it is its own or not.
fn read_by_all(bytes: &[u8], companion: &[u8]) {
    let companions = [("b".to_string(), companion.to_vec())];
    for format in FORMATS {
        format.recognises(&bytes[..bytes.len().min(65_536)]);
        for companions in [&companions[..], &[]] {
            if let Ok(source) = format.read(&Input { file: "a", bytes, companions, part: None }) {
                check(&source, bytes.len() + companion.len());
            }
        }
    }
}

/// A text of one of the formats with bytes changed, put in, taken away or repeated.
fn mutated() -> impl Strategy<Value = Vec<u8>> {
    let change = (
        any::<prop::sample::Index>(),
        0..4_u8,
        prop_oneof![Just(b'\n'), Just(b' '), Just(b'9'), any::<u8>()],
        1..200_usize,
    );
    (prop::sample::select(&TEXTS[..]), prop::collection::vec(change, 0..8)).prop_map(|(text, changes)| {
        let mut bytes = text.as_bytes().to_vec();
        for (index, how, byte, count) in changes.into_iter() {
            if bytes.is_empty() {
                break;
            }
            let at = index.index(bytes.len());
            let end = (at + count).min(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => drop(bytes.splice(at..at, std::iter::repeat_n(byte, count))),
                2 => drop(bytes.drain(at..end)),
                _ => {
                    let part = bytes[at..end].to_vec();
                    drop(bytes.splice(at..at, part));
                }
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        read_by_all(&bytes, DEFINITION.as_bytes());
    }

    #[test]
    fn any_text_is_read_or_refused(text in "[/LineTDAEFRC$GP 0-9.,*:;%|\\-\\t\\n\\r\"µ€\\[\\]]{0,600}") {
        read_by_all(text.as_bytes(), DATA.as_bytes());
    }

    #[test]
    fn changed_texts_are_read_or_refused(bytes in mutated(), companion in mutated()) {
        read_by_all(&bytes, &companion);
    }

    #[test]
    fn beginnings_of_files_are_recognised_or_not(bytes in mutated(), end in any::<prop::sample::Index>()) {
        let first = &bytes[..end.index(bytes.len() + 1)];
        for format in FORMATS {
            format.recognises(first);
        }
    }
}

#[test]
fn unchanged_texts_are_read_by_their_own_format() {
    let own = [
        "Geosoft XYZ",
        "ASEG-GDF2",
        "",
        "IAGA-2002",
        "MGD77T",
        "NMEA 0183 log",
        "RTKLIB positions",
        "a format that is not read",
    ];
    for (text, own) in TEXTS.iter().zip(own) {
        let format = FORMATS.iter().find(|format| format.recognises(text.as_bytes()));
        assert_eq!(format.map_or("", |format| format.name()), own);
    }
}

/// Claims of size in a few bytes, and rows as short as rows can be.
#[test]
fn what_is_made_of_a_file_is_bounded_by_its_size() {
    let many = 300_000;
    let short_rows = format!("//date 2020/01/31\n//flight 1\nLine 1\n{}", "1\n".repeat(many));
    let many_columns = format!("Line 1\n{}\n", "1 ".repeat(many));
    let short_rows_of_many = format!("SURVEY_ID\tDATE\tTIME\tLAT\tLON{}\n{}", "\tA".repeat(4000), "1\n".repeat(many));
    let empty_fields = format!("SURVEY_ID\tDATE\tTIME\tLAT\tLON\n{}", "\t\t\t\t\n".repeat(many));
    let wide = format!("DEFN 1 ST=RECD,RT=;{}:4000I1;END DEFN\n", "n".repeat(1000));
    let times: String = (0..many / 10).map(|index| format!("$GPZDA,00000{}\n", index % 2)).collect();
    for text in [short_rows, many_columns, short_rows_of_many, empty_fields, times] {
        read_by_all(text.as_bytes(), b"");
        read_by_all(text.as_bytes(), wide.as_bytes());
    }
    read_by_all(wide.as_bytes(), "1".repeat(4000).as_bytes());
}
