//! The interference that is written: the bank's in the band, the level's below it, and the level's in both where it
//! predicts the band better.

use super::super::robust::tracked_std;
use super::config::Level;
use super::estimator::LevelEstimator;
use super::gauge::Gauge;
use crate::filter::BandPassState;
use crate::model::{Coefficients, TermVector};
use crate::policy::{DEFAULT_NOISE_NT, LEVEL_LOSES_THE_BAND, LEVEL_TAKES_THE_BAND};

/// First-order low-passes one after the other: four let 0.0005 of what is at the band's lower edge through. Two let 0.02
/// through, which is 0.3 of the bound where the level estimator fits badly (flights, C moved).
const LOW_PASSES: usize = 4;

/// What is known of the epoch that is written.
#[derive(Clone, Copy, Debug)]
pub struct Written<'a> {
    /// Columns for the level's coefficients.
    pub columns: &'a TermVector,
    /// Reading, pT.
    pub scalar_pt: i32,
    /// The bank's interference, nT.
    pub followed_nt: f64,
    /// What the bank leaves of the reading in the band, nT.
    pub residual_nt: f32,
    /// Whether the band-pass has begun anew.
    pub is_first: bool,
    /// Whether its transient is over.
    pub settled: bool,
}

/// What it remembers.
#[derive(Clone, Debug)]
pub struct LevelOutput {
    gauge: Gauge,
    /// Such that new coefficients make no step, nT; fades.
    anchor_nt: f32,
    /// Of the level's interference less the bank's, nT, one after the other.
    low_passes_nt: Option<[f64; LOW_PASSES]>,
    band: BandPassState<1>,
    reference_pt: i32,
    /// In the band: standard deviation of what the level leaves, and of what the bank leaves, nT.
    std_nt: [f32; 2],
    /// Whether the band is to be the level's, and how much of it is.
    has_band: bool,
    share: f32,
}

impl LevelOutput {
    /// Before the first epoch.
    pub const START: Self = Self {
        gauge: Gauge::START,
        anchor_nt: 0.0,
        low_passes_nt: None,
        band: BandPassState::ZERO,
        reference_pt: 0,
        std_nt: [DEFAULT_NOISE_NT; 2],
        has_band: false,
        share: 0.0,
    };

    /// The interference of an epoch, nT, by coefficients that have not seen it.
    pub fn step(&mut self, level: &Level, coefficients: &Coefficients, written: &Written<'_>) -> f64 {
        self.gauge.step(written.columns, level.rate_hz);
        self.anchor_nt -= level.anchor_rate * self.anchor_nt;
        let level_nt = self.level_nt(coefficients, written.columns) + self.anchor_nt;
        let apart_nt = f64::from(level_nt) - written.followed_nt;
        let mut slow_nt = apart_nt;
        for passed_nt in self.low_passes_nt.get_or_insert([apart_nt; LOW_PASSES]) {
            *passed_nt += level.low_pass_rate * (slow_nt - *passed_nt);
            slow_nt = *passed_nt;
        }
        let interference_nt = written.followed_nt + slow_nt + f64::from(self.share) * (apart_nt - slow_nt);
        // Afterwards: what is written must not have seen the reading of its epoch.
        self.judge(level, level_nt, written);
        interference_nt
    }

    /// The coefficients have changed, `columns` are those of the latest epoch: go on from where the output is.
    pub fn change(&mut self, before: &Coefficients, after: &LevelEstimator, columns: &TermVector) {
        self.anchor_nt += self.level_nt(before, columns) - self.level_nt(after.as_ref(), columns);
    }

    /// Interference less its mean over a circle of headings, nT.
    fn level_nt(&self, coefficients: &Coefficients, columns: &TermVector) -> f32 {
        coefficients.predict_nt(columns) - self.gauge.mean_nt(coefficients)
    }

    /// Whose the band is: the level's once it has left clearly less than the bank, until it leaves much more. The bank follows
    /// whatever comes, targets too, and while the body turns its interference then goes tens of nT astray, which nothing
    /// slower than the band can mend in time: a level that has proved right keeps the band.
    fn judge(&mut self, level: &Level, level_nt: f32, written: &Written<'_>) {
        if written.is_first {
            self.reference_pt = written.scalar_pt;
        }
        let compensated_nt = (written.scalar_pt - self.reference_pt) as f32 / 1000.0 - level_nt;
        if written.is_first {
            self.band = BandPassState::steady(&[compensated_nt]);
        }
        let [left_nt] = level.band_pass.step(&mut self.band, &[compensated_nt]);
        if !written.settled {
            return;
        }
        for (std_nt, left_nt) in self.std_nt.iter_mut().zip([left_nt, written.residual_nt]) {
            *std_nt = tracked_std(*std_nt, left_nt, level.judge_rate);
        }
        let [of_level, of_bank] = self.std_nt;
        let ratio = if self.has_band { LEVEL_LOSES_THE_BAND } else { LEVEL_TAKES_THE_BAND };
        self.has_band = of_bank > ratio * of_level;
        self.share += level.switch_rate * (f32::from(u8::from(self.has_band)) - self.share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::BandPassDesign;

    #[test]
    fn a_level_that_has_proved_right_keeps_the_band() {
        let level = Level::new(BandPassDesign::default()).unwrap();
        let (mut output, columns) = (LevelOutput::START, TermVector::zeros());
        let mut epoch = 0_u32;
        // Two minutes in which the bank leaves a multiple of what the level does.
        let mut share_after = |ratio: f32| {
            for _ in 0..1_200 {
                let left_nt = libm::sinf(core::f32::consts::TAU * 0.4 * 0.1 * epoch as f32);
                let written = Written {
                    columns: &columns,
                    scalar_pt: (1000.0 * left_nt) as i32,
                    followed_nt: 0.0,
                    residual_nt: ratio * left_nt,
                    is_first: epoch == 0,
                    settled: true,
                };
                output.step(&level, &Coefficients::ZERO, &written);
                epoch += 1;
            }
            output.share
        };
        let ratios = [1.0, 1.3, 1.0, 0.75, 0.5, 1.1];
        let has_band = ratios.map(|ratio| share_after(ratio) > 0.5);
        assert_eq!(has_band, [false, true, true, true, false, false]);
    }
}
