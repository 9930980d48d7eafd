//! What the band-pass makes of a target: later, smaller, and with both signs.

use towmag::filter::{BandPassDesign, BandPassError, BandPassState};

use crate::simulator::Target;

/// How long before and after its peak a target is followed, s: the band-pass rings for some periods of its lower corner.
const AROUND_S: f64 = 30.0;

/// Where a target shows in the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPulse {
    /// Width at half the peak of the target, s.
    pub width_s: f64,
    /// How much later the band shows it largest, s.
    pub late_s: f64,
    /// The largest over the target's peak; negative where the sign is turned.
    pub share: f64,
}

/// A target of `width_s` through the causal band-pass.
///
/// # Errors
///
/// When the band-pass cannot be built.
pub fn band_pulse(design: BandPassDesign, width_s: f64) -> Result<BandPulse, BandPassError> {
    let band_pass = design.build()?;
    let mut state = BandPassState::default();
    let target = Target { time_s: 0.0, peak_nt: 1.0, width_s };
    let mut largest = (0.0, 0.0);
    let rows = (AROUND_S * design.sample_rate_hz) as i32;
    for row in -rows..=rows {
        let time_s = f64::from(row) / design.sample_rate_hz;
        let [passed] = band_pass.step(&mut state, &[target.anomaly_nt(time_s) as f32]);
        if f64::from(passed).abs() > f64::abs(largest.1) {
            largest = (time_s, f64::from(passed));
        }
    }
    Ok(BandPulse { width_s, late_s: largest.0, share: largest.1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a user met: 8 nT at 520 s, and the largest residual -4.3 nT at 521.5 s.
    #[test]
    fn a_target_shows_late_small_and_upside_down() {
        let pulse = band_pulse(BandPassDesign::default(), 2.0).unwrap();
        assert!((1.0..2.0).contains(&pulse.late_s), "{pulse:?}");
        assert!((-0.7..-0.4).contains(&pulse.share), "{pulse:?}");
    }
}
