//! A step of the body's magnetisation is named as one, and not taken for passing iron.

use super::{names, recorded_with, said_of};

#[test]
fn a_step_is_no_target_and_no_drift() {
    let step = "permanent_step:time_s=120,x_nT=1,y_nT=-0.8,z_nT=0.5";
    // On the second what would be a target beside 18 terms alone had taken it, and a drift with the temperature been named for the rest.
    for seed in [1, 4] {
        let told = said_of(&recorded_with("lake_tow.toml", Some(seed), &[step]));
        assert_eq!((names(&told), told.targets.len()), (vec!["permanent_step"], 0), "{seed}");
    }
}
