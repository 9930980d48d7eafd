//! The exact bits that the core gives on the shipped recordings. A refactoring must not change one of them; a change
//! of the numerics shows as a diff of the file. `TOWMAG_BLESS=1 cargo test --test golden` writes it anew.

mod sample;

use std::fmt::Write;
use std::path::Path;

use sample::epochs;
use towmag::estimate::{Calibration, CalibrationResult, Prior};
use towmag::{Epoch, Method, Output, Pipeline, Settings};

const METHODS: [Method; 5] = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint, Method::Adaptive];

fn calibrate() -> CalibrationResult {
    let mut calibration = Calibration::new(&Settings::default()).unwrap();
    epochs("calibration.csv").iter().for_each(|epoch| _ = calibration.step(epoch));
    calibration.solve().unwrap()
}

/// FNV-1a over everything that an output holds.
fn hash(hash: u64, output: &Output) -> u64 {
    let numbers = output.compensated.map_or([0; 5], |c| {
        let bits = [c.interference_nt, c.band_passed_nt, c.residual_nt, c.residual_after_update_nt].map(f32::to_bits);
        [bits[0], bits[1], bits[2], bits[3], c.compensated_pt as u32]
    });
    numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn replay(text: &mut String, method: Method, epochs: &[Epoch], start: Prior) {
    let mut pipeline = Pipeline::new(&Settings { method, ..Settings::default() }, start).unwrap();
    let mut so_far = 0xcbf2_9ce4_8422_2325;
    for (index, epoch) in epochs.iter().enumerate() {
        let output = pipeline.step(epoch);
        so_far = hash(so_far, &output);
        if let (99, Some(c)) = (index % 100, output.compensated) {
            let bits = [c.interference_nt, c.residual_nt, c.residual_after_update_nt].map(f32::to_bits);
            writeln!(text, "{method:?} {index} {bits:08x?} {} all before: {so_far:016x}", c.compensated_pt).unwrap();
        }
    }
}

#[test]
fn every_bit_is_as_it_was() {
    let calibration = calibrate();
    let mut text = format!("condition {:08x}\n", calibration.condition_number.to_bits());
    for (theta, std_nt) in calibration.coefficients.basis().iter().zip(&calibration.std_nt) {
        writeln!(text, "coefficient {:08x} std {:08x}", theta.to_bits(), std_nt.to_bits()).unwrap();
    }
    let survey = epochs("survey.csv");
    for method in METHODS {
        replay(&mut text, method, &survey, calibration.prior());
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/sample.txt");
    if std::env::var_os("TOWMAG_BLESS").is_some() {
        std::fs::write(path, text).unwrap();
        return;
    }
    let golden = std::fs::read_to_string(path).unwrap();
    for (line, (is, was)) in text.lines().zip(golden.lines()).enumerate() {
        assert!(is == was, "line {}: is {is}, was {was}", line + 1);
    }
    assert_eq!(text.lines().count(), golden.lines().count());
}
