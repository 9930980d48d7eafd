//! The firmware image under emulation: equal to its replay bit for bit, and not dearer than it says.
//!
//! Builds nothing: without QEMU, or without the image of `cargo fw-emu`, it says so and passes. With
//! `TOWMAG_EMULATION=required`, as in CI, it fails then.

mod fluxgate;

use crate::common::first_rows;
use host_sim::command;
use host_sim::emulator::{self, DEFAULT_IMAGE, Emulated, EmulationSettings, Fault, Typed, in_instructions};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;
use towmag::estimate::Calibration;
use towmag::log::{BLOCK_LEN, Event, EventKind, Record, Sector};
use towmag::sensors::scalar::{ScalarSettings, qtfm_gen1};
use towmag::{Epoch, Method, Settings};

/// Where `cargo fw` puts the image for the board.
const BOARD_IMAGE: &str = "target/thumbv7em-none-eabihf/firmware/firmware";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("host-sim lies in the workspace")
}

/// The first rows of a sample with more columns.
fn widened(folder: &TempDir, sample: &str, columns: &str, rows: usize, fields: impl Fn(usize) -> String) -> PathBuf {
    let text = std::fs::read_to_string(root().join("sample").join(sample)).unwrap();
    let mut lines = text.lines();
    let mut csv = format!("{},{columns}\n", lines.next().unwrap());
    for (row, line) in lines.take(rows).enumerate() {
        csv += &format!("{line},{}\n", fields(row));
    }
    let path = folder.path().join(sample);
    std::fs::write(&path, csv).unwrap();
    path
}

/// The image, if there is one and an emulator for it.
fn image() -> Option<PathBuf> {
    let image = root().join(DEFAULT_IMAGE);
    let qemu = Command::new("qemu-system-arm").arg("--version").output().is_ok();
    if qemu && image.is_file() {
        return Some(image);
    }
    assert!(std::env::var_os("TOWMAG_EMULATION").is_none(), "emulation is required: QEMU {qemu}, {}", image.display());
    eprintln!("skipped: needs qemu-system-arm and the image that `cargo fw-emu` builds");
    None
}

/// What differs from run to run.
struct Run {
    recording: PathBuf,
    method: Method,
    scalar: ScalarSettings,
    conversions_per_epoch: u8,
    faults: &'static [&'static str],
    typed: &'static [&'static str],
}

fn plain() -> Run {
    Run {
        recording: root().join("sample/survey.csv"),
        method: Method::SaddlePoint,
        scalar: ScalarSettings::of(&qtfm_gen1::FORMAT),
        conversions_per_epoch: 1,
        faults: &[],
        typed: &[],
    }
}

/// The first rows of the sample's calibration.
fn calibration_of(folder: &TempDir, rows: usize) -> PathBuf {
    first_rows(folder.path(), &root().join("sample/calibration.csv"), rows)
}

/// The real flights, which may not be distributed with the project.
fn flights() -> Option<PathBuf> {
    let beside = root().join("../shared/data");
    let folder = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from).join("sgl_line_1002_20");
    if !folder.is_dir() {
        eprintln!("skipped: no flight recordings beside the project, and TOWMAG_DATA is not set");
    }
    folder.is_dir().then_some(folder)
}

/// Emulate; an error unless the body equals its replay bit for bit, in every life.
fn emulate(image: PathBuf, run: &Run) -> Emulated {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { method: run.method, ..Settings::default() };
    let calibration = root().join("sample/calibration.csv");
    let calibrated = command::calibrate(&calibration, folder.path(), &Settings { method: Method::Fixed, ..settings });
    let prior = calibrated.unwrap().file.prior().unwrap();
    let faults = run.faults.iter().map(|fault| fault.parse::<Fault>().unwrap()).collect();
    let typed = run.typed.iter().map(|typed| typed.parse::<Typed>().unwrap()).collect();
    let Run { scalar, conversions_per_epoch, .. } = *run;
    let emulation = EmulationSettings { image, scalar, conversions_per_epoch, faults, typed };
    emulator::emulate(&run.recording, &settings, prior, &emulation, None).unwrap()
}

/// Rows of a range that were compensated.
fn compensated(emulated: &Emulated, rows: std::ops::Range<usize>) -> usize {
    let outputs = emulated.outputs[rows].iter().flatten();
    outputs.filter(|output| output.compensated.is_some()).count()
}

fn has_text(emulated: &Emulated, part: &str) -> bool {
    emulated.texts.iter().any(|text| text.contains(part))
}

#[test]
fn the_body_equals_its_replay_and_its_figures() {
    let Some(image) = image() else { return };
    let emulated = emulate(image, &plain());
    assert_eq!(emulated.outputs.len(), 6000);
    assert!(compensated(&emulated, 0..6000) > 5990);
    let figures = in_instructions(&emulated.figures);
    for lost in ["readings_lost", "conversions_lost", "epochs_lost", "records_lost", "frames_dropped", "log_errors"] {
        assert_eq!(figures[lost], 0, "{lost}");
    }
    check_figures(&figures);
}

#[test]
fn the_whole_bank_is_equal_bit_for_bit_and_within_its_figures() {
    let Some(image) = image() else { return };
    let emulated = emulate(image, &Run { method: Method::Adaptive, faults: &["reset@3000"], ..plain() });
    assert!(compensated(&emulated, 0..6000) > 5980);
    let figures = in_instructions(&emulated.figures);
    let [_, ram] = elf_sizes(&std::fs::read(root().join(DEFAULT_IMAGE)).unwrap());
    check(&[
        ("adaptive_instructions_per_epoch_mean", figures["instructions_per_epoch_mean"]),
        ("adaptive_instructions_per_epoch_worst", figures["instructions_per_epoch_worst"]),
        ("ram_and_stack_bytes", ram + figures["stack_bytes_worst"]),
    ]);
}

#[test]
fn real_flights_are_equal_bit_for_bit() {
    let Some(image) = image() else { return };
    let Some(folder) = flights() else { return };
    let methods = [Method::SaddlePoint, Method::Adaptive];
    let here = tempfile::tempdir().unwrap();
    for (name, method) in ["flux_b_mag_5_survey.csv", "flux_c_mag_4_survey.csv"].into_iter().zip(methods) {
        let recording = first_rows(here.path(), &folder.join(name), 2500);
        let emulated = emulate(image.clone(), &Run { recording, method, ..plain() });
        assert!(compensated(&emulated, 0..2500) > 2490, "{name}");
    }
}

/// All eight, some minutes; fails where the recordings are not there:
/// `TOWMAG_EMULATION=required cargo test -p host-sim --test host emulate -- --ignored --nocapture`
#[test]
#[ignore = "takes minutes, and wants recordings that may not be distributed"]
fn all_flights_are_equal_bit_for_bit() {
    let image = image().expect("no emulator");
    let folder = flights().expect("no flight recordings: TOWMAG_DATA says where they are");
    for fluxgate in ["b", "c"] {
        for (scalar, method) in [(4, Method::SaddlePoint), (5, Method::Adaptive)] {
            for part in ["calibration", "survey"] {
                let recording = format!("flux_{fluxgate}_mag_{scalar}_{part}.csv");
                let emulated = emulate(image.clone(), &Run { recording: folder.join(&recording), method, ..plain() });
                let rows = emulated.outputs.len();
                println!("{recording}, {method:?}: {rows} epochs equal bit for bit");
                assert!(compensated(&emulated, 0..rows) > rows * 9 / 10, "{recording}");
            }
        }
    }
}

#[test]
fn with_all_conversions_of_the_board_it_is_the_same_and_dearer() {
    let Some(image) = image() else { return };
    let folder = tempfile::tempdir().unwrap();
    let recording = widened(&folder, "calibration.csv", "battery_V,leak", 1_800, |_| "12.00,0".into());
    let typed = &["1700:status"];
    let emulated = emulate(image, &Run { recording, conversions_per_epoch: 25, typed, ..plain() });
    assert!(compensated(&emulated, 0..1800) > 1790);
    // Sensors and body keep step: the grid is locked once, and never again.
    assert!(has_text(&emulated, "fault: grid relocks 1") && !has_text(&emulated, "off time"), "{:?}", emulated.texts);
    let mean = in_instructions(&emulated.figures)["instructions_per_epoch_mean"];
    check(&[("instructions_per_epoch_mean_of_25_conversions", mean)]);
}

#[test]
fn faults_of_the_sensors_change_nothing_in_this() {
    let Some(image) = image() else { return };
    let faults = &["drop@500+20", "damage@700+3", "late@910+30", "crc@1100+4", "stuck@1300+50"];
    let folder = tempfile::tempdir().unwrap();
    let recording = first_rows(folder.path(), &plain().recording, 1800);
    let run = Run { recording, conversions_per_epoch: 3, scalar: ScalarSettings::G882, faults, ..plain() };
    let emulated = emulate(image, &run);
    let has = |row: usize| compensated(&emulated, row..row + 1) == 1;
    assert!(has(450) && !has(510) && !has(701) && !has(1102) && has(1700));
    assert_eq!(emulated.figures["fluxgate_crc_errors"], 4);
}

#[test]
fn what_is_left_of_the_sensors_is_logged_at_10_hz_and_all_of_it_afterwards() {
    let Some(image) = image() else { return };
    // The converter out for a minute, the scalar sensor noisy for half of one, gone for more than one, stuck for ten seconds.
    let faults = &["unplug@300+600", "noise@1100+300", "drop@1600+700", "stuck@2500+100"];
    let folder = tempfile::tempdir().unwrap();
    let recording = first_rows(folder.path(), &plain().recording, 2900);
    let emulated = emulate(image, &Run { recording, faults, typed: &["2800:status"], ..plain() });
    for (ill, well) in [(300..900, 910..1100), (1100..1400, 1405..1600), (1600..2300, 2305..2500)] {
        assert_eq!(compensated(&emulated, ill), 0);
        assert_eq!(compensated(&emulated, well.clone()), well.len());
    }
    // Epochs at 10 Hz throughout, and every one of them in the log: `emulate` has compared them.
    assert!(emulated.outputs.iter().all(Option::is_some));
    assert!(emulated.log_epochs + 32 > emulated.epochs && emulated.epochs >= 2900);
    for told in ["scalar missing 1003", "fluxgate missing 60", "converter crc 600", "scalar rubbish bytes"] {
        assert!(has_text(&emulated, told), "{told}: {:?}", emulated.texts);
    }
}

#[test]
fn resets_power_cuts_and_panics_cost_little_and_are_told() {
    let Some(image) = image() else { return };
    let faults = &["reset@400", "power@800", "panic@1200", "power@1201", "reset@1600+3"];
    let folder = tempfile::tempdir().unwrap();
    let recording = first_rows(folder.path(), &plain().recording, 2200);
    let emulated = emulate(image, &Run { recording, faults, typed: &["2000:status"], ..plain() });
    assert_eq!(emulated.starts, 8);
    let panics = |event: &&Event| matches!(&event.kind, EventKind::Panic(text) if text.contains("asked for a panic"));
    assert_eq!(emulated.events.iter().filter(panics).count(), 1);
    assert_eq!(emulated.events.iter().filter(|event| matches!(event.kind, EventKind::Reset(_))).count(), 8);
    // The power cut after the panic has wiped the memory that counts them.
    assert!(!has_text(&emulated, "restarts by fault"), "{:?}", emulated.texts);
    assert!(compensated(&emulated, 1610..2200) > 580);
}

#[test]
fn settings_and_time_outlive_a_restart() {
    let Some(image) = image() else { return };
    let typed = &[
        "200:time set 1790000000",
        "300:set lambda1 0.002",
        "310:save",
        "320:get lambda1",
        "340:set lambda1 many",
        "360:frobnicate",
        "400:log stop yes",
        "600:log start",
        "700:reset yes",
        "800:get lambda1",
        "820:status",
    ];
    let folder = tempfile::tempdir().unwrap();
    let recording = calibration_of(&folder, 900);
    let emulated = emulate(image, &Run { recording, typed, ..plain() });
    assert_eq!(emulated.starts, 2);
    let answers =
        ["lambda1 = 0.002", "error: choose a number", "error: no command \"frobnicate\"", "log off", "log on"];
    for answer in answers {
        assert!(has_text(&emulated, answer), "{answer}: {:?}", emulated.texts);
    }
    assert_eq!(emulated.texts.iter().filter(|text| *text == "lambda1 = 0.002").count(), 3);
    assert!(has_text(&emulated, "settings: intact") && has_text(&emulated, "time: 179000006"), "{:?}", emulated.texts);
    let paused = emulated.epochs - emulated.log_epochs;
    assert!((150..=250 + 32).contains(&paused), "{paused} epochs are not in the log");
    let times = emulated.events.iter().filter(|event| matches!(event.kind, EventKind::Time(_))).count();
    assert!(times >= 2, "each session tells the time");
}

#[test]
fn a_calibration_on_the_body_is_that_of_the_core_over_the_same_epochs() {
    let Some(image) = image() else { return };
    let typed = &["5:calibrate start", "2000:calibrate stop", "2050:calibrate accept yes"];
    let folder = tempfile::tempdir().unwrap();
    let recording = calibration_of(&folder, 2150);
    let emulated = emulate(image, &Run { recording, typed, ..plain() });
    assert!(has_text(&emulated, "improvement ratio") && has_text(&emulated, "condition number"));
    let found = emulated.events.iter().find_map(|event| match &event.kind {
        EventKind::Calibrated { coefficients, used_epochs, .. } => Some((event.tick, *coefficients, *used_epochs)),
        _ => None,
    });
    let (tick, coefficients, used_epochs) = found.expect("the log holds the calibration");
    assert!(used_epochs > 1500);
    let epochs = logged_epochs(&emulated);
    let same = (0..60).any(|first| {
        let mut calibration = Calibration::new(&Settings::default()).unwrap();
        for epoch in epochs.iter().filter(|epoch| (first..=tick).contains(&epoch.tick)) {
            _ = calibration.step(epoch); // an epoch that is not usable is left out
        }
        calibration.solve().is_ok_and(|result| result.coefficients == coefficients)
    });
    assert!(same, "no start gives the body's coefficients");
    // The body has started anew with them; the replay that was compared has taken them from its flash.
    assert_eq!(emulated.starts, 2);
    assert_eq!(emulated.stored.coefficients, coefficients);
}

/// The body's third UART is fed with the recording's depth and altitude: the log has them at the epochs of their rows.
#[test]
fn the_depth_of_the_recording_is_in_the_log() {
    let Some(image) = image() else { return };
    let folder = tempfile::tempdir().unwrap();
    let depth_m = |row: usize| 20.0 + row as f32 * 0.01;
    let fields = |row| format!("{:.2},4.25", depth_m(row));
    let recording = widened(&folder, "survey.csv", "depth_m,altitude_m", 900, fields);
    let emulated = emulate(image, &Run { recording, typed: &["800:status"], ..plain() });
    assert!(!has_text(&emulated, "nmea"), "{:?}", emulated.texts);
    let row_of =
        |tick: u32| emulated.outputs.iter().position(|output| output.is_some_and(|output| output.tick == tick));
    let mut compared = 0;
    for event in &emulated.events {
        let EventKind::Navigation(navigation) = &event.kind else { continue };
        assert_eq!(navigation.altitude_m, Some(4.25));
        if let Some(row) = row_of(event.tick) {
            // Its own, though the epoch waits for its readings until the next has come. Centimetres went through decibars.
            let off_m = navigation.depth_m.unwrap() - depth_m(row);
            assert!(off_m.abs() < 0.002, "row {row}: {off_m}");
            compared += 1;
        }
    }
    assert!(compared >= 860, "{compared} of 900");
}

/// Leak contact and battery are what the recording says; the log has them, and equals the replay's, life by life.
#[test]
fn the_leak_and_the_battery_of_the_recording_are_in_the_log() {
    let Some(image) = image() else { return };
    let folder = tempfile::tempdir().unwrap();
    let volts = |row: usize| 12.0 - (row / 100) as f32 * 0.1;
    let is_wet = |row: usize| (600..800).contains(&row);
    let fields = |row| format!("{:.2},{}", volts(row), u8::from(is_wet(row)));
    let recording = widened(&folder, "survey.csv", "battery_V,leak", 1_500, fields);
    let faults = &["reset@1000", "power@1200"];
    let emulated = emulate(image, &Run { recording, faults, typed: &["700:status", "900:status"], ..plain() });
    assert_eq!(emulated.starts, 3);
    // The first second of a voltage is of two.
    let told = emulated.events.iter().filter_map(|event| match event.kind {
        EventKind::Housekeeping(told) => Some((event.tick, told)),
        _ => None,
    });
    let told: Vec<_> = told.collect();
    assert!((130..=160).contains(&told.len()), "once a second: {}", told.len());
    let is_of_row = |battery_v: f32| (0..1_500).step_by(100).any(|row| (battery_v - volts(row)).abs() < 0.002);
    let of_rows = told.iter().filter(|(_, told)| told.battery_v.is_some_and(is_of_row)).count();
    assert!(of_rows > told.len() * 8 / 10, "{of_rows} of {}", told.len());
    let wet: Vec<u32> = told.iter().filter(|(_, told)| told.has_leak == Some(true)).map(|(tick, _)| *tick).collect();
    assert!((19..=22).contains(&wet.len()), "wet for 20 s: {wet:?}");
    for text in
        ["LEAK: water at the contact", "leak over: the contact is dry", "V, leak contact: WET", "V, leak contact: dry"]
    {
        assert!(has_text(&emulated, text), "{text}: {:?}", emulated.texts);
    }
}

/// The epochs of the first session, out of the sectors of the log.
fn logged_epochs(emulated: &Emulated) -> Vec<Epoch> {
    let blocks = emulated.log.as_chunks::<BLOCK_LEN>().0;
    let sectors = blocks.iter().filter_map(|block| Sector::parse(block).ok());
    let session = blocks.iter().find_map(|block| Sector::parse(block).ok()).unwrap().id().session;
    let records =
        sectors.filter(|sector| sector.id().session == session).flat_map(|sector| sector.records().collect::<Vec<_>>());
    let epochs = records.filter_map(|record| match record {
        Ok(Record::Epoch(record)) => Some(record.epoch),
        _ => None,
    });
    epochs.collect()
}

/// Hold the figures against `firmware/figures.toml`.
fn check_figures(figures: &BTreeMap<&'static str, u32>) {
    let sizes = |image: &str| elf_sizes(&std::fs::read(root().join(image)).unwrap_or_default());
    let [_, ram] = sizes(DEFAULT_IMAGE);
    let [flash, _] = sizes(BOARD_IMAGE);
    assert!(flash > 0 || std::env::var_os("TOWMAG_EMULATION").is_none(), "`cargo fw` has not made {BOARD_IMAGE}");
    check(&[
        ("instructions_per_epoch_mean", figures["instructions_per_epoch_mean"]),
        ("instructions_per_epoch_worst", figures["instructions_per_epoch_worst"]),
        ("flash_bytes", flash),
        ("ram_and_stack_bytes", ram + figures["stack_bytes_worst"]),
    ]);
}

fn check(measured: &[(&str, u32)]) {
    let text = std::fs::read_to_string(root().join("firmware/figures.toml")).unwrap();
    let limits: BTreeMap<String, u32> = toml::from_str(&text).unwrap();
    for &(name, value) in measured {
        println!("{name} {value} (limit {})", limits[name]);
        assert!(value <= limits[name], "{name} is {value}, firmware/figures.toml allows {}", limits[name]);
    }
}

/// Bytes in flash and in RAM: the loadable segments of a 32-bit ELF file, and the memory that they and others take.
/// 0 without a file.
fn elf_sizes(elf: &[u8]) -> [u32; 2] {
    if elf.is_empty() {
        return [0, 0];
    }
    let word = |at: usize| u32::from_le_bytes(*elf[at..].first_chunk().unwrap());
    let half = |at: usize| usize::from(u16::from_le_bytes(*elf[at..].first_chunk().unwrap()));
    let (mut flash, mut ram) = (0, 0);
    for header in (0..half(44)).map(|i| word(28) as usize + i * half(42)).filter(|&at| word(at) == 1) {
        let (address, in_file, in_memory) = (word(header + 8), word(header + 16), word(header + 20));
        flash += in_file;
        if address >= 0x1000_0000 {
            ram += in_memory;
        }
    }
    [flash, ram]
}
