//! Loads that are switched.

use super::simulated::recorded_with;
use super::{DiagnoseSettings, diagnose};
use crate::diagnosis::result::Verdict;

#[test]
fn a_weak_load_of_a_long_period_is_found_by_its_edges() {
    // A recording holds eight periods, and the background has what is slower than their third harmonic.
    let effect = "load_current:x_nT=0.25,y_nT=-0.16,z_nT=0.04,period_s=30.66,duty=0.265,phase=0.27";
    let table = recorded_with("land_calibration.toml", Some(4), &[effect]);
    let found = diagnose(&table, None, &DiagnoseSettings::default()).expect("long enough");
    let names: Vec<&str> = found.effects.iter().map(|effect| effect.name).collect();
    assert_eq!((found.verdict, &names[..]), (Verdict::Explained, &["load_current"][..]));
    let period = found.effects[0].parameters.iter().find(|parameter| parameter.name == "period_s").expect("a period");
    assert!(period.value.is_some_and(|period_s| (period_s - 30.66).abs() < 0.01), "{period:?}");
}
