//! What to know of `residual_nT` before picking targets from it.

use super::number::short;
use crate::detection::BandPulse;

/// How late and in which sense a target shows there.
pub fn sentence(pulse: &BandPulse) -> String {
    let BandPulse { width_s, late_s, share } = *pulse;
    let sign = if share < 0.0 { "with the sign turned and " } else { "" };
    let late = short((10.0 * late_s).round() / 10.0);
    format!(
        "Do not read times or signs of targets here: the causal band-pass shows one of {} s width largest {late} s late, \
         {sign}with {:.0} % of its height",
        short(width_s),
        100.0 * share.abs()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delay_and_sign_are_said() {
        let pulse = BandPulse { width_s: 2.0, late_s: 1.5, share: -0.541 };
        let said = sentence(&pulse);
        assert!(
            said.ends_with("of 2 s width largest 1.5 s late, with the sign turned and with 54 % of its height"),
            "{said}"
        );
        assert!(!sentence(&BandPulse { share: 0.9, ..pulse }).contains("turned"));
    }
}
