//! The spectrum of the noise of the direction, where it is as loud as the scalar's own.
//!
//! White noise of the fluxgate passes the smoothing of the direction up to some 2 Hz, rises there where eddy currents answer to the rate, and
//! ends within a tenth of that: no sensor's noise has such a shape, and with a sensor's it would stand out as a tone.

use std::sync::Arc;

use super::blocks::Block;
use super::levels::Levels;
use super::periodogram::{Periodogram, periodograms, welch_of};
use crate::diagnosis::numerics::median;
use crate::diagnosis::policy::{SPECTRUM_DIRECTION_LEAST, SPECTRUM_DIRECTION_PRESENT};

/// What the noise of the direction makes of the interference, by draws of it: it has the shape that the smoothing of the direction lets
/// through, with edges, and no sensor's.
#[derive(Clone, Debug)]
pub(crate) struct DirectionSpectrum {
    /// As smooth as that of the residual.
    bands: Levels,
    /// At the frequencies of a periodogram, Hz and nT^2/Hz, as trusted as `bands`.
    fine: Arc<[[f64; 2]]>,
    /// What of it a residual has.
    share: f64,
}

impl DirectionSpectrum {
    /// Of draws of the noise, nT, one value a row each. `None` where it does not enter.
    pub(super) fn of_draws(draws_nt: &[Vec<f64>], blocks: &[Block]) -> Option<Self> {
        let periodograms: Vec<Periodogram> =
            draws_nt.iter().flat_map(|draw_nt| periodograms(draw_nt, blocks)).collect();
        let bands = Levels::of(&periodograms)?;
        let fine = welch_of(&periodograms);
        let sum = |of: &dyn Fn(&[f64; 2]) -> f64| fine.iter().map(of).sum::<f64>();
        let trusted = sum(&|[hz, _]| bands.at(*hz)) / sum(&|[_, power]| *power).max(f64::MIN_POSITIVE);
        let fine = fine.iter().map(|[hz, power]| [*hz, trusted * power]).collect();
        Some(Self { bands, fine, share: 1.0 })
    }

    /// As far as a residual of such levels has it; `None` where it does not matter beside the rest, or the residual has so little of what
    /// the draws have that it is none of theirs.
    pub(super) fn in_residual(&self, levels: &Levels) -> Option<Self> {
        let ratios = levels.densities().map(|(hz, density)| density / self.bands.at(hz));
        let ratios: Vec<f64> = ratios.filter(|ratio| *ratio < 1.0 / SPECTRUM_DIRECTION_LEAST).collect();
        let share = (!ratios.is_empty()).then(|| median(ratios))?;
        (share > SPECTRUM_DIRECTION_PRESENT).then(|| Self { share: share.min(1.0), ..self.clone() })
    }

    /// Its level in a band, as that of the residual is taken, nT^2/Hz.
    pub(super) fn in_band(&self, hz: f64) -> f64 {
        self.share * self.bands.at(hz)
    }

    /// Power at a frequency, nT^2/Hz.
    pub(super) fn at(&self, hz: f64) -> f64 {
        let step_hz = self.fine[0][0];
        let place = (hz / step_hz - 1.0).clamp(0.0, (self.fine.len() - 1) as f64);
        let (below, above) = (place as usize, (place as usize + 1).min(self.fine.len() - 1));
        let part = place - below as f64;
        self.share * ((1.0 - part) * self.fine[below][1] + part * self.fine[above][1])
    }
}
