//! The sessions of a log on one time axis: at their true distances where the body knew the time of day.

use std::path::Path;

use crate::device::memory_card::Card;
use host_sim::command;
use host_sim::simulator::sample_survey;
use serde_json::Value;
use towmag::body::UnixTime;
use towmag::log::{EpochRecord, Event, EventKind, Record, SectorWriter};
use towmag::{Output, Settings, Status};

/// 2023-11-14, microseconds since 1970-01-01 UTC.
const BEGIN_US: u64 = 1_700_000_000_000_000;

/// Epochs of a session: 30 s.
const EPOCHS: usize = 300;

/// What the clock of a session tells: tick, microseconds since [`BEGIN_US`], and by how much it may be off.
type Times<'a> = &'a [(u32, u64, u32)];

/// A log file with a session for each start of the body.
fn card_of(file_number: u16, starts: &[(u32, Times<'_>)]) -> Card {
    let samples = sample_survey();
    let mut card = Card::new(file_number, 400);
    for (session, times) in starts {
        let mut log = SectorWriter::resume(card, *session);
        for epoch in samples.samples().take(EPOCHS).map(|sample| sample.epoch) {
            let tick = epoch.tick;
            for (_, since_us, error_us) in times.iter().filter(|(told, ..)| *told == tick) {
                let time = UnixTime { unix_us: BEGIN_US + since_us, error_us: *error_us };
                log.append(&Record::Event(Event { tick, kind: EventKind::Time(time) })).unwrap();
            }
            let output = Output { tick, status: Status::Settling, compensated: None };
            log.append(&Record::Epoch(EpochRecord { epoch, output, battery_a: None, faults: None })).unwrap();
        }
        log.flush().unwrap();
        card = log.into_device();
    }
    card
}

/// What `recover` and `replay` make of a card.
struct Read {
    /// Session, `time_s` and `utc_s` of each row.
    rows: Vec<(String, f64, Option<f64>)>,
    events: String,
    /// Of `recover` and of `replay`.
    gaps: [Value; 2],
}

fn read(image: &[u8]) -> Read {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("card.img");
    std::fs::write(&path, image).unwrap();
    let (found, out) = (folder.path().join("found"), folder.path().join("out"));
    command::recover(&path, &found).unwrap();
    command::replay(&path, None, &out, &Settings::default()).unwrap();
    let gaps = |of: &Path| {
        let summary: Value = serde_json::from_slice(&std::fs::read(of.join("summary.json")).unwrap()).unwrap();
        summary["session_gaps"].clone()
    };
    let rows = |table: &Path| {
        let mut reader = csv::Reader::from_path(table).unwrap();
        let header = reader.headers().unwrap().clone();
        let at = ["line", "time_s", "utc_s"].map(|name| header.iter().position(|found| found == name).unwrap());
        let rows = reader.records().map(|row| row.unwrap());
        rows.map(|row| (row[at[0]].to_string(), row[at[1]].parse().unwrap(), row[at[2]].parse().ok())).collect()
    };
    let of_recover: Vec<_> = rows(&found.join("recording.csv"));
    assert_eq!(of_recover, rows(&out.join("compensated.csv")));
    let events = std::fs::read_to_string(found.join("events.txt")).unwrap();
    Read { rows: of_recover, events, gaps: [gaps(&found), gaps(&out)] }
}

impl Read {
    /// First and last `time_s` of each session, in the order of the rows.
    fn spans(&self) -> Vec<(f64, f64)> {
        let of_session = |rows: &[(String, f64, Option<f64>)]| (rows[0].1, rows[rows.len() - 1].1);
        self.rows.chunk_by(|before, after| before.0 == after.0).map(of_session).collect()
    }

    /// Every row comes after the one before, a whole number of epochs.
    fn assert_grid(&self) {
        for pair in self.rows.windows(2) {
            let epochs = (pair[1].1 - pair[0].1) * 10.0;
            assert!(epochs > 0.5 && (epochs - epochs.round()).abs() < 0.02, "{:?}", pair);
        }
    }
}

fn s(us: u64) -> f64 {
    (BEGIN_US + us) as f64 * 1e-6
}

#[test]
fn three_sessions_whose_times_are_known_stand_at_their_true_distances() {
    // The second 2 min 0.234 s after the begin of the first, the third an hour after that.
    let begins_us = [0, 120_234_000, 3_720_234_000];
    let times = begins_us.map(|begin_us| [(0, begin_us, 20_000)]);
    let read = read(&card_of(1, &[(7, &times[0]), (8, &times[1]), (9, &times[2])]).0.concat());
    read.assert_grid();
    for ((begin_s, end_s), begin_us) in read.spans().into_iter().zip(begins_us) {
        assert!((begin_s - s(begin_us)).abs() <= 0.0505 && (end_s - begin_s - 29.9).abs() < 1e-6, "{begin_s}");
    }
    for (_, time_s, utc_s) in &read.rows {
        assert!((time_s - utc_s.unwrap()).abs() <= 0.0505, "the remainder is in utc_s alone");
    }
    let [gaps, of_replay] = &read.gaps;
    assert_eq!(gaps, of_replay);
    assert_eq!((&gaps[0]["session"], &gaps[0]["after"]), (&"00000008".into(), &"00000007".into()));
    // From the last epoch, at 29.9 s, whose time was told 29.9 s before: 50 ppm.
    assert_eq!((gaps[0]["gap_s"].as_f64(), gaps[0]["gap_error_s"].as_f64()), (Some(90.334), Some(0.041)));
    assert_eq!(gaps[1]["gap_s"].as_f64(), Some(3_570.1));
    let told = "session 00000008 begins 90.334 s +- 0.041 s after the end of session 00000007";
    assert!(read.events.contains(told), "{}", read.events);
}

#[test]
fn a_clock_set_during_the_second_session_holds_for_all_of_it_and_tells_nothing_of_the_first() {
    let card = card_of(1, &[(7, &[]), (8, &[(200, 100_000_000, 5_000)]), (9, &[(0, 600_000_000, 5_000)])]);
    let read = read(&card.0.concat());
    read.assert_grid();
    let spans = read.spans();
    assert!((spans[1].0 - s(80_000_000)).abs() < 0.051 && (spans[2].0 - s(600_000_000)).abs() < 0.051, "{spans:?}");
    assert!((spans[1].0 - spans[0].1 - 1_000.0).abs() < 1e-6, "an unknown pause");
    assert!(read.rows.iter().all(|(line, _, utc_s)| utc_s.is_none() == (line == "session 00000007")));
    let [gaps, _] = &read.gaps;
    assert!(gaps[0]["gap_s"].is_null() && gaps[0]["gap_error_s"].is_null());
    assert!((gaps[1]["gap_s"].as_f64().unwrap() - 490.1).abs() < 0.002, "{gaps}");
    assert!(read.events.contains("session 00000008 begins an unknown time after session 00000007"), "{}", read.events);
}

#[test]
fn a_clock_that_was_set_back_does_not_turn_the_time_back() {
    // The second says that it began before the first; within the third somebody sets the clock right.
    let third: Times<'_> = &[(0, 1_100_000_000, 5_000), (100, 9_010_000_000, 5_000)];
    let card = card_of(1, &[(7, &[(0, 5_000_000_000, 5_000)]), (8, &[(0, 1_000_000_000, 5_000)]), (9, third)]);
    let read = read(&card.0.concat());
    read.assert_grid();
    let [gaps, _] = &read.gaps;
    let back_s = gaps[0]["clock_goes_back_s"].as_f64().unwrap();
    assert!((back_s - 4_030.1).abs() < 0.3 && gaps[0]["gap_s"].is_null(), "{gaps}");
    assert!(read.events.contains("the clock was set back, the time between them is not known"), "{}", read.events);
    // The third by its clock as it was put right: it began 8,000 s after the second, by the second's.
    assert!((gaps[1]["gap_s"].as_f64().unwrap() - (9_000.0 - 1_029.9)).abs() < 0.01, "{gaps}");
    assert!(gaps[1].get("clock_goes_back_s").is_none());
}

#[test]
fn files_of_a_card_come_in_the_order_of_their_times() {
    // What is left of a log that was deleted has the higher number.
    let new = card_of(1, &[(8, &[(0, 900_000_000, 5_000)]), (9, &[])]);
    let old = card_of(5, &[(7, &[(0, 0, 5_000)])]);
    let read = read(&[new.0.concat(), old.0.concat()].concat());
    read.assert_grid();
    let sessions: Vec<&str> = read.rows.chunk_by(|before, after| before.0 == after.0).map(|rows| &*rows[0].0).collect();
    assert_eq!(sessions, ["session 00000007", "session 00000008", "session 00000009"]);
    assert!((read.spans()[1].0 - s(900_000_000)).abs() < 0.051);
    assert_eq!(read.gaps[0].as_array().unwrap().len(), 2);
}
