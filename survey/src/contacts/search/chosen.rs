//! Which peaks of what is left are looked at next.

use super::pruning::CANDIDATES_FROM_ENDS;
use super::{APART, JOINT, Rejected, Search};
use crate::contacts::levelled::RATE_HZ;
use crate::contacts::scan::{Peak, peaks};
use crate::contacts::stretch::Stretch;

/// Flanks of a dipole that is not taken off yet: within so many of its distances, what explains less than this share of it; and,
/// as whitening spreads what is slow, within so many seconds what explains less than that share.
const FLANKS: f64 = 8.0;
const FLANK_SHARE: f64 = 0.5;
const SPREAD_S: f64 = 200.0;
const SPREAD_SHARE: f64 = 0.05;

impl Search<'_> {
    /// All peaks of what is left, the largest first, but for those near ends and those that were let go.
    pub(super) fn peaks(&self, left: &[Stretch]) -> Vec<Peak> {
        let of = |k: usize| peaks(&self.noise, &self.transforms[k], k, &left[k].values, self.options.distances_s);
        let is_kept = |peak: &Peak| {
            let is_rejected = self.rejected.iter().any(|rejected| rejected.has(peak));
            !is_rejected && self.is_far_from_ends(peak.stretch, peak.cell, CANDIDATES_FROM_ENDS * peak.distance_s)
        };
        let mut all: Vec<Peak> = (0..left.len()).flat_map(of).filter(is_kept).collect();
        all.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
        all
    }

    /// The rate of noise is that of this recording's own peaks.
    pub(super) fn scale_null(&mut self, peaks: &[Peak]) {
        let threshold = self.threshold();
        let strong: Vec<Peak> = peaks.iter().take_while(|peak| peak.glrt > threshold).copied().collect();
        let is_flank = |peak: &&Peak| strong.iter().any(|other| is_flank(peak, other));
        let glrts: Vec<f64> = peaks.iter().filter(|peak| !is_flank(peak)).map(|peak| peak.glrt).collect();
        self.null = self.null.scaled_to(&glrts, self.noise.hours());
    }

    /// The peaks above the threshold that stand apart.
    pub(super) fn chosen(&self, peaks: &[Peak]) -> Vec<Peak> {
        let threshold = self.threshold();
        let mut chosen: Vec<Peak> = Vec::new();
        for peak in peaks.iter().take_while(|peak| peak.glrt > threshold).filter(|peak| !self.is_model_error(peak)) {
            let is_near = |other: &Peak| {
                let apart_s = peak.cell.abs_diff(other.cell) as f64 / RATE_HZ;
                other.stretch == peak.stretch && apart_s < APART * peak.distance_s.max(other.distance_s)
            };
            if !chosen.iter().any(|other| is_near(other) || is_flank(peak, other)) {
                chosen.push(*peak);
            }
        }
        chosen
    }

    /// Whether it may be no more than what a strong contact beside it does not describe.
    fn is_model_error(&self, peak: &Peak) -> bool {
        let row = self.stretches[peak.stretch].row_near(peak.cell);
        let (at, distance) = (self.way.at[row], peak.distance_s * self.way.per_s[row]);
        peak.glrt < self.glrt_of_model_errors(at, |other| JOINT * (other.distance + distance), 0.0)
    }
}

impl Rejected {
    fn has(&self, peak: &Peak) -> bool {
        peak.stretch == self.stretch && self.cells.contains(&peak.cell) && peak.distance_s >= self.least_distance_s
    }
}

/// Whether a peak may be nothing but a flank of another.
fn is_flank(peak: &Peak, other: &Peak) -> bool {
    let apart_s = peak.cell.abs_diff(other.cell) as f64 / RATE_HZ;
    let is_near = apart_s < FLANKS * other.distance_s && peak.glrt < FLANK_SHARE * other.glrt;
    let is_far = apart_s < SPREAD_S && peak.glrt < SPREAD_SHARE * other.glrt;
    peak.stretch == other.stretch && (is_near || is_far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_no_dipole_passes_over_what_is_as_far_away_and_not_over_nearer_iron() {
        let rock = Rejected { stretch: 0, cells: 100..500, least_distance_s: 6.0 };
        let peak = |cell: usize, distance_s: f64| Peak { stretch: 0, cell, distance_s, glrt: 100.0 };
        assert!(rock.has(&peak(300, 6.0)) && rock.has(&peak(300, 15.0)));
        assert!(!rock.has(&peak(300, 2.0)) && !rock.has(&peak(500, 15.0)));
    }
}
