//! What a gap means for whoever looks for iron: the smallest object that is still found with it in the data, and how well its place is
//! known, beside what the sensor's noise alone would allow and what is left with the named effects taken off.
//!
//! A matched filter finds a dipole by its energy over the density of what else is in the reading. That density is the noise model's,
//! or the one of the residual as it is, whatever its cause. The dipole is passed at [`DISTANCE_M`] and [`SPEED_M_PER_S`]: another
//! distance changes all figures alike, so that their ratios hold.

use towmag_survey::contacts::profiles;

use crate::diagnosis::findings::Findings;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::model::predictor_of_all;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::result::Consequence;

/// Closest distance of the object that stands for all, m, and speed of the tow, m/s.
const DISTANCE_M: f64 = 6.0;
const SPEED_M_PER_S: f64 = 2.0;
/// Field of a moment of 1 A m^2 at 1 m across it, nT: the magnetic constant over 4 pi.
const NT_M3_PER_AM2: f64 = 100.0;
/// Signal to noise from which nine in ten are found at one false contact an hour: a threshold of 5.0 in the survey's trial, and 1.28
/// standard deviations.
const FOUND_SNR: f64 = 6.3;
/// Places along the recording at which the object is tried.
const PLACES: usize = 12;

/// Of the scalar; `None` where the recording is too short for a spectrum.
pub(super) fn of(found: &Findings<'_>) -> Option<Consequence> {
    let channel = &found.scalar;
    let (before, after) = (&channel.selection, channel.named_from());
    let blocks = before.problem.whitening.blocks();
    let epochs_s = before.problem.signals.epochs_s();
    let of_residual = |residual_nt: &[f64]| Some(Limits::of(predictor_of_all(residual_nt, blocks)?, blocks, epochs_s));
    let noise = Limits::of(before.problem.whitening.predictor().clone(), blocks, epochs_s);
    let with_gap = of_residual(&before.problem.residual_nt(&before.before))?.no_better_than(noise);
    let with_effects = of_residual(&after.problem.residual_nt(&after.fit))?.no_better_than(noise);
    Some(Consequence {
        distance_m: DISTANCE_M,
        speed_m_per_s: SPEED_M_PER_S,
        smallest_moment_Am2: [noise, with_gap, with_effects].map(|limits| limits.smallest_am2),
        place_m: [noise, with_gap, with_effects].map(|limits| limits.place_m_of_1_am2 / with_gap.smallest_am2),
    })
}

/// What can be known of the object beside something with a spectrum.
#[derive(Clone, Copy)]
struct Limits {
    /// Smallest moment that is found, A m^2.
    smallest_am2: f64,
    /// Standard deviation of the place along the track of a moment of 1 A m^2, m (Cramer-Rao bound, all else known).
    place_m_of_1_am2: f64,
}

impl Limits {
    fn of(predictor: Predictor, blocks: &[Block], epochs_s: &[f64]) -> Self {
        let whitening = Whitening::new(blocks, predictor, None);
        let last_s = epochs_s.last().copied().unwrap_or(0.0);
        let distance_s = DISTANCE_M / SPEED_M_PER_S;
        let amplitude_nt = NT_M3_PER_AM2 / DISTANCE_M.powi(3);
        let energy = |of: &dyn Fn(f64) -> f64| {
            let whitened = whitening.apply(&epochs_s.iter().map(|&epoch_s| of(epoch_s)).collect::<Vec<f64>>());
            dot(&whitened, &whitened)
        };
        let (mut found, mut placed, mut count) = (0.0, 0.0, 0.0);
        for place in 0..PLACES {
            let middle_s = last_s * (place as f64 + 0.5) / PLACES as f64;
            for profile in 0..3 {
                let at = |epoch_s: f64| amplitude_nt * profiles((epoch_s - middle_s) / distance_s)[profile];
                found += energy(&at);
                placed += energy(&|epoch_s| (at(epoch_s + 0.05) - at(epoch_s - 0.05)) / (0.1 * SPEED_M_PER_S));
                count += 1.0;
            }
        }
        Self { smallest_am2: FOUND_SNR / (found / count).sqrt(), place_m_of_1_am2: 1.0 / (placed / count).sqrt() }
    }

    /// A gap helps nobody: what looks so is the scatter of two spectra.
    fn no_better_than(self, noise: Self) -> Self {
        Self {
            smallest_am2: self.smallest_am2.max(noise.smallest_am2),
            place_m_of_1_am2: self.place_m_of_1_am2.max(noise.place_m_of_1_am2),
        }
    }
}
