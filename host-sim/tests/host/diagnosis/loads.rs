//! Loads that are switched.

use host_sim::diagnosis::Verdict;

use super::{names, recorded_with, said_of};

#[test]
fn a_weak_load_of_a_long_period_is_found_by_its_edges() {
    // A recording holds eight periods, and the background has what is slower than their third harmonic.
    let effect = "load_current:x_nT=0.25,y_nT=-0.16,z_nT=0.04,period_s=30.66,duty=0.265,phase=0.27";
    let found = said_of(&recorded_with("land_calibration.toml", Some(4), &[effect]));
    assert_eq!((found.verdict, names(&found)), (Verdict::Explained, vec!["load_current"]));
    let period = found.effects[0].parameters.iter().find(|parameter| parameter.name == "period_s").expect("a period");
    assert!(period.value.is_some_and(|period_s| (period_s - 30.66).abs() < 0.01), "{period:?}");
}
