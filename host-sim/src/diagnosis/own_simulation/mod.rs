//! A simulation of a user's own in the place of the base simulator: laid on the recording in time, and what it says beyond 18 terms and
//! a slow background taken off the readings, so that what is left is what the recording has and *it* has not.
//!
//! ```text
//! SimulatedTrack, recording -> Alignment (by the fluxgate) -> the simulation on the recording's rows
//!   -> its own findings, nothing named -> Beyond: what no 18 terms explain of it, if that is more than its noise
//! ```

mod align;
pub(crate) mod beyond;
mod track;

pub(super) use align::Alignment;
pub use track::SimulatedTrack;

use self::beyond::{Beyond, SimulationUsed};
use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::reconstruct::smooth::slow;
use crate::error::HostError;

/// Rows over which the field is averaged for its slow part, where it is told how large the rest is: 20 s.
const SLOW_ROWS: usize = 200;

/// A simulation that a recording is held against.
#[derive(Clone, Debug)]
pub struct OwnSimulation {
    /// What it says.
    pub track: SimulatedTrack,
    /// Whether its 18 terms are held; otherwise they are fitted to the recording as ever.
    pub holds_terms: bool,
}

impl OwnSimulation {
    /// How it lies on a recording; the recording without the rows of which it says nothing, and what it says of the others in the
    /// recording's place.
    pub(super) fn laid_on(&self, table: &Prepared) -> Result<(Alignment, Prepared, Prepared), HostError> {
        let alignment = align::align(table, &self.track)?;
        let step_s = self.track.step_s();
        let (mut recorded, mut simulated) = (table.clone(), table.clone());
        simulated.file.clone_from(&self.track.file);
        for (row, time_s) in table.time_s.iter().enumerate() {
            let Some(place) = self.track.place(time_s + alignment.offset_s, step_s) else {
                (recorded.usable[row], simulated.usable[row]) = (false, false);
                (recorded.scalar_nt[row], simulated.scalar_nt[row]) = (f64::NAN, f64::NAN);
                simulated.flux_nt[row] = [f64::NAN; 3];
                continue;
            };
            simulated.flux_nt[row] = place.of_vectors(&self.track.flux_nt);
            simulated.scalar_nt[row] = if table.usable[row] { place.of(&self.track.scalar_nt) } else { f64::NAN };
        }
        Ok((alignment, recorded, simulated))
    }

    /// What it adds to the base model, from the findings in it of which nothing was named, and what is told of that.
    pub(super) fn beyond(&self, alignment: Alignment, found: &Findings<'_>) -> (Beyond, SimulationUsed) {
        let selection = &found.scalar.selection;
        let is_more = found.channels().into_iter().any(|channel| channel.significant().next().is_some());
        let left = |channel: &ChannelFindings<'_>| {
            let left_nt = channel.selection.problem.residual_nt(&channel.selection.fit);
            without_mean(&left_nt)
        };
        let (mut scalar_nt, magnitude_nt) =
            if is_more { (left(&found.scalar), left(&found.fluxgate)) } else { (Vec::new(), Vec::new()) };
        let beyond_nt = is_more.then(|| rms_beside_slow(&scalar_nt));
        let held = self.holds_terms.then(|| selection.problem.eq4(&selection.fit.coefficients));
        if self.holds_terms {
            scalar_nt.resize(found.table.len(), 0.0);
            let interference_nt = selection.problem.interference_nt(&selection.fit);
            scalar_nt.iter_mut().zip(interference_nt).for_each(|(sum, nt)| *sum += nt);
        }
        let used = SimulationUsed {
            file: self.track.file.clone(),
            offset_s: alignment.offset_s,
            track_explained: alignment.explained,
            rate_hz: 1.0 / self.track.step_s(),
            holds_terms: self.holds_terms,
            beyond_nt,
        };
        (Beyond { scalar_nt, magnitude_nt, held }, used)
    }
}

/// A column less its mean; 0 where nothing was. Its slow part is the background's, in the simulation as in the recording.
fn without_mean(column_nt: &[f64]) -> Vec<f64> {
    let there = || column_nt.iter().filter(|nt| nt.is_finite());
    let mean_nt = there().sum::<f64>() / there().count().max(1) as f64;
    column_nt.iter().map(|nt| if nt.is_finite() { nt - mean_nt } else { 0.0 }).collect()
}

/// Rms of what is faster than the background.
fn rms_beside_slow(column_nt: &[f64]) -> f64 {
    let square = |(nt, slow): (&f64, f64)| (nt - slow).powi(2);
    let squares: f64 = column_nt.iter().zip(slow(column_nt, SLOW_ROWS)).map(square).sum();
    (squares / column_nt.len().max(1) as f64).sqrt()
}
