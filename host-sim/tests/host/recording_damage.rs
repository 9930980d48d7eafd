//! Whatever has happened to a file: reading ends, in the end of the rows or in one line that says where.

use host_sim::recording::{CsvReader, RecordingError, RecordingReader, RecordingRow};
use proptest::prelude::*;

/// What must not change in a row because of damage after it.
type Seen = (u64, csv::ByteRecord, towmag::Epoch);

fn read(bytes: &[u8], is_strict: bool) -> (Vec<Seen>, Result<(), RecordingError>) {
    let mut seen = Vec::new();
    let mut to_the_end = || {
        let mut recording = CsvReader::from_reader("rec.csv", bytes)?;
        if !is_strict {
            recording.tolerate();
        }
        let mut row = RecordingRow::default();
        while recording.read_row(&mut row)? {
            seen.push((row.line_number, recording.fields().clone(), row.epoch));
        }
        assert_eq!(recording.bytes_read(), bytes.len() as u64);
        Ok(())
    };
    let ended = to_the_end();
    (seen, ended)
}

/// A good recording, as lines without their line ends.
fn lines(rows: u32) -> Vec<String> {
    let header = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,scalar_valid,depth_m,current_strobe_A,line,note";
    let row = |i: u32| {
        let (angle, flag) = (f64::from(i) * 0.1, u32::from(i % 7 != 3));
        let [x, y] = [angle.cos() * 2e4, angle.sin() * 2e4];
        format!("{:.1},{:.3},{x:.2},{y:.2},45000,{flag},{},,leg {},\"a, \"\"b\"\"\"", angle, 5e4 + y, 5 + i, i / 10)
    };
    std::iter::once(header.to_string()).chain((0..rows).map(row)).collect()
}

#[derive(Clone, Debug)]
enum Damage {
    Cut,
    Overwrite(Vec<u8>),
    Insert(Vec<u8>),
    RepeatRow,
    RemoveRow,
    ReverseRowsFrom,
    DeleteColumn(usize),
    DeleteField(usize),
    ReplaceAll(Vec<u8>),
}

fn rubbish() -> impl Strategy<Value = Vec<u8>> {
    // What means something to a parser is worth more than what does not.
    let byte = prop_oneof![any::<u8>(), proptest::sample::select(&b",\"\r\n-+.eE019 \0\xefnaif"[..])];
    proptest::collection::vec(byte, 0..40)
}

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        2 => Just(Damage::Cut),
        4 => rubbish().prop_map(Damage::Overwrite),
        2 => rubbish().prop_map(Damage::Insert),
        1 => Just(Damage::RepeatRow),
        1 => Just(Damage::RemoveRow),
        1 => Just(Damage::ReverseRowsFrom),
        1 => (0..10usize).prop_map(Damage::DeleteColumn),
        1 => (0..10usize).prop_map(Damage::DeleteField),
        1 => rubbish().prop_map(Damage::ReplaceAll),
    ]
}

fn joined(lines: &[String], line_end: &str) -> Vec<u8> {
    lines.iter().flat_map(|line| [line.as_str(), line_end]).collect::<String>().into_bytes()
}

/// The recording after the damage, at a place `at` of 0 to 1.
fn damaged(mut lines: Vec<String>, line_end: &str, damage: &Damage, at: f64) -> Vec<u8> {
    let mut bytes = joined(&lines, line_end);
    let byte = (at * bytes.len() as f64) as usize;
    let row = 1 + (at * (lines.len() - 1) as f64) as usize;
    let without = |line: &String, column: usize| {
        line.split(',').enumerate().filter(|(i, _)| *i != column).map(|(_, field)| field).collect::<Vec<_>>().join(",")
    };
    match damage {
        Damage::Cut => return bytes[..byte].to_vec(),
        Damage::Overwrite(rubbish) => {
            let end = (byte + rubbish.len()).min(bytes.len());
            bytes[byte..end].copy_from_slice(&rubbish[..end - byte]);
            return bytes;
        }
        Damage::Insert(rubbish) => return [&bytes[..byte], rubbish, &bytes[byte..]].concat(),
        Damage::ReplaceAll(rubbish) => return rubbish.clone(),
        Damage::RepeatRow => lines.insert(row, lines[row].clone()),
        Damage::RemoveRow => drop(lines.remove(row)),
        Damage::ReverseRowsFrom => lines[row..].reverse(),
        Damage::DeleteColumn(column) => lines.iter_mut().for_each(|line| *line = without(line, *column)),
        Damage::DeleteField(column) => lines[row] = without(&lines[row], *column),
    }
    joined(&lines, line_end)
}

/// Rows that end before the first byte that differs.
fn untouched_rows(before: &[u8], after: &[u8]) -> usize {
    let common = before.iter().zip(after).take_while(|(a, b)| a == b).count();
    before[..common].iter().filter(|byte| **byte == b'\n').count().saturating_sub(1)
}

fn check(before: &[u8], after: &[u8], is_strict: bool) -> Result<(), TestCaseError> {
    let (good, ended) = read(before, is_strict);
    prop_assert!(ended.is_ok(), "{ended:?}");
    let (rows, ended) = read(after, is_strict);
    let untouched = untouched_rows(before, after);
    prop_assert!(rows.len() >= untouched, "{} of {untouched} rows, then {ended:?}", rows.len());
    // Which of two times is wrong, the row behind them tells.
    let sure = if is_strict { untouched } else { untouched.saturating_sub(1) };
    prop_assert_eq!(&rows[..sure], &good[..sure]);
    if let Err(error) = ended {
        let text = error.to_string();
        prop_assert!(text.starts_with("rec.csv:") && !text.contains(['\n', '\r', '\0']) && text.len() < 500, "{text}");
        prop_assert!(error.is_bad_input());
        let RecordingError::Bad { line, .. } = error else { panic!("{error:?}") };
        let lines = after.split(|byte| *byte == b'\n').count() as u64;
        // A row may turn out to be bad by what comes after it.
        let first = if is_strict { untouched as u64 + 1 } else { 1 };
        prop_assert!((first..=lines).contains(&line), "{text}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damage_of_any_kind_ends_in_one_line(
        rows in 1..40u32, windows: bool, damage in damage(), at in 0.0..1.0f64, is_strict: bool,
    ) {
        let line_end = if windows { "\r\n" } else { "\n" };
        let before = joined(&lines(rows), line_end);
        check(&before, &damaged(lines(rows), line_end, &damage, at), is_strict)?;
    }

    #[test]
    fn bytes_that_never_were_a_recording_end_in_one_line(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        let (_, ended) = read(&bytes, true);
        let text = ended.expect_err("the header is missing").to_string();
        prop_assert!(text.starts_with("rec.csv:") && text.lines().count() == 1, "{text}");
    }
}

#[test]
fn a_cut_at_every_byte_leaves_the_rows_before_it() {
    let before = joined(&lines(5), "\r\n");
    for end in 0..=before.len() {
        check(&before, &before[..end], true).unwrap();
        check(&before, &before[..end], false).unwrap();
    }
}

#[test]
fn reversed_and_repeated_rows_are_never_accepted() {
    for (damage, at) in [(Damage::RepeatRow, 0.5), (Damage::RepeatRow, 0.0), (Damage::ReverseRowsFrom, 0.5)] {
        let (_, ended) = read(&damaged(lines(20), "\n", &damage, at), true);
        assert!(ended.unwrap_err().to_string().contains(": time_s: "), "{damage:?}");
    }
}
