//! What is drawn: the same for a seed, other for another setting, targets in two of three and none unless asked for.
use std::sync::Mutex;

use towmag_trial::{Answer, BlindTrial, Kind, Setting, TrialError, TrialOptions};

fn options(setting: Setting) -> TrialOptions {
    TrialOptions { recordings: 16, seed: 8, minutes: Some(2.0), setting, ..TrialOptions::default() }
}

/// Answers, and every recording as text.
fn drawn(options: &TrialOptions) -> (Vec<Answer>, Vec<String>) {
    let blind = BlindTrial::draw(options.clone(), None, || {}).unwrap();
    let texts = Mutex::new(vec![String::new(); options.recordings]);
    blind
        .recordings(|index, csv| {
            texts.lock().unwrap()[index] = csv.into();
            Ok::<(), TrialError>(())
        })
        .unwrap();
    (serde_json::from_str(blind.answers()).unwrap(), texts.into_inner().unwrap())
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_setting_other_ones() {
    let trial = drawn(&options(Setting::Trial));
    assert_eq!(trial, drawn(&options(Setting::Trial)));
    let tuning = drawn(&options(Setting::Tuning));
    assert_ne!(trial.1, tuning.1);
    // The jerks of the one are not those of the other.
    let has = |answers: &[Answer], motion: &str| answers.iter().any(|answer| answer.motion == motion);
    assert!(!has(&trial.0, "knocked") && !has(&tuning.0, "jerky"));
}

#[test]
fn targets_are_in_both_sensors_of_a_recording_where_the_answers_say() {
    let with = TrialOptions { targets: Some(true), ..options(Setting::Trial) };
    let without = TrialOptions { targets: Some(false), ..with.clone() };
    let ((answers, with), (bare, without)) = (drawn(&with), drawn(&without));
    assert!(bare.iter().all(|answer| answer.targets.is_empty()));
    for (answer, (with, without)) in answers.iter().zip(with.iter().zip(&without)) {
        assert!(!answer.targets.is_empty() && answer.hidden.len() == bare[answer.index].hidden.len());
        // What the effects make of a target is not what is tried here.
        if !matches!(answer.kind, Kind::None | Kind::Foreign) {
            continue;
        }
        for target in &answer.targets {
            let [a, b] = [with, without].map(|csv| readings_nt(csv, target.time_s));
            let size = |nt: &[f64]| (nt[1] * nt[1] + nt[2] * nt[2] + nt[3] * nt[3]).sqrt();
            // Both are noisy alike and rounded by up to 3 nT, and there are other targets.
            let off = [a[0] - b[0], size(&a) - size(&b)].map(|nt| (nt - target.peak_nt).abs());
            assert!(off.iter().all(|nt| *nt < 4.0 + 0.6 * target.peak_nt.abs()), "{target:?} {off:?}");
        }
    }
}

#[test]
fn lengths_are_drawn_where_none_is_asked_for() {
    let options = TrialOptions { recordings: 12, minutes: None, ..options(Setting::Tuning) };
    let blind = BlindTrial::draw(options, None, || {}).unwrap();
    let answers: Vec<Answer> = serde_json::from_str(blind.answers()).unwrap();
    let minutes: Vec<f64> = answers.iter().map(|answer| answer.minutes).collect();
    assert!(minutes.iter().all(|minutes| (2.0..=60.0).contains(minutes)));
    assert!(minutes.windows(2).all(|two| two[0] != two[1]));
}

/// Scalar and fluxgate of the row nearest to a time.
fn readings_nt(csv: &str, time_s: f64) -> Vec<f64> {
    let row = |line: &str| -> Vec<f64> { line.split(',').take(5).map(|field| field.parse().unwrap()).collect() };
    let far = |row: &Vec<f64>| (row[0] - time_s).abs();
    let nearest = csv.lines().skip(1).map(row).min_by(|a, b| far(a).total_cmp(&far(b)));
    nearest.unwrap()[1..].to_vec()
}
