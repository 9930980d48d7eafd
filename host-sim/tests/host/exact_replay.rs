//! `host-sim diagnose` on a device log: first of all, an exact replay.

use std::path::{Path, PathBuf};

use crate::device::{Card, card, card_of, card_that};
use host_sim::command::{self, DiagnoseOptions};
use host_sim::diagnosis::{Diagnosis, Outcome, Verdict};
use host_sim::simulator::sample_calibration;
use tempfile::TempDir;
use towmag::model::Coefficients;
use towmag::{Compensated, Method, Output, Settings};

fn diagnosed(folder: &TempDir, card: &Card, coefficients: Option<&Path>) -> Diagnosis {
    let log = folder.path().join("TOWMAG01.BIN");
    std::fs::write(&log, card.0.concat()).unwrap();
    let options = DiagnoseOptions { coefficients, seed: 1, ..DiagnoseOptions::default() };
    command::diagnose(&log, &folder.path().join("out"), &options).unwrap()
}

/// One bit of the residual from a tick on.
fn flipped_from(first_tick: u32) -> impl Fn(Output) -> Output {
    move |output| {
        let flip = |compensated: Compensated| Compensated {
            residual_nt: f32::from_bits(compensated.residual_nt.to_bits() ^ 1),
            ..compensated
        };
        if output.tick < first_tick { output } else { Output { compensated: output.compensated.map(flip), ..output } }
    }
}

#[test]
fn an_intact_log_is_diagnosed_as_any_recording() {
    let folder = tempfile::tempdir().unwrap();
    let diagnosis = diagnosed(&folder, &card(), None);
    let [first, second] = &diagnosis.exact_replay[..] else { panic!("{:?}", diagnosis.exact_replay) };
    assert_eq!((&first.outcome, first.compared_epochs, &first.stopped), (&Outcome::Equal, 3000, &None));
    assert_eq!((&second.outcome, second.compared_epochs), (&Outcome::Equal, 1900), "up to the loss");
    assert_eq!(second.stopped.as_deref(), Some("the body lost records after tick 4999"));
    assert!(diagnosis.effects.iter().all(|effect| effect.name != "firmware_mismatch"));
    assert!(!diagnosis.channels.is_empty());
}

#[test]
fn one_bit_in_an_output_is_the_finding_and_nothing_else_is_claimed() {
    let folder = tempfile::tempdir().unwrap();
    let card = card_of(Method::SaddlePoint, &Coefficients::ZERO.into(), flipped_from(4321));
    let diagnosis = diagnosed(&folder, &card, None);
    assert_eq!(diagnosis.verdict, Verdict::Explained);
    let [effect] = &diagnosis.effects[..] else { panic!("{:?}", diagnosis.effects) };
    assert_eq!((effect.name, effect.probability, effect.gap_closed.held_out), ("firmware_mismatch", 1.0, false));
    let [cell] = &diagnosis.cells[..] else { panic!("{:?}", diagnosis.cells) };
    assert_eq!((cell.by, cell.cell.as_str(), cell.channel), ("stage", "estimator", "firmware"));
    assert_eq!(diagnosis.candidates.iter().map(|candidate| candidate.probability).sum::<f64>(), 1.0);
    assert_eq!(diagnosis.exact_replay[0].outcome, Outcome::Equal);
    assert!(matches!(diagnosis.exact_replay[1].outcome, Outcome::Differs { first_tick: 4321, epochs: 679, .. }));
    let said = host_sim::text::diagnosis_terminal::text(&diagnosis);
    assert!(said.contains("679 of 1900 epochs differ from their replay, the first at tick 4321"), "{said}");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("the first at tick 4321"));
}

#[test]
fn what_comes_after_a_loss_is_not_compared() {
    let folder = tempfile::tempdir().unwrap();
    let card = card_of(Method::SaddlePoint, &Coefficients::ZERO.into(), flipped_from(5010));
    let diagnosis = diagnosed(&folder, &card, None);
    assert!(diagnosis.exact_replay.iter().all(|session| session.outcome == Outcome::Equal));
    assert!(diagnosis.effects.iter().all(|effect| effect.name != "firmware_mismatch"));
}

/// The adaptive method starts from more than the header holds: what follows the header, or the calibration's file.
#[test]
fn an_adaptive_session_needs_its_information() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("cal.csv");
    std::fs::write(&recording, command::recording(&sample_calibration())).unwrap();
    let calibrated = command::calibrate(&recording, &folder.path().join("cal"), &Settings::default()).unwrap();
    let prior = calibrated.file.prior().unwrap();
    let file: PathBuf = folder.path().join("cal/coefficients.toml");
    let told = diagnosed(&folder, &card_of(Method::Adaptive, &prior, |output| output), None);
    let honest = card_that(false, Method::Adaptive, &prior, |output| output);
    let unchecked = diagnosed(&folder, &honest, None);
    let all = |diagnosis: &Diagnosis, is: fn(&Outcome) -> bool| diagnosis.exact_replay.iter().all(|s| is(&s.outcome));
    assert!(all(&unchecked, |outcome| matches!(outcome, Outcome::Unchecked { .. })), "{:?}", unchecked.exact_replay);
    assert!(unchecked.effects.iter().all(|effect| effect.name != "firmware_mismatch"));
    assert!(all(&told, |outcome| *outcome == Outcome::Equal), "{:?}", told.exact_replay);
    let checked = diagnosed(&folder, &honest, Some(&file));
    assert!(all(&checked, |outcome| *outcome == Outcome::Equal), "{:?}", checked.exact_replay);
    let changed = diagnosed(&folder, &card_of(Method::Adaptive, &prior, flipped_from(1234)), Some(&file));
    assert!(matches!(changed.exact_replay[0].outcome, Outcome::Differs { first_tick: 1234, .. }));
    assert_eq!(changed.effects[0].name, "firmware_mismatch");
}
