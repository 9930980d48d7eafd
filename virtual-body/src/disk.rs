//! The card.

use std::cell::{Cell, RefCell};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::rc::Rc;

use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use towmag::log::{BlockBytes, BlockSource, Card};

use super::rng::Rng;

/// What a power cut does to the block that is being written, and to those before it that were not synchronised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Each block is written whole or not at all.
    Whole,
    /// The block in flight gets a part of the new content; the rest keeps the old one.
    TornOld,
    /// The block in flight gets a part of the new content; the rest reads 0xFF.
    TornErased,
    /// The block in flight gets a part of the new content; the rest reads 0.
    TornZero,
    /// Any subset of the blocks since the last `sync` is written, some of them torn.
    Reordered,
    /// The same with the last four blocks, whatever `sync` has said.
    Lying,
    /// The whole erase block around the block in flight, with all that had been acknowledged in it, turns to garbage.
    Garbage,
}

pub const CUTS: [Cut; 7] =
    [Cut::Whole, Cut::TornOld, Cut::TornErased, Cut::TornZero, Cut::Reordered, Cut::Lying, Cut::Garbage];

/// Blocks of an erase block, 16 KiB, aligned to as much.
pub const ERASE_BLOCKS: u32 = 32;

/// Blocks that a lying card keeps in its cache.
pub const LYING_WINDOW: usize = 4;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiskError {
    /// There is no power.
    Off,
    /// The block does not work.
    Bad,
}

impl std::fmt::Display for DiskError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{self:?}")
    }
}

impl std::error::Error for DiskError {}

/// How a block fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Writing is refused and changes nothing.
    Refuses,
    /// Writing reports an error, but the block is written.
    WritesAndComplains,
    /// Writing reports success and changes nothing.
    Ignores,
    /// Writing reports success, and a bit is wrong.
    FlipsBit,
    /// It cannot be read.
    Unreadable,
}

/// Blocks that copies of a card share until one of them is written.
const CHUNK: usize = 64;
type Chunk = Rc<[[u8; 512]; CHUNK]>;

/// A card in memory, cheap to copy. Writes are numbered from 0 since it was created.
#[derive(Clone, Debug)]
pub struct Disk {
    chunks: RefCell<Vec<Chunk>>,
    /// What the chunks are that hold nothing.
    empty: Chunk,
    len: u32,
    /// Old content of the blocks that a cut may still undo, oldest first.
    undo: RefCell<Vec<(u32, [u8; 512])>>,
    writes: Cell<u64>,
    cut_at: Cell<Option<u64>>,
    on: Cell<bool>,
    mode: Cell<Cut>,
    rng: RefCell<Rng>,
    failures: RefCell<Vec<(u32, Failure)>>,
    syncs_fail: Cell<u32>,
    pub reads: Cell<u64>,
}

impl Disk {
    pub fn new(blocks: usize) -> Self {
        Self::from_blocks(vec![[0; 512]; blocks])
    }

    pub fn from_blocks(blocks: Vec<[u8; 512]>) -> Self {
        let empty: Chunk = Rc::new([[0; 512]; CHUNK]);
        let chunk = |blocks: &[[u8; 512]]| {
            if blocks.iter().all(|block| *block == [0; 512]) {
                return empty.clone();
            }
            let mut chunk = [[0; 512]; CHUNK];
            chunk[..blocks.len()].copy_from_slice(blocks);
            Rc::new(chunk)
        };
        Self {
            len: blocks.len() as u32,
            chunks: RefCell::new(blocks.chunks(CHUNK).map(chunk).collect()),
            empty: empty.clone(),
            undo: RefCell::default(),
            writes: Cell::new(0),
            cut_at: Cell::new(None),
            on: Cell::new(true),
            mode: Cell::new(Cut::Whole),
            rng: RefCell::new(Rng(0)),
            failures: RefCell::default(),
            syncs_fail: Cell::new(0),
            reads: Cell::new(0),
        }
    }

    /// Cut the power when `writes` more blocks have been written.
    pub fn cut_after(&self, writes: u64, mode: Cut, seed: u64) {
        self.mode.set(mode);
        self.rng.replace(Rng(seed));
        self.cut_at.set(Some(self.writes.get() + writes));
    }

    /// Power comes back; what is on the card now stays.
    pub fn power_on(&self) {
        self.undo.borrow_mut().clear();
        self.cut_at.set(None);
        self.on.set(true);
    }

    pub fn is_on(&self) -> bool {
        self.on.get()
    }

    pub fn writes(&self) -> u64 {
        self.writes.get()
    }

    pub fn fail(&self, block: u32, failure: Failure) {
        self.failures.borrow_mut().push((block, failure));
    }

    pub fn heal(&self) {
        self.failures.borrow_mut().clear();
    }

    pub fn fail_next_syncs(&self, count: u32) {
        self.syncs_fail.set(count);
    }

    pub fn block(&self, index: u32) -> [u8; 512] {
        self.chunks.borrow()[index as usize / CHUNK][index as usize % CHUNK]
    }

    pub fn set_block(&self, index: u32, block: [u8; 512]) {
        let mut chunks = self.chunks.borrow_mut();
        Rc::make_mut(&mut chunks[index as usize / CHUNK])[index as usize % CHUNK] = block;
    }

    /// The whole card, as a dump of it.
    pub fn image(&self) -> Vec<u8> {
        (0..self.block_count()).flat_map(|index| self.block(index)).collect()
    }

    pub fn block_count(&self) -> u32 {
        self.len
    }

    /// The blocks of all chunks that hold something, from first to last.
    pub fn blocks_in_use(&self) -> Vec<u32> {
        let chunks = self.chunks.borrow();
        let used = chunks.iter().enumerate().filter(|(_, chunk)| !Rc::ptr_eq(chunk, &self.empty));
        used.flat_map(|(i, _)| (i * CHUNK) as u32..((i + 1) * CHUNK) as u32).filter(|&index| index < self.len).collect()
    }

    /// Tells images apart.
    pub fn hash(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.blocks_in_use().into_iter().for_each(|index| self.block(index).hash(&mut hasher));
        hasher.finish()
    }

    /// The power goes now, while this is being written.
    pub fn cut_now(&self, index: u32, new: &[u8; 512]) {
        self.cut(index, new);
        self.power_on();
    }

    fn failure(&self, block: u32) -> Option<Failure> {
        self.failures.borrow().iter().find(|(bad, _)| *bad == block).map(|(_, failure)| *failure)
    }

    fn write_one(&self, index: u32, new: &[u8; 512]) -> Result<(), DiskError> {
        if !self.on.get() {
            return Err(DiskError::Off);
        }
        if self.cut_at.get() == Some(self.writes.get()) {
            self.cut(index, new);
            return Err(DiskError::Off);
        }
        self.writes.set(self.writes.get() + 1);
        let mut new = *new;
        match self.failure(index) {
            Some(Failure::Refuses) => return Err(DiskError::Bad),
            Some(Failure::Ignores) => return Ok(()),
            Some(Failure::FlipsBit) => new[200] ^= 4,
            Some(Failure::WritesAndComplains | Failure::Unreadable) | None => {}
        }
        self.put(index, new);
        if self.failure(index) == Some(Failure::WritesAndComplains) { Err(DiskError::Bad) } else { Ok(()) }
    }

    fn put(&self, index: u32, new: [u8; 512]) {
        let old = self.block(index);
        self.set_block(index, new);
        if !matches!(self.mode.get(), Cut::Reordered | Cut::Lying) {
            return;
        }
        let mut undo = self.undo.borrow_mut();
        undo.push((index, old));
        if self.mode.get() == Cut::Lying && undo.len() > LYING_WINDOW {
            undo.remove(0);
        }
    }

    /// The power goes while `new` is being written.
    fn cut(&self, index: u32, new: &[u8; 512]) {
        self.on.set(false);
        let old = self.block(index);
        let torn = |rest: [u8; 512], at: usize| {
            let mut torn = rest;
            torn[..at].copy_from_slice(&new[..at]);
            torn
        };
        let at = self.somewhere();
        match self.mode.get() {
            Cut::Whole => {}
            Cut::TornOld => self.set_block(index, torn(old, at)),
            Cut::TornErased => self.set_block(index, torn([0xFF; 512], at)),
            Cut::TornZero => self.set_block(index, torn([0; 512], at)),
            Cut::Reordered | Cut::Lying => {
                self.put(index, *new);
                self.lose_some();
            }
            Cut::Garbage => self.spoil(index),
        }
    }

    /// Garbage in the erase block around this block.
    fn spoil(&self, index: u32) {
        let first = index / ERASE_BLOCKS * ERASE_BLOCKS;
        for index in first..(first + ERASE_BLOCKS).min(self.block_count()) {
            let mut rng = self.rng.borrow_mut();
            let garbage = std::array::from_fn(|_| rng.draw() as u8);
            drop(rng);
            self.set_block(index, garbage);
        }
    }

    /// How it behaves when it loses its power from now on.
    pub fn set_mode(&self, mode: Cut, seed: u64) {
        self.mode.set(mode);
        self.rng.replace(Rng(seed));
    }

    /// Another course of chance.
    pub fn set_seed(&self, seed: u64) {
        self.rng.replace(Rng(seed));
    }

    /// The power goes for a moment while this block is being programmed, which has been sent in full.
    pub fn lose_power(&self, programming: Option<u32>) {
        match (programming, self.mode.get()) {
            (_, Cut::Reordered | Cut::Lying) => self.lose_some(),
            (_, Cut::Whole) | (None, _) => {}
            (Some(index), _) => {
                let new = self.block(index);
                self.cut(index, &new);
            }
        }
        self.power_on();
    }

    /// Where a block tears: in the middle, or anywhere.
    fn somewhere(&self) -> usize {
        let mut rng = self.rng.borrow_mut();
        if rng.coin() { 256 } else { rng.below(512) as usize }
    }

    /// Of the writes that are not safe, a random subset never happened, and some of the rest are torn.
    fn lose_some(&self) {
        let undo = std::mem::take(&mut *self.undo.borrow_mut());
        let mut rng = self.rng.borrow_mut();
        // From the last to the first, so that a block written twice ends as one of its three contents.
        for (index, old) in undo.into_iter().rev() {
            match rng.below(5) {
                0 | 1 => self.set_block(index, old),
                2 => {
                    let mut torn = self.block(index);
                    let at = rng.below(512) as usize;
                    torn[at..].copy_from_slice(&old[at..]);
                    self.set_block(index, torn);
                }
                _ => {}
            }
        }
    }
}

impl BlockDevice for Disk {
    type Error = DiskError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), DiskError> {
        if !self.on.get() {
            return Err(DiskError::Off);
        }
        for (block, index) in blocks.iter_mut().zip(start.0..) {
            self.reads.set(self.reads.get() + 1);
            if self.failure(index) == Some(Failure::Unreadable) || index >= self.block_count() {
                return Err(DiskError::Bad);
            }
            block.contents = self.block(index);
        }
        Ok(())
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), DiskError> {
        blocks.iter().zip(start.0..).try_for_each(|(block, index)| self.write_one(index, &block.contents))
    }

    fn num_blocks(&self) -> Result<BlockCount, DiskError> {
        Ok(BlockCount(self.block_count()))
    }
}

impl Card for Disk {
    fn sync(&self) -> Result<(), DiskError> {
        if !self.on.get() {
            return Err(DiskError::Off);
        }
        if self.syncs_fail.get() > 0 {
            self.syncs_fail.set(self.syncs_fail.get() - 1);
            return Err(DiskError::Bad);
        }
        if self.mode.get() != Cut::Lying {
            self.undo.borrow_mut().clear();
        }
        Ok(())
    }
}

/// A card that is still ours after the writer has gone, or has been switched off with it.
impl Card for Shared<'_> {
    fn sync(&self) -> Result<(), DiskError> {
        self.0.sync()
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Shared<'a>(pub &'a Disk);

impl BlockDevice for Shared<'_> {
    type Error = DiskError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), DiskError> {
        self.0.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), DiskError> {
        self.0.write(blocks, start)
    }

    fn num_blocks(&self) -> Result<BlockCount, DiskError> {
        self.0.num_blocks()
    }
}

/// The bare card, block by block.
impl BlockSource for Shared<'_> {
    type Error = DiskError;

    fn blocks(&self) -> u32 {
        self.0.block_count()
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), DiskError> {
        if self.0.failure(position) == Some(Failure::Unreadable) {
            return Err(DiskError::Bad);
        }
        *block = self.0.block(position);
        Ok(())
    }
}
