//! What a recording may hold, and what is said about one that is none.

use host_sim::recording::{Column, CsvReader, RecordingError, RecordingReader, RecordingRow};

const HEADER: &str = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT";

/// All rows, and the error that ended them if one did.
fn read(text: impl AsRef<[u8]>) -> (Vec<RecordingRow>, Option<RecordingError>) {
    let (rows, error) = read_with_fields(text);
    (rows.into_iter().map(|(row, _)| row).collect(), error)
}

/// The same, each row with its fields as they are in the file.
fn read_with_fields(text: impl AsRef<[u8]>) -> (Vec<(RecordingRow, csv::ByteRecord)>, Option<RecordingError>) {
    let mut recording = match CsvReader::from_reader("rec.csv", text.as_ref()) {
        Ok(recording) => recording,
        Err(error) => return (Vec::new(), Some(error)),
    };
    let mut rows = Vec::new();
    let mut row = RecordingRow::default();
    loop {
        match recording.read_row(&mut row) {
            Ok(true) => rows.push((row.clone(), recording.fields().clone())),
            Ok(false) => return (rows, None),
            Err(error) => {
                assert!(!recording.read_row(&mut row).unwrap(), "nothing comes after an error");
                return (rows, Some(error));
            }
        }
    }
}

/// Rows of a recording that has nothing wrong with it.
fn good(text: impl AsRef<[u8]>) -> Vec<RecordingRow> {
    let (rows, error) = read(text);
    assert!(error.is_none(), "{error:?}");
    rows
}

fn error_of(text: impl AsRef<[u8]>) -> String {
    let error = read(text).1.expect("bad input");
    assert!(error.is_bad_input());
    error.to_string()
}

/// A row of a recording with one more column in front of it.
fn with_column(name: &str, value: &str) -> String {
    format!("{HEADER},{name}\n0.0,50000.1234,20000.5,-100,45000,{value}\n")
}

#[test]
fn values_arrive_in_the_units_of_the_core() {
    let rows = good(format!("{HEADER}\n0.0, 50000.1234 ,20000.5,-100,4.5e4\n0.1,50000.1236,0,0,-45000\n"));
    assert_eq!(rows[0].epoch.scalar_pt, Some(50_000_123));
    assert_eq!(rows[1].epoch.scalar_pt, Some(50_000_124));
    assert_eq!(rows[0].epoch.flux_nt, Some([20000.5, -100.0, 45000.0]));
    assert_eq!((rows[0].time_s(), rows[0].scalar_nt()), (Some(0.0), Some(50000.1234)));
    assert_eq!(rows[1].flux_nt(), Some([0.0, 0.0, -45000.0]));
    assert_eq!((rows[1].epoch.tick, rows[1].line_number, rows[1].gap_s), (1, 3, None));
    assert!(rows[0].is_usable() && rows[0].is_scalar_valid());
}

#[test]
fn columns_may_come_in_any_order_with_others_between_them() {
    let header = "note,flux_z_nT, scalar_nT ,current_strobe_A,flux_y_nT,time_s,flux_x_nT,heading_deg,current_pump_A";
    let row = &good(format!("{header}\na b,3,50000,0.5,2000,7,1,359.5,\n"))[0];
    assert_eq!(row.flux_nt(), Some([1.0, 2000.0, 3.0]));
    assert_eq!((row.time_s(), row.scalar_nt(), row.number(Column::Heading)), (Some(7.0), Some(50000.0), Some(359.5)));
    assert_eq!(row.currents_a, [Some(0.5), None]);

    let recording = CsvReader::from_reader("rec.csv", header.as_bytes()).unwrap();
    let loads: Vec<_> = recording.schema().loads().iter().map(|column| column.load.as_str()).collect();
    assert_eq!(loads, ["strobe", "pump"]);
    assert_eq!(recording.schema().name(2), b"scalar_nT");
}

#[test]
fn every_optional_column_is_read() {
    let names = "scalar_signal,depth_m,temperature_degC,roll_deg,pitch_deg,heading_deg,latitude_deg,longitude_deg,\
                 line,utc_s,altitude_m,scalar2_nT,scalar2_valid,base_nT,cable_out_m,speed_m_per_s";
    let row = &good(with_column(names, "1,2,3,4,5,6,7,8,L9,10,11,12,1,14,15,16"))[0];
    let attitude = [Column::Roll, Column::Pitch, Column::Heading];
    let first = [Column::ScalarSignal, Column::Depth, Column::Temperature].into_iter().chain(attitude);
    let first = first.chain([Column::Latitude, Column::Longitude]).map(|column| row.number(column));
    assert_eq!(first.collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0].map(Some));
    assert_eq!((row.line.as_str(), row.flag(Column::Scalar2Valid)), ("L9", Some(true)));
    let second = [Column::Utc, Column::Altitude, Column::Scalar2, Column::Base, Column::CableOut, Column::Speed];
    assert_eq!(second.map(|column| row.number(column)), [10.0, 11.0, 12.0, 14.0, 15.0, 16.0].map(Some));
    let missing = &good(with_column(names, ",,,,,,,,,,,,,,,"))[0];
    assert!(Column::all().skip(5).all(|column| missing.number(column).is_none()));
    assert!(missing.is_usable() && missing.line.is_empty());
}

#[test]
fn unknown_columns_pass_through_byte_for_byte() {
    let mut text = with_column("note,\u{fc}", "").into_bytes();
    text.truncate(text.len() - 1);
    text.extend(b"a\0b\xff\xfe, \"quoted\" \n0.1,50000,20000,0,45000,\"two\nlines, \"\"one\"\" field\",x\n");
    let (rows, error) = read_with_fields(text);
    assert!(error.is_none(), "{error:?}");
    let fields: Vec<_> = rows.iter().map(|(_, fields)| fields).collect();
    assert_eq!((&fields[0][5], &fields[0][6]), (&b"a\0b\xff\xfe"[..], &b" \"quoted\" "[..]));
    assert_eq!(&fields[1][5], b"two\nlines, \"one\" field");
    assert_eq!(&fields[0][1], b"50000.1234");
}

#[test]
fn byte_order_mark_carriage_returns_and_blank_lines_do_no_harm() {
    let plain = format!("{HEADER},line\n0.0,50000,20000,0,45000,a\n0.1,50000,20000,0,45000,b\n0.2,5o,0,0,1,c\n");
    let windows = format!("\u{feff}{}", plain.replace('\n', "\r\n"));
    for text in [plain.clone(), windows.clone(), windows.trim_end().to_string()] {
        let (rows, error) = read_with_fields(&text);
        assert_eq!(rows.iter().map(|(row, _)| row.line_number).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(&rows[1].1[5], b"b");
        assert_eq!(rows[1].0.line, "b");
        assert_eq!(error.unwrap().to_string(), "rec.csv:4: scalar_nT: \"5o\" is not a number");
    }
    for (line_end, lines) in [("\n\n", [3, 5]), ("\r\n\r\n", [3, 5])] {
        let (rows, error) = read(plain.replace('\n', line_end));
        assert_eq!(rows.iter().map(|row| row.line_number).collect::<Vec<_>>(), lines);
        assert!(error.unwrap().to_string().starts_with("rec.csv:7: scalar_nT"));
    }
}

/// Gives one byte at a time, as a slow pipe may.
struct Drip<'a>(&'a [u8]);

impl std::io::Read for Drip<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let length = self.0.len().min(buffer.len()).min(1);
        self.0.read(&mut buffer[..length])
    }
}

#[test]
fn pieces_of_any_size_give_the_same_rows() {
    let text = format!("\u{feff}{HEADER}\r\n\r\n0.0,50000,20000,0,45000\r\n0.1,50000,20000,0,45000\r\n");
    let mut recording = CsvReader::from_reader("pipe", Drip(text.as_bytes())).unwrap();
    let mut row = RecordingRow::default();
    for line in [3, 4] {
        assert!(recording.read_row(&mut row).unwrap());
        assert_eq!(row.line_number, line);
    }
    assert!(!recording.read_row(&mut row).unwrap());
    assert_eq!((recording.bytes_read(), recording.byte_len()), (text.len() as u64, None));
}

#[test]
fn a_missing_value_makes_a_row_unusable_and_excuses_the_rest_of_it() {
    for values in [",20000,0,45000", "50000,,0,45000", "50000,20000, ,45000", ",5o,nan,1e999", "7,,0,45000"] {
        let rows = good(format!("{HEADER}\n0.0,50000,20000,0,45000\n0.1,{values}\n0.2,50000,20000,0,45000\n"));
        assert_eq!(rows.iter().map(RecordingRow::is_usable).collect::<Vec<_>>(), [true, false, true], "{values}");
        assert_eq!(rows[1].epoch.scalar_pt, None);
        assert_eq!(rows[2].epoch.tick, 2);
    }
}

#[test]
fn a_row_flagged_as_invalid_may_hold_anything_but_a_time_that_goes_back() {
    let header = format!("{HEADER},scalar_valid,depth_m");
    let flagged = "0.1,dead,inf,0,45000,0,?\nwhen,1,2,3,4,0.0,1\n0.3,1e300,2,1e300,4,0,1\n";
    let rows = good(format!("{header}\n0.0,50000,20000,0,45000,1,2\n{flagged}0.4,50000,20000,0,45000,,2\n"));
    assert_eq!(rows.iter().map(RecordingRow::is_usable).collect::<Vec<_>>(), [true, false, false, false, true]);
    assert_eq!(rows.iter().map(|row| row.epoch.tick).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    assert_eq!((rows[1].scalar_nt(), rows[1].flux_nt(), rows[1].number(Column::Depth)), (None, None, None));
    assert_eq!((rows[2].time_s(), rows[2].scalar_nt(), rows[2].is_scalar_valid()), (None, Some(1.0), false));

    let back = error_of(format!("{header}\n0.3,50000,20000,0,45000,1,2\n0.3,,,,,0,\n"));
    assert_eq!(back, "rec.csv:3: time_s: 0.3 does not come after 0.3: time must increase from row to row");
}

#[test]
fn the_flag_is_one_or_zero() {
    for (flag, valid) in [("1", true), ("1.0", true), ("", true), (" 1 ", true), ("0", false), ("0.0", false)] {
        assert_eq!(good(with_column("scalar_valid", flag))[0].is_scalar_valid(), valid, "{flag:?}");
    }
    for flag in ["2", "true", "-1", "0.5", "nan"] {
        let message = format!("rec.csv:2: scalar_valid: \"{flag}\" is neither 1 nor 0");
        assert_eq!(error_of(with_column("scalar_valid", flag)), message);
    }
}

#[test]
fn what_is_no_finite_number_is_named() {
    for (name, value, words) in [
        ("depth_m", "5o123.4", "\"5o123.4\" is not a number"),
        ("current_strobe_A", "1,5", "has 7 fields where the header has 6"),
        ("current_strobe_A", "\"1,5\"", "\"1,5\" is not a number"),
        ("roll_deg", "NaN", "\"NaN\" is not a finite number"),
        ("pitch_deg", "-inf", "\"-inf\" is not a finite number"),
        ("latitude_deg", "1e999", "\"1e999\" is not a finite number"),
        ("longitude_deg", "a\0b", "\"a\\0b\" is not a number"),
    ] {
        let column = if words.starts_with("has") { String::new() } else { format!("{name}: ") };
        assert_eq!(error_of(with_column(name, value)), format!("rec.csv:2: {column}{words}"));
    }
    assert_eq!(good(with_column("line", "not a number")).len(), 1);
}

#[test]
fn readings_stay_within_what_the_earth_has() {
    let flux = "flux_x_nT, flux_y_nT, flux_z_nT: magnitude";
    for (values, words) in [
        ("999.999,20000,0,45000", "scalar_nT: 999.999 nT is outside 1000 to 100000 nT".to_string()),
        ("100000.001,20000,0,45000", "scalar_nT: 100000.001 nT is outside 1000 to 100000 nT".to_string()),
        ("-50000,20000,0,45000", "scalar_nT: -50000 nT is outside 1000 to 100000 nT".to_string()),
        ("50000,0,0,0", format!("{flux} 0 nT is outside 1000 to 100000 nT")),
        ("50000,1e300,0,0", format!("{flux} inf nT is outside 1000 to 100000 nT")),
    ] {
        let text = format!("{HEADER}\n0.0,50000,20000,0,45000\n0.1,{values}\n");
        assert_eq!(error_of(text), format!("rec.csv:3: {words}"));
    }
    good(format!("{HEADER}\n0.0,1000,0,0,-1000\n0.1,100000,0,100000,0\n"));
}

#[test]
fn gaps_are_told_and_short_steps_refused() {
    let row = "50000,20000,0,45000";
    let rows = good(format!("{HEADER}\n10,{row}\n10.15,{row}\n10.2,{row}\n10.4,{row}\n,{row}\n15.4,{row}\n"));
    assert_eq!(rows.iter().map(|row| row.epoch.tick).collect::<Vec<_>>(), [0, 1, 2, 4, 5, 54]);
    let gaps: Vec<_> = rows.iter().map(|row| row.gap_s.map(|gap_s| (gap_s * 100.0).round())).collect();
    assert_eq!(gaps, [None, None, None, Some(20.0), None, Some(500.0)]);

    let short = error_of(format!("{HEADER}\n12.3,{row}\n12.34,{row}\n"));
    assert!(short.starts_with("rec.csv:3: time_s: 12.34 comes less than 0.05 s after 12.3: "), "{short}");
    let back = error_of(format!("{HEADER}\n12.3,{row}\n,{row}\n12.2,{row}\n"));
    assert!(back.starts_with("rec.csv:4: time_s: 12.2 does not come after 12.3: "), "{back}");
}

#[test]
fn a_header_that_does_not_do_is_named() {
    assert_eq!(
        error_of("time_s,scalar_nt,flux_x_nT,flux_y_nT\n"),
        "rec.csv:1: required columns are missing: scalar_nT, flux_z_nT; \
         the header has: time_s, scalar_nt, flux_x_nT, flux_y_nT; `host-sim import` reads files of other recorders"
    );
    for name in ["time_s", "depth_m", "line", "current_strobe_A"] {
        let text = format!("{HEADER},depth_m,line,current_strobe_A, {name}\n");
        assert_eq!(
            error_of(text),
            format!("rec.csv:1: {name}: is there twice: rename or remove one of the two columns")
        );
    }
    good(format!("{HEADER},note,note\n0,50000,20000,0,45000,a,b\n"));
    for empty in ["", "\n", "\u{feff}", "\r\n\r\n"] {
        assert!(error_of(empty).contains("is empty"), "{empty:?}");
    }
    for end in ["", "\n", "\r\n"] {
        assert_eq!(error_of(format!("{HEADER}{end}")), "rec.csv:1: has no rows, only a header");
    }
}

#[test]
fn a_row_of_another_length_is_refused_even_when_flagged() {
    let start = format!("{HEADER},scalar_valid\n0.0,50000,20000,0,45000,1\n");
    for (row, fields) in [("0.1,50000,20000", 3), ("0.1,50000,20000,0,45000,0,7", 7), ("   ", 1)] {
        let message = format!("rec.csv:3: has {fields} fields where the header has 6");
        assert_eq!(error_of(format!("{start}{row}\n")), message);
    }
}

#[test]
fn a_quotation_mark_left_open_does_not_swallow_the_rest() {
    let row = |i: u32, label: &str| format!("{:.1},50000,20000,0,45000,{label}\n", f64::from(i) / 10.0);
    let header = format!("{HEADER},line\n");
    let tail: String = (2..1000).map(|i| row(i, "a")).collect();
    let message = "rec.csv:3: has a quotation mark without its counterpart, so that no end of the row is found";
    assert_eq!(error_of(header.clone() + &row(0, "a") + &row(1, "\"a") + &tail), message);
    let closed_later = tail.replace("50.0,50000,20000,0,45000,a", "50.0,50000,20000,0,45000,\"a\"");
    assert_eq!(error_of(header.clone() + &row(0, "a") + &row(1, "\"a") + &closed_later), message);
    let endless: String = (2..60_000).map(|i| row(i, "a")).collect();
    let message = "rec.csv:3: is longer than 1 MiB: a line break or a quotation mark is missing";
    assert_eq!(error_of(header.clone() + &row(0, "a") + &row(1, "\"a") + &endless), message);
    assert_eq!(good(header + &row(0, "5\" pipe") + &row(1, "a")).len(), 2);
}

#[test]
fn a_file_knows_its_name_and_length() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("rec.csv");
    std::fs::write(&path, with_column("note", "a")).unwrap();
    let mut recording = CsvReader::open(&path).unwrap();
    assert_eq!(recording.file(), path.to_str().unwrap());
    assert_eq!(recording.byte_len(), Some(std::fs::metadata(&path).unwrap().len()));
    let mut row = RecordingRow::default();
    while recording.read_row(&mut row).unwrap() {}
    assert_eq!(Some(recording.bytes_read()), recording.byte_len());

    for path in [directory.path().join("none.csv"), directory.path().into()] {
        let error = CsvReader::open(&path).err().unwrap();
        assert!(error.is_bad_input() && error.to_string().starts_with(path.to_str().unwrap()), "{error}");
    }
}
