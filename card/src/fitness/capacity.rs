//! Whether what is written all over the card can be read back, and how fast both go.

use std::io;
use std::time::Duration;

use super::plan::{Extent, Plan};
use super::stamp::{stamp, written_at};
use super::trial::Trial;
use crate::{BLOCK_BYTES, CardError, Store};

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Capacity {
    /// Bytes that were written and read back.
    pub(super) tried_bytes: u64,
    /// Blocks that were not what they should be.
    pub(super) bad_blocks: u64,
    /// The size after which the card starts again from its beginning.
    pub(super) wraps_after_bytes: Option<u64>,
    pub(super) write_bytes_per_s: f64,
    pub(super) read_bytes_per_s: f64,
    /// Whether what was read is known to have come from the card, not from the computer's memory.
    pub(super) is_from_card: bool,
}

/// Write all of the plan, and read it back. A folder that is full ends the plan there.
pub(super) fn try_capacity<S: Store>(trial: &Trial<'_>, store: &S, plan: &mut Plan) -> Result<Capacity, CardError> {
    trial.progress.begin("writing", plan.bytes());
    let wrote_s = timed(trial, || write_dense(trial, store, plan))?;
    plan.samples.iter().try_for_each(|&extent| write(trial, store, extent))?;
    store.sync()?;
    let is_from_card = store.forget_cache();
    let mut capacity = Capacity { tried_bytes: plan.bytes(), is_from_card, ..Capacity::default() };
    trial.progress.begin("reading back", plan.bytes());
    let read_s = timed(trial, || plan.dense.iter().try_for_each(|&extent| check(trial, store, extent, &mut capacity)))?;
    plan.samples.iter().try_for_each(|&extent| check(trial, store, extent, &mut capacity))?;
    let dense_bytes = plan.dense.iter().map(|extent| extent.len as f64).sum::<f64>();
    capacity.write_bytes_per_s = dense_bytes / wrote_s.as_secs_f64().max(1e-6);
    capacity.read_bytes_per_s = dense_bytes / read_s.as_secs_f64().max(1e-6);
    Ok(capacity)
}

fn timed(trial: &Trial<'_>, work: impl FnOnce() -> Result<(), CardError>) -> Result<Duration, CardError> {
    let begin = trial.clock.now();
    work()?;
    Ok(trial.clock.now().saturating_sub(begin))
}

fn write_dense<S: Store>(trial: &Trial<'_>, store: &S, plan: &mut Plan) -> Result<(), CardError> {
    for (written, &extent) in plan.dense.iter().enumerate() {
        match write(trial, store, extent) {
            Err(CardError::Failed(error)) if error.kind() == io::ErrorKind::StorageFull && written > 0 => {
                plan.dense.truncate(written);
                break;
            }
            done => done?,
        }
    }
    Ok(store.sync()?)
}

fn write<S: Store>(trial: &Trial<'_>, store: &S, extent: Extent) -> Result<(), CardError> {
    let mut bytes = vec![0; extent.len];
    stamp(trial.seed, extent.at, &mut bytes);
    store.write(extent.at, &bytes)?;
    trial.progress.add(extent.len as u64);
    Ok(())
}

fn check<S: Store>(trial: &Trial<'_>, store: &S, extent: Extent, found: &mut Capacity) -> Result<(), CardError> {
    let (mut read, mut wanted) = (vec![0; extent.len], vec![0; extent.len]);
    store.read(extent.at, &mut read)?;
    stamp(trial.seed, extent.at, &mut wanted);
    trial.progress.add(extent.len as u64);
    let blocks = read.as_chunks::<512>().0.iter().zip(wanted.as_chunks::<512>().0);
    for ((read, _), index) in blocks.zip(extent.at / BLOCK_BYTES..).filter(|((read, wanted), _)| read != wanted) {
        found.bad_blocks += 1;
        let apart = written_at(trial.seed, read).map(|at| at.abs_diff(index) * BLOCK_BYTES);
        found.wraps_after_bytes = [found.wraps_after_bytes, apart].into_iter().flatten().min();
    }
    Ok(())
}
