//! Whether the 95 % intervals of the parameters hold the true values.

use std::collections::BTreeMap;

use super::judged::{Judged, alone};
use super::rate::Rate;
use crate::said::{SaidEffect, SaidParameter};
use crate::world::vector::{axis, dot};

/// Of effects named alone and rightly, by effect, without a heading error: an axis and its opposite are the same there, with other numbers.
pub(super) fn coverage(singles: &[Judged<'_>]) -> BTreeMap<String, Rate> {
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for (answer, result) in singles {
        let hidden = &answer.hidden[0];
        let Some(effect) = alone(result.diagnosis.said(), hidden) else { continue };
        if hidden.parameters.contains_key("cubic_nT") {
            continue;
        }
        let truth = in_sense(as_described(&hidden.parameters, effect), &effect.parameters);
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
        "axis_azimuth_deg" => 360.0,
        _ => return (low..=high).contains(&truth),
    };
    let middle = 0.5 * (low + high);
    (low..=high).contains(&(truth - turn * ((truth - middle) / turn).round()))
}

/// An axis in the sense that was described, if it has one.
fn in_sense(truth: BTreeMap<String, f64>, described: &[SaidParameter]) -> BTreeMap<String, f64> {
    let said = |name: &str| described.iter().find(|estimate| estimate.name == name).and_then(|said| said.value);
    let names = ["axis_azimuth_deg", "axis_elevation_deg"];
    let ([Some(&azimuth_deg), Some(&elevation_deg)], [Some(said_azimuth_deg), Some(said_elevation_deg)]) =
        (names.map(|name| truth.get(name)), names.map(said))
    else {
        return truth;
    };
    if dot(axis(azimuth_deg, elevation_deg), axis(said_azimuth_deg, said_elevation_deg)) >= 0.0 {
        return truth;
    }
    let opposite = [(names[0], azimuth_deg + 180.0), (names[1], -elevation_deg)];
    truth.into_iter().chain(opposite.map(|(name, value)| (name.into(), value))).collect()
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

    #[test]
    fn an_axis_and_its_opposite_are_the_same() {
        let said = |name: &str, value| SaidParameter { name: name.into(), value: Some(value), ci95: None };
        let described = [said("axis_azimuth_deg", -150.0), said("axis_elevation_deg", 20.0)];
        let truth = |azimuth_deg, elevation_deg| {
            in_sense(
                [("axis_azimuth_deg".into(), azimuth_deg), ("axis_elevation_deg".into(), elevation_deg)].into(),
                &described,
            )
        };
        assert_eq!(truth(30.0, -20.0), truth(210.0, 20.0));
        assert!(holds(&said("axis_azimuth_deg", -150.0), [-155.0, -145.0], truth(30.0, -20.0)["axis_azimuth_deg"]));
    }
}
