use super::judged::Judged;
use super::names::{has_false_name, is_wrong_and_claimed};
use super::{several, targets};
use crate::answer::Answer;
use crate::reply::{Reply, TrialResult};

/// An answer that hides effects, and targets at times with peaks.
fn answer(hidden: &[&str], targets: &[(f64, f64)]) -> Answer {
    let hidden: Vec<serde_json::Value> = hidden
        .iter()
        .map(|name| serde_json::json!({"name": name, "parameters": {}, "strength": 3.0, "identifiable": 20.0}))
        .collect();
    let targets: Vec<serde_json::Value> = targets
        .iter()
        .map(|(time_s, peak_nt)| serde_json::json!({"time_s": time_s, "peak_nT": peak_nt, "width_s": 3.0}))
        .collect();
    let answer = serde_json::json!({
        "index": 0, "kind": "pair", "minutes": 30.0, "motion": "sea", "noise": "white", "noise_rms_nT": 0.1,
        "fluxgate_noise_rms_nT": 1.0, "recorder": "fine", "world": 0, "hidden": hidden, "targets": targets
    });
    serde_json::from_value(answer).unwrap()
}

/// A diagnosis that names effects, each with a probability and one other in its set, and lists targets.
fn result(verdict: &str, named: &[(&str, f64, &str)], listed_s: &[f64]) -> TrialResult {
    let effects: Vec<serde_json::Value> = named
        .iter()
        .map(|(name, probability, alike)| {
            serde_json::json!({"name": name, "probability": probability, "parameters": [],
                "gap_closed": {"fraction": 0.9, "ci95": [0.8, 1.0]}, "indistinguishable_from": [alike]})
        })
        .collect();
    let targets: Vec<serde_json::Value> = listed_s.iter().map(|at| serde_json::json!({"time_s": at})).collect();
    let json = serde_json::json!({"verdict": verdict, "effects": effects, "candidates": [], "targets": targets});
    TrialResult { diagnosis: Reply::read("recording 0", json.to_string()).unwrap(), put_back: None }
}

#[test]
fn a_target_is_listed_within_its_width_and_what_is_near_none_is_invented() {
    let answer = answer(&[], &[(100.0, -6.0), (200.0, 50.0), (300.0, 1.0)]);
    let result = result("no_gap", &[], &[102.9, 204.0, 299.0, 500.0]);
    let score = targets::of(&[(&answer, &result), (&answer, &result)]);
    assert_eq!((score.large_listed.hits, score.large_listed.of), (2, 4));
    assert_eq!((score.small_listed.hits, score.small_listed.of), (2, 2));
    // At 204 and 500 s, in each of two recordings of half an hour.
    assert_eq!((score.invented, score.hours, score.invented_per_hour()), (4, 1.0, Some(4.0)));
}

#[test]
fn a_claim_is_wrong_by_its_first_name_and_a_name_is_false_from_one_half_on() {
    let answer = answer(&["scalar_lag"], &[]);
    let wrong = |verdict, named: &[(&str, f64, &str)]| {
        let result = result(verdict, named, &[]);
        let judged: Judged<'_> = (&answer, &result);
        (is_wrong_and_claimed(&judged), has_false_name(&judged))
    };
    let (right, alike) = (("scalar_lag", 0.9, ""), ("scalar_lowpass", 0.8, "scalar_lag"));
    assert_eq!(wrong("explained", &[right, ("mains_alias", 0.4, "")]), (false, false));
    assert_eq!(wrong("explained", &[alike, ("mains_alias", 0.6, "")]), (false, true));
    assert_eq!(wrong("explained", &[("mains_alias", 0.9, ""), right]), (true, true));
    assert_eq!(wrong("partly_explained", &[("mains_alias", 0.9, "")]), (false, true));
}

#[test]
fn several_effects_are_found_when_each_is() {
    let answer = answer(&["scalar_lag", "mains_alias", "dead_zone"], &[]);
    let lag = ("scalar_lag", 0.9, "");
    let two = result("explained", &[lag, ("mains_alias", 0.9, "")], &[]);
    let three = result("explained", &[lag, ("mains_alias", 0.9, ""), ("sample_jitter", 0.9, "dead_zone")], &[]);
    let score = several::of("Three effects", &[(&answer, &two), (&answer, &three)]);
    assert_eq!((score.all.hits, score.one.hits, score.all.of), (1, 2, 2));
}
