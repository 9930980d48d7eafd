//! Which targets were listed, and which were made up.

use serde::Serialize;

use super::judged::Judged;
use super::rate::Rate;
use crate::answer::Target;
use crate::reply::TrialResult;
use crate::said::SaidTarget;

/// From here on a target shall be listed, nT.
const LARGE_NT: f64 = 5.0;
/// How far a listed target may be from the true one, or the width of that if it is wider, s.
const NEAR_S: f64 = 1.0;
const MINUTES_PER_HOUR: f64 = 60.0;

/// Targets, whatever else a recording hides.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TargetScore {
    /// Those of 5 nT and more that are listed.
    pub large_listed: Rate,
    /// Smaller ones that are.
    pub small_listed: Rate,
    /// Listed ones that are near no target of any size.
    pub invented: usize,
    /// Of all recordings together, h.
    pub hours: f64,
}

impl TargetScore {
    /// Listed ones that are near none, an hour; none without recordings.
    pub fn invented_per_hour(&self) -> Option<f64> {
        (self.hours > 0.0).then(|| self.invented as f64 / self.hours)
    }
}

pub(super) fn of(all: &[Judged<'_>]) -> TargetScore {
    let is_listed = |(truth, listed): &(Target, &[SaidTarget])| listed.iter().any(|said| is_near(said, truth));
    let own = |(answer, result): &Judged<'_>| {
        let invented = |said: &&SaidTarget| !answer.targets.iter().any(|truth| is_near(said, truth));
        listed(result).iter().filter(invented).count()
    };
    let (large, small): (Vec<_>, Vec<_>) = all
        .iter()
        .flat_map(|(answer, result)| answer.targets.iter().map(|truth| (*truth, listed(result))))
        .partition(|(truth, _)| truth.peak_nt.abs() >= LARGE_NT);
    TargetScore {
        large_listed: Rate::count(&large, is_listed),
        small_listed: Rate::count(&small, is_listed),
        invented: all.iter().map(own).sum(),
        hours: all.iter().map(|(answer, _)| answer.minutes).sum::<f64>() / MINUTES_PER_HOUR,
    }
}

/// Whether a listed target is a true one.
pub(super) fn is_near(said: &SaidTarget, truth: &Target) -> bool {
    (said.time_s - truth.time_s).abs() <= truth.width_s.max(NEAR_S)
}

fn listed(result: &TrialResult) -> &[SaidTarget] {
    &result.diagnosis.said().targets
}
