//! Whether the 95 % intervals of the parameters hold the true values.

use std::collections::BTreeMap;

use super::judged::{Judged, alone};
use super::rate::Rate;
use crate::said::{SaidEffect, SaidParameter};

/// Of effects named alone and rightly, by effect, without those with an axis: an axis and its opposite are the same.
pub(super) fn coverage(singles: &[Judged<'_>]) -> BTreeMap<String, Rate> {
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for (answer, result) in singles {
        let hidden = &answer.hidden[0];
        let Some(effect) = alone(result.diagnosis.said(), hidden) else { continue };
        if hidden.parameters.contains_key("axis_azimuth_deg") {
            continue;
        }
        let truth = as_described(&hidden.parameters, effect);
        for estimate in &effect.parameters {
            let (Some(truth), Some(ci95)) = (truth.get(&estimate.name), estimate.ci95) else { continue };
            let (hits, of) = counts.entry(hidden.name.clone()).or_default();
            *of += 1;
            *hits += usize::from(holds(estimate, ci95, *truth));
        }
    }
    counts.into_iter().map(|(name, (hits, of))| (name, Rate::new(hits, of))).collect()
}

fn holds(estimate: &SaidParameter, [low, high]: [f64; 2], truth: f64) -> bool {
    let turn = match estimate.name.as_str() {
        "phase" => 1.0,
        "phase_rad" => std::f64::consts::TAU,
        _ => return (low..=high).contains(&truth),
    };
    let middle = 0.5 * (low + high);
    (low..=high).contains(&(truth - turn * ((truth - middle) / turn).round()))
}

/// A load that is on for a while is, but for a constant moment which the 18 terms take, one with the opposite moment that is
/// on for the rest of the time: the description of the two that was given.
fn as_described(hidden: &BTreeMap<String, f64>, effect: &SaidEffect) -> BTreeMap<String, f64> {
    let mut truth = hidden.clone();
    let said = effect.parameters.iter().find(|estimate| estimate.name == "duty").and_then(|duty| duty.value);
    let (Some(said), Some(&duty), Some(&phase)) = (said, hidden.get("duty"), hidden.get("phase")) else { return truth };
    if (said - duty).abs() > (said - (1.0 - duty)).abs() {
        truth.insert("duty".into(), 1.0 - duty);
        truth.insert("phase".into(), phase - duty);
        ["x_nT", "y_nT", "z_nT"].iter().for_each(|name| _ = truth.entry(name.to_string()).and_modify(|nt| *nt = -*nt));
    }
    truth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_is_the_same_after_a_turn() {
        let estimate = |name: &str| SaidParameter { name: name.into(), value: None, ci95: None };
        assert!(holds(&estimate("phase"), [0.95, 1.05], 0.01));
        assert!(!holds(&estimate("phase"), [0.95, 1.05], 0.5));
        assert!(holds(&estimate("lag_s"), [0.01, 0.02], 0.015));
    }
}
