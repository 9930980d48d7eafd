//! What the adaptive method says of itself.

use serde::Serialize;
use towmag::estimate::{Adaptation, Quality};

/// What the adaptive method said of itself, over the rows that it learnt from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct AdaptationSummary {
    /// Root mean square of the predicted standard deviations, nT: to be held against `std_after_nT`.
    pub predicted_std_nT: f64,
    /// Share of the information at the end that is not the calibration's.
    pub adapted_share: f64,
    /// Share of rows too surprising to be learnt: targets and spikes.
    pub surprised_share: f64,
    /// Share of rows in which less was learnt than was forgotten.
    pub resting_share: f64,
    /// Share of rows within half a minute after predictions had failed for too long to be a target.
    pub relearning_share: f64,
}

/// What a method said of itself, over the compensated rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AdaptationCounts {
    rows: u64,
    variance: f64,
    surprised: u64,
    resting: u64,
    relearning: u64,
    adapted: f32,
}

impl AdaptationCounts {
    pub(super) fn add(&mut self, quality: &Quality) {
        let Quality { predicted_std_nt, adapted, adaptation } = *quality;
        self.adapted = adapted;
        if adaptation == Adaptation::Waiting {
            return;
        }
        self.rows += 1;
        self.variance += f64::from(predicted_std_nt).powi(2);
        self.surprised += u64::from(adaptation == Adaptation::Surprised);
        self.resting += u64::from(adaptation == Adaptation::Resting);
        self.relearning += u64::from(adaptation == Adaptation::Relearning);
    }

    /// For the summary; `None` for a method that says nothing.
    pub fn summary(&self) -> Option<AdaptationSummary> {
        let share = |count: u64| count as f64 / self.rows as f64;
        (self.rows > 0).then(|| AdaptationSummary {
            predicted_std_nT: (self.variance / self.rows as f64).sqrt(),
            adapted_share: f64::from(self.adapted),
            surprised_share: share(self.surprised),
            resting_share: share(self.resting),
            relearning_share: share(self.relearning),
        })
    }
}
