//! Whether a card is fit for the body: whether it has the room that it says, how long it makes a write wait, how fast it is.
//!
//! Of an image or a device free space is written to, and put back as it was; of a folder, files that have no name
//! are filled.

mod area;
mod capacity;
mod clock;
mod effort;
mod folder;
mod plan;
mod report;
mod stamp;
mod trial;
mod waits;

pub use clock::{Clock, RealClock};
pub use effort::Effort;
pub use folder::FolderStore;
pub use report::Report;
pub use trial::Trial;
pub use waits::Waits;

use crate::{CardError, Listing, Store};
use area::Kept;
use plan::Plan;

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
