//! The firmware image under emulation: equal to its replay bit for bit, and not dearer than it says.
//!
//! Builds nothing: without QEMU, or without the image of `cargo fw-emu`, it says so and passes. With
//! `TOWMAG_EMULATION=required`, as in CI, it fails then.
#![cfg(unix)]

use host_sim::command;
use host_sim::emulator::{self, DEFAULT_IMAGE, Emulated, EmulationSettings, Fault, in_instructions};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use towmag::sensors::scalar::ScalarSettings;
use towmag::{Method, Settings};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("host-sim lies in the workspace")
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

fn emulate(image: PathBuf, conversions_per_epoch: u8, scalar: ScalarSettings, faults: &[&str]) -> Emulated {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings::default();
    let calibration = root().join("sample/calibration.csv");
    let calibrated = command::calibrate(&calibration, folder.path(), &Settings { method: Method::Fixed, ..settings });
    let coefficients = calibrated.unwrap().file.coefficients().unwrap();
    let faults = faults.iter().map(|fault| fault.parse::<Fault>().unwrap()).collect();
    let emulation = EmulationSettings { image, scalar, conversions_per_epoch, faults, typed: Vec::new() };
    emulator::emulate(&root().join("sample/survey.csv"), &settings, coefficients, &emulation).unwrap()
}

#[test]
fn the_body_equals_its_replay_and_its_figures() {
    let Some(image) = image() else { return };
    let emulated = emulate(image.clone(), 1, ScalarSettings::QTFM_GEN1, &[]);
    assert_eq!(emulated.outputs.len(), 6000);
    assert!(emulated.outputs.iter().filter(|output| output.is_some_and(|o| o.compensated.is_some())).count() > 5990);
    let figures = in_instructions(&emulated.figures);
    for lost in ["readings_lost", "conversions_lost", "epochs_lost", "records_lost", "frames_dropped", "log_errors"] {
        assert_eq!(figures[lost], 0, "{lost}");
    }
    check_figures(&image, &figures);
}

#[test]
fn faults_of_the_sensors_change_nothing_in_this() {
    let Some(image) = image() else { return };
    let faults = ["drop@1000+20", "damage@1500+3", "late@2010+30", "crc@2500+4", "stuck@3000+50"];
    let emulated = emulate(image, 3, ScalarSettings::G882, &faults);
    let has = |row: usize| emulated.outputs[row].is_some_and(|output| output.compensated.is_some());
    assert!(has(900) && !has(1010) && !has(1501) && !has(2502) && has(4000));
    assert_eq!(emulated.figures["fluxgate_crc_errors"], 4);
}

/// Hold the figures against `firmware/figures.toml`.
fn check_figures(image: &Path, figures: &BTreeMap<&'static str, u32>) {
    let text = std::fs::read_to_string(root().join("firmware/figures.toml")).unwrap();
    let limits: BTreeMap<String, u32> = toml::from_str(&text).unwrap();
    let [flash, ram] = elf_sizes(&std::fs::read(image).unwrap());
    let measured = [
        ("instructions_per_epoch_mean", figures["instructions_per_epoch_mean"]),
        ("instructions_per_epoch_worst", figures["instructions_per_epoch_worst"]),
        ("flash_bytes", flash),
        ("ram_and_stack_bytes", ram + figures["stack_bytes_worst"]),
    ];
    for (name, value) in measured {
        println!("{name} {value} (limit {})", limits[name]);
        assert!(value <= limits[name], "{name} is {value}, firmware/figures.toml allows {}", limits[name]);
    }
}

/// Bytes in flash and in RAM: the loadable segments of a 32-bit ELF file, and the memory that they and others take.
fn elf_sizes(elf: &[u8]) -> [u32; 2] {
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
