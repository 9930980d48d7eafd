//! Clean recordings of a body that is rocked and shaken on land, with eddy currents of hundreds of nT per rad/s: what the fluxgate's
//! noise leaves there follows the motion, and is no gap and no target.

use host_sim::diagnosis::Verdict;

use super::{recorded, said_of};

#[test]
fn a_clean_calibration_on_land_has_no_gap_and_no_targets() {
    for seed in [3, 9, 16, 21] {
        let told = said_of(&recorded("land_calibration.toml", Some(seed)));
        assert_eq!((told.verdict, told.targets.len()), (Verdict::NoGap, 0), "{seed}");
    }
}
