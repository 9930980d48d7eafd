//! How far the gap shrinks: as the diagnosis predicts, and as it does on a second recording that it has not fitted.

use serde::Serialize;

use super::judged::{Judged, alone, median};
use super::rate::Rate;
use crate::said::GapClosed;

/// Of single effects named alone and rightly, where their parameters mean the same on another recording.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Shrink {
    /// Recordings.
    pub of: usize,
    /// Median of the predicted share over the realised one.
    pub median_ratio: Option<f64>,
    /// Realised shares within the interval of the predicted one, their own error allowed for.
    pub cover: Rate,
}

pub(super) fn of(singles: &[Judged<'_>]) -> Shrink {
    let both = |(answer, result): &Judged<'_>| {
        let effect = alone(result.diagnosis.said(), &answer.hidden[0].name)?;
        Some((effect.gap_closed, effect.confirmed?))
    };
    let all: Vec<(GapClosed, GapClosed)> = singles.iter().filter_map(both).collect();
    let ratios = all.iter().map(|(predicted, realised)| predicted.fraction / realised.fraction.max(1e-3));
    Shrink { of: all.len(), median_ratio: median(ratios.collect()), cover: Rate::count(&all, agree) }
}

fn agree((predicted, realised): &(GapClosed, GapClosed)) -> bool {
    let side = usize::from(realised.fraction > predicted.fraction);
    let far = (predicted.fraction - realised.fraction).abs();
    let own = (predicted.ci95[side] - predicted.fraction).abs();
    let other = (realised.ci95[1 - side] - realised.fraction).abs();
    far <= own.hypot(other)
}
