//! How far the gap shrinks: as the diagnosis predicts, and as it does on a second recording that it has not fitted.

use std::collections::BTreeMap;

use serde::Serialize;

use super::judged::{Judged, alone, median};
use super::rate::Rate;
use crate::said::GapClosed;

/// Of single effects named alone and rightly, where their parameters mean the same on another recording.
#[derive(Clone, Debug, Serialize)]
pub struct Shrink {
    /// Recordings.
    pub of: usize,
    /// Median of the predicted share over the realised one.
    pub median_ratio: Option<f64>,
    /// Realised shares within the interval of the predicted one, their own error allowed for.
    pub cover: Rate,
    /// The same by effect.
    pub cover_by_effect: BTreeMap<String, Rate>,
}

pub(super) fn of(singles: &[Judged<'_>]) -> Shrink {
    let both = |(answer, result): &Judged<'_>| {
        let effect = alone(result.diagnosis.said(), &answer.hidden[0])?;
        Some((effect.name.clone(), (effect.gap_closed, effect.confirmed?)))
    };
    let all: Vec<(String, (GapClosed, GapClosed))> = singles.iter().filter_map(both).collect();
    let ratios = all.iter().map(|(_, (predicted, realised))| predicted.fraction / realised.fraction.max(1e-3));
    let mut by_effect: BTreeMap<String, Vec<(GapClosed, GapClosed)>> = BTreeMap::new();
    all.iter().for_each(|(name, both)| by_effect.entry(name.clone()).or_default().push(*both));
    let cover_by_effect: BTreeMap<String, Rate> =
        by_effect.into_iter().map(|(name, own)| (name, Rate::count(&own, agree))).collect();
    Shrink {
        of: all.len(),
        median_ratio: median(ratios.collect()),
        cover: Rate::total(cover_by_effect.values()),
        cover_by_effect,
    }
}

fn agree((predicted, realised): &(GapClosed, GapClosed)) -> bool {
    let side = usize::from(realised.fraction > predicted.fraction);
    let far = (predicted.fraction - realised.fraction).abs();
    let own = (predicted.ci95[side] - predicted.fraction).abs();
    let other = (realised.ci95[1 - side] - realised.fraction).abs();
    far <= own.hypot(other)
}
