//! Clean recordings of a body that is rocked and shaken on land, with eddy currents of hundreds of nT per rad/s: what the fluxgate's
//! noise leaves there follows the motion, and is no gap and no target.

use super::simulated::recorded;
use super::{DiagnoseSettings, diagnose};
use crate::diagnosis::result::Verdict;

#[test]
fn a_clean_calibration_on_land_has_no_gap_and_no_targets() {
    for seed in [3, 9, 16, 21] {
        let told = diagnose(&recorded("land_calibration.toml", Some(seed)), None, &DiagnoseSettings::default());
        let told = told.expect("long enough");
        assert_eq!((told.verdict, told.targets.len()), (Verdict::NoGap, 0), "{seed}");
    }
}
