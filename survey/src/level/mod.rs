//! The field at its level: all 18 terms, coefficients that move, and the background as a slow random process.
//!
//! A fixed-interval smoother (f64) over all rows of all recordings of one body: the reading is the background (a random walk
//! whose slope walks too), plus the interference of coefficients that walk, plus noise. No penalty: what a recording tells
//! of the terms through turns and headings fixes the level, and what it does not tell is in the standard deviation. The terms
//! are those of one field, and what they grow by with the field is taken off first. In the band of targets a change of the
//! coefficients is fitted beside, as far as the recording asks for one.

mod background;
mod band;
mod circle;
mod eaten;
mod growth;
mod kalman;
mod model_search;
mod moves;
mod outliers;
mod prior;
mod read_off;
mod series;
mod smoother;
mod terms;
mod uncertainty;

use crate::Tow;
pub(crate) use background::slow_part_by;
use growth::take_off_growth;
use kalman::Start;
use model_search::Search;
use moves::mark_moves;
pub(crate) use outliers::MODEL_ERROR;
use outliers::{add_doubts, doubts_nt2, raise_variances};
pub use prior::Calibration;
pub use read_off::Level;
use read_off::read_off;
use series::{Sample, Series};
use smoother::smooth;
pub(crate) use terms::{TOLD, combine, direction};
use uncertainty::knots;

/// Rounds of raising variances and fitting the model again.
const ROUNDS: usize = 3;
/// The largest power of the coefficients' random steps, nT^2/s: 2 nT in an hour. A body that warms moves so; what is quicker is
/// a move, or in the band alone, and would be taken from the background.
const MOST_MOVING_NT2_PER_S: f64 = 1e-3;

/// What coefficients do between two moves of the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficients {
    /// They stay as they are, and are the same in the band of targets: so they take least of a target that nobody has found.
    Still,
    /// They move, and differ in the band, as far as the recording says so.
    Moving,
}

/// Level all recordings of one body. `targets_nt` are the fitted anomalies of targets, a row each: they are left in the
/// field, and learnt from nothing; `None` as long as none are known.
/// `calibration` is what is known of the body, used as far as it holds.
#[must_use]
pub fn level(
    tows: &[Tow],
    targets_nt: Option<&[f64]>,
    calibration: Option<&Calibration>,
    coefficients: Coefficients,
) -> Level {
    let none = vec![0.0; tows.iter().map(Tow::len).sum()];
    let known_nt = targets_nt.unwrap_or(&none);
    let mut series = Series::of(tows, known_nt);
    mark_moves(&mut series);
    // Below the band the fluxgate's magnitude holds the field itself.
    let unknown = Start::unknown().without_fluxgate();
    let mut model = search(&series.samples, &unknown, coefficients).likeliest(None);
    let start =
        calibration.map_or_else(|| unknown.clone(), |calibration| calibration.start(&series.samples, &unknown, &model));
    // Coefficients that stay are fitted anew in the search for contacts, beside these.
    let targets_doubted_nt = if coefficients == Coefficients::Still { &none } else { known_nt };
    let doubts_nt2 = doubts_nt2(&series, targets_doubted_nt, tows);
    let mut smoothed = smooth(&series.samples, &start, &model, None);
    let mut change_nt = take_off_growth(&mut series, tows, &smoothed);
    smoothed = smooth(&series.samples, &start, &model, None);
    for _round in 0..ROUNDS {
        let doubted = add_doubts(&mut series.samples, &doubts_nt2, &model);
        if raise_variances(&mut series.samples, &smoothed) + doubted == 0 {
            break;
        }
        model = search(&series.samples, &start, coefficients).likeliest(Some(model));
        smoothed = smooth(&series.samples, &start, &model, None);
    }
    let covariances = knots(&series.samples, &start, &model);
    if coefficients == Coefficients::Moving {
        let in_band_nt = band::correction(&series, &smoothed, targets_nt);
        change_nt.iter_mut().zip(in_band_nt).for_each(|(change_nt, in_band_nt)| *change_nt += in_band_nt);
    }
    read_off(tows, known_nt, &series, &smoothed, &covariances, &change_nt)
}

fn search<'a>(samples: &'a [Sample], start: &'a Start, coefficients: Coefficients) -> Search<'a> {
    let moves = [true, true, coefficients == Coefficients::Moving];
    Search { samples, start, moves, most_eaten: None, most_moving_nt2_per_s: MOST_MOVING_NT2_PER_S }
}
