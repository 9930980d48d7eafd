//! What was in the free space before: put back when the trial is over.

use super::plan::{Extent, Plan};
use crate::{CardError, Store};

/// The old content of what will be written.
pub(super) struct Kept<'a, S> {
    store: &'a S,
    contents: Vec<(Extent, Vec<u8>)>,
}

impl<'a, S: Store> Kept<'a, S> {
    pub(super) fn of(store: &'a S, plan: &Plan) -> Result<Self, CardError> {
        let read = |extent: Extent| -> Result<_, CardError> {
            let mut bytes = vec![0; extent.len];
            store.read(extent.at, &mut bytes)?;
            Ok((extent, bytes))
        };
        Ok(Self { store, contents: plan.extents().map(read).collect::<Result<_, _>>()? })
    }

    /// On a card that lies about its size two addresses may be one block: both were read before either was written, so
    /// both have what the block held, also when it belongs to a file.
    pub(super) fn put_back(self) -> Result<(), CardError> {
        // All that can be: one piece that fails keeps no other from its place.
        let written: Vec<_> = self.contents.iter().map(|(extent, bytes)| self.store.write(extent.at, bytes)).collect();
        self.store.sync()?;
        Ok(written.into_iter().collect::<Result<(), _>>()?)
    }
}
