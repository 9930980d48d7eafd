//! A card whose writes stay in memory until all of them are known to succeed.
//!
//! So a card that has no room for the last of several files is not touched at all, and the many small writes of a table
//! become few large ones.

use std::cell::RefCell;
use std::collections::HashMap;
use std::io;

use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use towmag::log::{BLOCK_LEN, BlockBytes, Card};

use crate::blocks::OnStore;
use crate::{BLOCK_BYTES, Store};

/// What was written so far: the newest content of each block, and in which order they came first.
#[derive(Debug, Default)]
struct Written {
    contents: HashMap<u32, BlockBytes>,
    order: Vec<u32>,
}

/// A card whose writes stay in memory.
#[derive(Debug)]
pub(crate) struct Rehearsal<'a, S> {
    store: &'a S,
    written: RefCell<Written>,
}

impl<'a, S: Store> Rehearsal<'a, S> {
    pub(crate) fn new(store: &'a S) -> Self {
        Self { store, written: RefCell::default() }
    }

    /// Write the blocks, the last first: a chain without an entry in the directory harms nothing, should the card be torn
    /// out in between, and the other way about there would be an entry without a file.
    pub(crate) fn perform(self) -> io::Result<()> {
        let Written { contents, order } = self.written.into_inner();
        let mut run: Vec<u32> = Vec::new();
        for index in order.into_iter().rev() {
            if run.last().is_some_and(|&last| index.checked_add(1) != Some(last)) {
                write_run(self.store, &contents, &run)?;
                run.clear();
            }
            run.push(index);
        }
        write_run(self.store, &contents, &run)
    }
}

/// Adjacent blocks, the last first.
fn write_run<S: Store>(store: &S, contents: &HashMap<u32, BlockBytes>, run: &[u32]) -> io::Result<()> {
    let Some(&first) = run.last() else { return Ok(()) };
    let bytes: Vec<u8> = run.iter().rev().filter_map(|index| contents.get(index)).flatten().copied().collect();
    store.write(u64::from(first) * BLOCK_BYTES, &bytes)?;
    store.sync()
}

impl<S: Store> BlockDevice for Rehearsal<'_, S> {
    type Error = io::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> io::Result<()> {
        OnStore(self.store).read(blocks, start)?;
        let written = self.written.borrow();
        for (block, index) in blocks.iter_mut().zip(start.0..) {
            written.contents.get(&index).into_iter().for_each(|contents| block.contents = *contents);
        }
        Ok(())
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> io::Result<()> {
        let mut written = self.written.borrow_mut();
        for (block, index) in blocks.iter().zip(start.0..) {
            if u64::from(index) >= self.store.blocks() {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            let contents: [u8; BLOCK_LEN] = block.contents;
            if written.contents.insert(index, contents).is_none() {
                written.order.push(index);
            }
        }
        Ok(())
    }

    fn num_blocks(&self) -> io::Result<BlockCount> {
        OnStore(self.store).num_blocks()
    }
}

impl<S: Store> Card for Rehearsal<'_, S> {
    fn sync(&self) -> io::Result<()> {
        Ok(())
    }
}
