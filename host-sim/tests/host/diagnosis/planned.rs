//! What a plan promises is what a diagnosis of the tow then says.

use std::sync::LazyLock;

use host_sim::diagnosis::{Alike, DiagnoseSettings, ManoeuvreKind, Plan, PlannedEffect, Verdict, plan};

use super::{names, recorded, recorded_with, said_of};

fn planned(preset: &str) -> Plan {
    plan(&recorded(preset, None), &DiagnoseSettings::default()).expect("long enough")
}

/// Made once for all tests.
fn on_lake() -> &'static Plan {
    static PLAN: LazyLock<Plan> = LazyLock::new(|| planned("lake_tow.toml"));
    &PLAN
}

fn effect<'p>(plan: &'p Plan, name: &str) -> &'p PlannedEffect {
    plan.effects.iter().find(|effect| effect.name == name).expect("planned")
}

/// What a plan says of taking a lag for a low-pass.
fn low_pass_for_lag(plan: &Plan) -> &Alike {
    let alike = &effect(plan, "scalar_lag").alike;
    alike.iter().find(|alike| alike.name == "scalar_lowpass").expect("they look alike")
}

/// An effect in a tow of other noise, some times as strong as the least that is found.
fn told(plan: &Plan, name: &str, times: f64) -> (Verdict, Vec<&'static str>) {
    let planned = effect(plan, name);
    let (size, at_1) = planned.at_strength_1[0];
    let request = format!("{name}:{size}={}", at_1 * times * planned.found_from.expect("found"));
    let found = said_of(&recorded_with("lake_tow.toml", Some(71), &[&request]));
    (found.verdict, names(&found))
}

#[test]
fn what_a_plan_finds_a_diagnosis_finds_and_what_is_weaker_it_does_not() {
    let plan = on_lake();
    for name in ["depth_gradient", "scalar_lag"] {
        let (verdict, names) = told(plan, name, 3.0);
        let alike: Vec<&str> = effect(plan, name).alike.iter().map(|alike| alike.name).collect();
        let is_named = |named: &&str| *named == name || alike.contains(named);
        assert!(verdict == Verdict::Explained && names.iter().all(is_named) && names.len() == 1, "{name}: {names:?}");
        assert_eq!(told(plan, name, 0.25), (Verdict::NoGap, vec![]), "{name}");
    }
}

#[test]
fn delays_look_alike_on_a_calm_tow_and_a_shake_tells_them_apart() {
    let plan = on_lake();
    let low_pass = low_pass_for_lag(plan);
    let segment = plan.segments.iter().find(|segment| segment.kind == ManoeuvreKind::Shake).expect("a shake");
    let pair = segment.separates.iter().find(|pair| pair.names == ["scalar_lag", "scalar_lowpass"]).expect("the pair");
    assert!(low_pass.apart_from.is_none_or(|without| pair.apart_from < without), "{low_pass:?} {pair:?}");
    // On land the body is shaken: a shorter delay is told apart.
    let land = planned("land_calibration.toml");
    let apart_from_s = |plan: &Plan| {
        let strength = low_pass_for_lag(plan).apart_from.expect("some delay is told apart");
        strength * effect(plan, "scalar_lag").at_strength_1[0].1
    };
    let [on_land_s, on_lake_s] = [&land, plan].map(apart_from_s);
    assert!(on_land_s < 0.8 * on_lake_s, "{on_land_s} {on_lake_s}");
}
