//! How long the card makes a write wait, as the body writes: a block, and when that is safe, its copy.

use std::time::Duration;

use super::plan::Plan;
use super::stamp::stamp;
use super::trial::Trial;
use crate::{BLOCK_BYTES, CardError, Store};

/// The body writes a sector about once a second.
const PERIOD: Duration = Duration::from_secs(1);

/// How long writes of a block took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Waits {
    /// How many.
    pub count: usize,
    /// The middle one.
    pub p50: Duration,
    /// The longest but for one in a hundred.
    pub p99: Duration,
    /// The longest.
    pub worst: Duration,
}

impl Waits {
    fn of(mut waits: Vec<Duration>) -> Self {
        waits.sort_unstable();
        let at = |percent: usize| waits.get((waits.len() * percent / 100).min(waits.len().saturating_sub(1)));
        let [p50, p99, worst] = [50, 99, 100].map(|percent| at(percent).copied().unwrap_or_default());
        Self { count: waits.len(), p50, p99, worst }
    }
}

/// With a pause after each sector, in which a card tidies up or does not.
pub(super) fn one_a_second<S: Store>(trial: &Trial<'_>, store: &S, plan: &Plan) -> Result<Waits, CardError> {
    trial.progress.begin("a sector a second", trial.effort.slow_writes as u64);
    sectors(trial, store, plan, trial.effort.slow_writes, PERIOD)
}

/// One sector after the other, as after a pause of the body.
pub(super) fn burst<S: Store>(trial: &Trial<'_>, store: &S, plan: &Plan) -> Result<Waits, CardError> {
    trial.progress.begin("sectors in a row", trial.effort.burst_writes as u64);
    sectors(trial, store, plan, trial.effort.burst_writes, Duration::ZERO)
}

fn sectors<S: Store>(
    trial: &Trial<'_>,
    store: &S,
    plan: &Plan,
    count: usize,
    period: Duration,
) -> Result<Waits, CardError> {
    let mut waits = Vec::with_capacity(2 * count);
    let mut block = [0; BLOCK_BYTES as usize];
    for number in 0..count {
        for at in plan.small_write(number) {
            stamp(trial.seed, at, &mut block);
            let begin = trial.clock.now();
            store.write(at, &block)?;
            store.sync()?;
            waits.push(trial.clock.now().saturating_sub(begin));
        }
        trial.progress.add(1);
        trial.clock.sleep(period);
    }
    Ok(Waits::of(waits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_the_last_hundredth_and_the_longest() {
        let waits = Waits::of((1..=200).rev().map(Duration::from_millis).collect());
        let ms = [waits.p50, waits.p99, waits.worst].map(|wait| wait.as_millis());
        assert_eq!((waits.count, ms), (200, [101, 199, 200]));
        assert_eq!(Waits::of(Vec::new()), Waits::default());
    }
}
