//! A log as the body writes it: recovered from a damaged card, and read by the other commands as it is.

use std::path::{Path, PathBuf};

use crate::device::{card, card_of, depth_m, housekeeping, unix_ms};
use host_sim::command;
use host_sim::simulator::sample_calibration;
use tempfile::TempDir;
use towmag::{Method, Settings};

fn save(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn columns(path: &Path, names: &[&str]) -> Vec<Vec<String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().clone();
    let at: Vec<usize> = names.iter().map(|name| header.iter().position(|h| h == *name).unwrap()).collect();
    reader.records().map(|row| row.unwrap()).map(|row| at.iter().map(|&i| row[i].to_string()).collect()).collect()
}

#[test]
fn a_log_replays_to_the_bits_that_the_body_logged() {
    let folder = tempfile::tempdir().unwrap();
    let log = save(&folder, "TOWMAG01.BIN", &card().0.concat());
    let out = folder.path().join("out");
    let settings = Settings { method: Method::SaddlePoint, ..Settings::default() };
    let summary = command::replay(&log, None, &out, &settings).unwrap();
    assert_eq!(summary.rows, 5890);
    let names = ["logged_residual_nT", "residual_nT", "valid", "line"];
    let rows = columns(&out.join("compensated.csv"), &names);
    // The first session: the second starts from coefficients that the replay has learnt by then.
    let first: Vec<_> = rows.iter().filter(|row| row[3] == "session 00000007").collect();
    assert_eq!(first.len(), 3000);
    for row in first {
        assert_eq!(row[0].parse::<f32>().ok(), row[1].parse::<f32>().ok());
        assert_eq!(row[0].is_empty(), row[2] == "0");
    }
}

/// Without a coefficients file: the log tells what the body has started from.
#[test]
fn an_adaptive_log_replays_to_the_bits_from_itself() {
    let folder = tempfile::tempdir().unwrap();
    let csv = save(&folder, "cal.csv", &command::recording(&sample_calibration()));
    let calibrated = command::calibrate(&csv, &folder.path().join("cal"), &Settings::default()).unwrap();
    let card = card_of(Method::Adaptive, &calibrated.file.prior().unwrap(), |output| output);
    let log = save(&folder, "TOWMAG01.BIN", &card.0.concat());
    let out = folder.path().join("out");
    command::replay(&log, None, &out, &Settings::default()).unwrap();
    let rows = columns(&out.join("compensated.csv"), &["logged_residual_nT", "residual_nT", "line"]);
    let first: Vec<_> = rows.iter().filter(|row| row[2] == "session 00000007").collect();
    assert_eq!(first.len(), 3000);
    assert!(first.iter().all(|row| row[0].parse::<f32>().ok() == row[1].parse::<f32>().ok()));
}

#[test]
fn a_clock_that_was_set_late_holds_for_the_whole_session() {
    let folder = tempfile::tempdir().unwrap();
    let log = save(&folder, "TOWMAG01.BIN", &card().0.concat());
    let out = folder.path().join("out");
    command::replay(&log, None, &out, &Settings::default()).unwrap();
    for row in columns(&out.join("compensated.csv"), &["tick", "time_s"]) {
        let (tick, time_s): (u32, f64) = (row[0].parse().unwrap(), row[1].parse().unwrap());
        assert_eq!((time_s * 1000.0).round() as u64, unix_ms(tick));
    }
}

#[test]
fn what_the_body_knew_of_its_depth_is_a_column_that_is_empty_before_and_after() {
    let folder = tempfile::tempdir().unwrap();
    let log = save(&folder, "TOWMAG01.BIN", &card().0.concat());
    command::recover(&log, &folder.path().join("found")).unwrap();
    command::replay(&log, None, &folder.path().join("out"), &Settings::default()).unwrap();
    for table in ["found/recording.csv", "out/compensated.csv"] {
        let rows = columns(&folder.path().join(table), &["tick", "depth_m", "line"]);
        for row in rows.iter().filter(|row| row[2] == "session 00000007") {
            let tick: u32 = row[0].parse().unwrap();
            // For three seconds after the last that was told.
            let expected = (1000..=1130).contains(&tick).then(|| depth_m(tick.min(1100)));
            assert_eq!(row[1].parse::<f32>().ok(), expected, "{table}: tick {tick}");
        }
    }
    let recording = std::fs::read_to_string(folder.path().join("found/recording.csv")).unwrap();
    // Of what it never knew there is no column: a heading that is never there would be taken for one that is.
    assert!(!recording.lines().next().unwrap().contains("heading") && !recording.contains("altitude"));
    assert!(!std::fs::read_to_string(folder.path().join("found/events.txt")).unwrap().contains("Navigation"));
}

#[test]
fn leak_and_battery_are_columns_that_are_empty_before_and_after() {
    let folder = tempfile::tempdir().unwrap();
    let log = save(&folder, "TOWMAG01.BIN", &card().0.concat());
    command::recover(&log, &folder.path().join("found")).unwrap();
    let recording = folder.path().join("found/recording.csv");
    command::replay(&log, None, &folder.path().join("out"), &Settings::default()).unwrap();
    // And from the table again.
    command::replay(&recording, None, &folder.path().join("again"), &Settings::default()).unwrap();
    for table in ["found/recording.csv", "out/compensated.csv", "again/compensated.csv"] {
        let rows = columns(&folder.path().join(table), &["tick", "battery_V", "leak", "line"]);
        for row in rows.iter().filter(|row| row[3] == "session 00000007") {
            let tick: u32 = row[0].parse().unwrap();
            // For three seconds after the last that was told.
            let told = (2000..=2130).contains(&tick).then(|| housekeeping(tick.min(2100) / 10 * 10)).flatten();
            assert_eq!(row[1].parse::<f32>().ok(), told.and_then(|told| told.battery_v), "{table}: tick {tick}");
            let leak = told.and_then(|told| told.has_leak).map_or("", |leak| if leak { "1" } else { "0" });
            assert_eq!(row[2], leak, "{table}: tick {tick}");
        }
    }
    assert!(!std::fs::read_to_string(folder.path().join("found/events.txt")).unwrap().contains("Housekeeping"));
}

#[test]
fn a_log_calibrates() {
    let folder = tempfile::tempdir().unwrap();
    let log = save(&folder, "TOWMAG01.BIN", &card().0.concat());
    let result = command::calibrate(&log, &folder.path().join("cal"), &Settings::default()).unwrap();
    assert!(result.summary.used_rows > 4500 && result.summary.improvement_ratio > 20.0);
}

#[test]
fn a_damaged_card_gives_everything_that_is_intact() {
    let folder = tempfile::tempdir().unwrap();
    let mut card = card();
    card.0[10][100] ^= 1;
    card.0[200..204].iter_mut().for_each(|block| block.fill(0xFF));
    // Rubbish before and after, not aligned to anything that a file system knows: the log is found all the same.
    let mut image = vec![0x55; 512 * 3];
    image.extend(card.0.concat());
    image.truncate(image.len() - 100);
    let image = save(&folder, "card.img", &image);
    let out = folder.path().join("out");
    let result = command::recover(&image, &out).unwrap();
    assert_eq!((result.sessions, result.missing_sectors, result.damaged_blocks), (2, 5, 1));
    assert_eq!(result.epochs_reported_lost, 10);
    assert!(result.epochs >= 5890 - 5 * 11 && result.epochs < 5890);
    let events = std::fs::read_to_string(out.join("events.txt")).unwrap();
    assert!(events.contains("Reset(Watchdog)") && events.contains("10 epochs and 0 other records lost"));
    assert_eq!(columns(&out.join("recording.csv"), &["time_s"]).len() as u64, result.epochs);
    command::replay(&out.join("recording.csv"), None, &folder.path().join("again"), &Settings::default()).unwrap();
}

#[test]
fn what_is_no_log_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for bytes in [vec![], vec![0; 5000], b"TMLS and then nothing of the kind".to_vec()] {
        let image = save(&folder, "card.img", &bytes);
        let out = folder.path().join("out");
        let error = command::recover(&image, &out).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("holds no intact sector of a log"), "{error}");
        assert!(command::replay(&image, None, &out, &Settings::default()).is_err_and(|error| error.exit_code() == 2));
        assert!(!out.exists());
    }
}
