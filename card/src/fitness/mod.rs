//! Whether a card is fit for the body: whether it has the room that it says, how long it makes a write wait, how fast it is.
//!
//! Of an image or a device free space is written to, and put back as it was; of a folder, files that have no name
//! are filled.

mod area;
mod capacity;
mod clock;
mod folder;
mod plan;
mod report;
mod stamp;
mod waits;

pub use clock::{Clock, RealClock};
pub use folder::FolderStore;
pub use report::Report;
pub use waits::Waits;

use crate::{CardError, Listing, Progress, Store};
use area::Kept;
use plan::Plan;

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Bytes in one piece that are filled, and written again for pauses and speed.
    dense_bytes: u64,
    /// Of the rest of a card, a block is tried in each piece of this size.
    stride_bytes: u64,
    /// Of a folder at most so much is filled.
    most_bytes: u64,
    /// Sectors that are written one a second.
    slow_writes: usize,
    /// Sectors that are written one after the other.
    burst_writes: usize,
}

impl Effort {
    /// A minute.
    pub const QUICK: Self = Self {
        dense_bytes: 16 << 20,
        stride_bytes: 16 << 20,
        most_bytes: 256 << 20,
        slow_writes: 20,
        burst_writes: 200,
    };

    /// What a card should be put through before it goes to sea.
    pub const THOROUGH: Self = Self {
        dense_bytes: 64 << 20,
        stride_bytes: 4 << 20,
        most_bytes: u64::MAX,
        slow_writes: 120,
        burst_writes: 2_000,
    };
}

/// Who does the work, and is told how far it is.
pub struct Trial<'a> {
    /// How much is tried.
    pub effort: Effort,
    /// Tells what was written in this trial from what was written before.
    pub seed: u64,
    /// Times the writes.
    pub clock: &'a dyn Clock,
    /// Is told.
    pub progress: &'a dyn Progress,
}

impl Trial<'_> {
    /// Try the free space of an image or device. Everything on it is afterwards as it was.
    pub fn of_card<S: Store>(&self, store: &S) -> Result<Report, CardError> {
        let listing = Listing::of(store)?;
        let plan = Plan::spread(&listing.free, &self.effort)
            .ok_or_else(|| CardError::Full("there is no free space to try: empty the card".into()))?;
        let kept = Kept::of(store, &plan)?;
        let report = self.report(store, plan, listing.free_bytes());
        // Also after an error, which is what the user is then told.
        let put_back = kept.put_back();
        let report = report?;
        put_back?;
        Ok(report)
    }

    /// Fill files of the folder, which are gone afterwards.
    pub fn of_folder(&self, folder: &FolderStore) -> Result<Report, CardError> {
        let free = folder.free_bytes();
        let plan = Plan::filling(free, self.effort.most_bytes)
            .ok_or_else(|| CardError::Full("there is no free space to try: empty the card".into()))?;
        self.report(folder, plan, free.unwrap_or(0))
    }

    fn report<S: Store>(&self, store: &S, mut plan: Plan, free_bytes: u64) -> Result<Report, CardError> {
        let capacity = capacity::try_capacity(self, store, &mut plan)?;
        let slow = waits::one_a_second(self, store, &plan)?;
        let burst = waits::burst(self, store, &plan)?;
        Ok(Report { capacity, slow, burst, free_bytes, is_whole: plan.is_whole })
    }
}
