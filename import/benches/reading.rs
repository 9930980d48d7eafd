//! Speed of reading a text, beside the `csv` crate alone, which parts the fields and looks at none, and beside the least
//! that a table of numbers takes: the same with each field parsed.
//!
//! `cargo bench -p towmag-import` prints rows a second of each, and ratios. One core is used. They take turns, so that what
//! else the machine does falls on all; the fastest turn of each counts.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use towmag_import::read_text;

const ROWS: usize = 200_000;
const COLUMNS: usize = 7;
const TURNS: usize = 15;

/// Reads a text, and tells how many rows it had.
type Way = fn(&str) -> usize;

fn main() {
    let text = recording();
    let ways: [(&str, Way); 3] = [("csv alone", part), ("csv, and each field parsed", parse), ("read_text", import)];
    let mut fastest_s = [f64::INFINITY; 3];
    for _ in 0..TURNS {
        for (fastest_s, (_, way)) in fastest_s.iter_mut().zip(ways) {
            *fastest_s = fastest_s.min(seconds(|| way(&text)));
        }
    }
    println!("{ROWS} rows of {COLUMNS} columns, {:.1} MB", text.len() as f64 / 1e6);
    for ((name, _), time_s) in ways.into_iter().zip(fastest_s) {
        println!("{name:<28} {:>10.0} rows/s   {:.2} of csv alone", ROWS as f64 / time_s, fastest_s[0] / time_s);
    }
}

/// Time, scalar, fluxgate, depth and temperature with the digits that loggers write.
fn recording() -> String {
    let mut text = String::from("time,scalar,flux_x,flux_y,flux_z,depth,temperature\n");
    for row in 0..ROWS {
        let (s, c) = (row as f64 * 0.01).sin_cos();
        let time_s = row as f64 * 0.1;
        writeln!(
            text,
            "{time_s:.1},{:.3},{:.2},{:.2},{:.2},{:.2},{:.1}",
            50_000.0 + 20.0 * s,
            20_000.0 * c,
            20_000.0 * s,
            45_000.0 + 900.0 * c,
            12.0 + s,
            8.0 + c
        )
        .expect("memory");
    }
    text
}

fn seconds(work: impl FnOnce() -> usize) -> f64 {
    let begin = Instant::now();
    assert_eq!(black_box(work()), ROWS);
    begin.elapsed().as_secs_f64()
}

fn part(text: &str) -> usize {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut record = csv::ByteRecord::new();
    let mut rows = 0;
    while reader.read_byte_record(&mut record).expect("text") {
        assert_eq!(black_box(&record).len(), COLUMNS);
        rows += 1;
    }
    rows
}

fn parse(text: &str) -> usize {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut record = csv::ByteRecord::new();
    let mut columns: [Vec<f64>; COLUMNS] = Default::default();
    while reader.read_byte_record(&mut record).expect("text") {
        for (column, field) in columns.iter_mut().zip(&record) {
            column.push(fast_float2::parse(field).unwrap_or(f64::NAN));
        }
    }
    black_box(&columns)[0].len()
}

fn import(text: &str) -> usize {
    let source = read_text("f.csv", text.as_bytes()).expect("a table");
    let table = &black_box(&source).tables[0];
    assert_eq!(table.columns.len(), COLUMNS);
    table.rows
}
