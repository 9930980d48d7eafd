//! The region inside a log file, as the writer sees it: each sector twice, in blocks that were marked before.

use core::ops::Range;

use embedded_sdmmc::{Block, BlockIdx};

use super::super::block::{BLOCK_LEN, BlockBytes, BlockSink, BlockSource, Region, blank_block, is_blank_at};
use super::super::sector::Sector;
use super::super::writer::{WINDOW, find_end, first_without};
use super::map::FileMap;
use super::{Card, read_block};

/// Blocks that are marked with one command: cards take several at once far faster than one by one.
const MARKED_AT_ONCE: usize = 8;

/// Of a file whose marking was interrupted, so many places are looked at again: a card may have lost its last writes.
const MARKED_AGAIN: u32 = 64;

/// Before the log goes on, so many of its last places are looked at whether both copies are there: a power cut may have
/// spoilt one of each within an erase block, of 4 MiB at most, and the next cut may spoil the others.
const LOOKED_AT: u32 = 8_192;

/// After so many in a row that are whole the damage is behind.
const WHOLE_IN_A_ROW: u32 = 64;

/// What can go wrong with a block of a [`LogFile`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFileError<E> {
    /// The position is beyond the end of the region.
    OutOfRegion,
    /// The card failed.
    Card(E),
}

impl<E: core::fmt::Display> core::fmt::Display for LogFileError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::OutOfRegion => write!(f, "beyond the end of the log file"),
            Self::Card(error) => write!(f, "card: {error}"),
        }
    }
}

impl<E: core::fmt::Debug + core::fmt::Display> core::error::Error for LogFileError<E> {}

/// The region inside a log file. It begins with the places that are marked already, and grows as [`mark`](Self::mark)
/// marks more.
#[derive(Debug)]
pub struct LogFile<D> {
    card: D,
    map: FileMap,
    /// Places with a marker in both of their blocks, or with a sector.
    marked: u32,
    /// Nothing that anybody knows of was ever written to the file: its blocks need not be looked at before.
    is_new: bool,
}

impl<D: Card> LogFile<D> {
    /// The file that `map` describes, on the card that it was opened on. Looks for how far it is marked.
    pub fn new(card: D, map: FileMap) -> Self {
        let mut file = Self { card, map, marked: 0, is_new: false };
        file.look_again();
        file
    }

    /// A file that was made just now, on this card: nothing is marked yet.
    pub fn of_new(card: D, map: FileMap) -> Self {
        Self { card, map, marked: 0, is_new: true }
    }

    /// The card was away: look again for how far the file is marked, and make two of each sector again of which one copy is
    /// left.
    pub fn look_again(&mut self) {
        self.is_new = false;
        let (places, end) = (self.map.places(), first_without(self.map.places(), |place| self.is_marked_from(place)));
        self.marked = end;
        let log_end = find_end(self);
        self.heal(log_end);
        self.marked = if end < places { end.saturating_sub(MARKED_AGAIN) } else { end };
    }

    /// Write the lost copies of the last sectors again, each over what is no sector. What fails stays as it is: the one copy
    /// is as safe as it was.
    fn heal(&self, log_end: u32) {
        let mut whole = 0;
        for place in (0..log_end).rev().take(LOOKED_AT as usize) {
            let (mut first, mut second) = ([0; BLOCK_LEN], [0; BLOCK_LEN]);
            let mirrored = place + self.map.places();
            let are_sectors = (self.holds_sector(place, &mut first), self.holds_sector(mirrored, &mut second));
            let healed = match are_sectors {
                (true, false) => Some(self.write_copy(mirrored, &first)),
                (false, true) => Some(self.write_copy(place, &second)),
                _ => None,
            };
            whole = if healed.is_some() { 0 } else { whole + u32::from(are_sectors.0) };
            if whole == WHOLE_IN_A_ROW {
                break;
            }
        }
        // A card that fails here fails at the next write, too.
        _ = self.sync_card();
    }

    /// Whether there is a sector of this file at a position, which is then in `block`.
    fn holds_sector(&self, position: u32, block: &mut BlockBytes) -> bool {
        self.read_copy(position, block).is_ok() && is_sector(&self.map, block)
    }

    /// Where it lies.
    pub fn map(&self) -> &FileMap {
        &self.map
    }

    /// The card itself.
    pub fn card(&self) -> &D {
        &self.card
    }

    /// The card, back from the file.
    pub fn into_card(self) -> D {
        self.card
    }

    /// Whether every place is marked.
    pub fn is_marked(&self) -> bool {
        self.marked >= self.map.places()
    }

    /// Mark the next places. Writes over no sector of this file.
    pub fn mark(&mut self) -> Result<(), D::Error> {
        let places = self.map.places();
        let end = (self.marked + MARKED_AT_ONCE as u32).min(places);
        self.mark_blocks(self.marked..end)?;
        self.mark_blocks(self.marked + places..end + places)?;
        self.card.sync()?;
        self.marked = end;
        Ok(())
    }

    fn mark_blocks(&self, positions: Range<u32>) -> Result<(), D::Error> {
        let Some(first) = self.map.locate(positions.start).map(BlockIdx) else { return Ok(()) };
        let mut blocks: [Block; MARKED_AT_ONCE] = core::array::from_fn(|_| Block::new());
        let Some(blocks) = blocks.get_mut(..positions.len()) else { return Ok(()) };
        let is_read = !self.is_new && self.card.read(blocks, first).is_ok();
        let mut is_changed = false;
        for (block, position) in blocks.iter_mut().zip(positions.clone()) {
            if !(is_read && is_own(&self.map, position, &block.contents)) {
                block.contents = blank_block(self.map.region(), position);
                is_changed = true;
            }
        }
        let is_safe = self.is_new || is_read;
        if is_safe && (!is_changed || self.card.write(blocks, first).is_ok()) {
            return Ok(());
        }
        self.mark_one_by_one(positions)
    }

    /// Around blocks that do not work: an error when none of them does.
    fn mark_one_by_one(&self, positions: Range<u32>) -> Result<(), D::Error> {
        let mut result = Ok(());
        let mut any = false;
        for position in positions {
            match self.mark_one(position) {
                Ok(()) => any = true,
                Err(error) => result = Err(error),
            }
        }
        if any { Ok(()) } else { result }
    }

    fn mark_one(&self, position: u32) -> Result<(), D::Error> {
        let Some(index) = self.map.locate(position).map(BlockIdx) else { return Ok(()) };
        let mut block = [0; BLOCK_LEN];
        read_block(&self.card, index, &mut block)?;
        if is_own(&self.map, position, &block) {
            return Ok(());
        }
        self.card.write(&[Block { contents: blank_block(self.map.region(), position) }], index)
    }

    /// Whether any of the places of the window is marked, or has been: damage, of an erase block even, must not mislead.
    fn is_marked_from(&self, place: u32) -> bool {
        let mut block = [0; BLOCK_LEN];
        (place..place.saturating_add(WINDOW).min(self.map.places())).any(|place| {
            [place, place + self.map.places()].into_iter().any(|position| {
                let index = self.map.locate(position).map(BlockIdx);
                let read = index.is_some_and(|index| read_block(&self.card, index, &mut block).is_ok());
                read && is_own(&self.map, position, &block)
            })
        })
    }

    fn locate(&self, position: u32) -> Result<BlockIdx, LogFileError<D::Error>> {
        self.map.locate(position).map(BlockIdx).ok_or(LogFileError::OutOfRegion)
    }

    fn read_copy(&self, position: u32, block: &mut BlockBytes) -> Result<(), LogFileError<D::Error>> {
        read_block(&self.card, self.locate(position)?, block).map_err(LogFileError::Card)
    }

    fn write_copy(&self, position: u32, block: &BlockBytes) -> Result<(), LogFileError<D::Error>> {
        let index = self.locate(position)?;
        self.card.write(&[Block { contents: *block }], index).map_err(LogFileError::Card)
    }

    fn sync_card(&self) -> Result<(), LogFileError<D::Error>> {
        self.card.sync().map_err(LogFileError::Card)
    }
}

/// Whether a block holds what only the log of this file puts there: the marker of this position, or a sector.
pub(super) fn is_own(map: &FileMap, position: u32, block: &BlockBytes) -> bool {
    is_blank_at(map.region(), position, block) || is_sector(map, block)
}

fn is_sector(map: &FileMap, block: &BlockBytes) -> bool {
    Sector::parse(block)
        .is_ok_and(|sector| sector.id().file_number == map.region().file_number && sector.tag() == map.region().tag())
}

impl<D: Card> BlockSource for LogFile<D> {
    type Error = LogFileError<D::Error>;

    fn blocks(&self) -> u32 {
        self.marked
    }

    /// What both blocks of the place hold; when they differ, the one that is not blank, or the second.
    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), Self::Error> {
        let mut first = [0; BLOCK_LEN];
        self.read_copy(position, &mut first)?;
        let mirrored = position + self.map.places();
        self.read_copy(mirrored, block)?;
        // A second copy has a marker of its own; so that a place is blank only when both of its blocks are.
        if is_blank_at(self.map.region(), mirrored, block) {
            *block = first;
        }
        Ok(())
    }
}

impl<D: Card> BlockSink for LogFile<D> {
    fn region(&self) -> Region {
        self.map.region()
    }

    /// One copy after the other, so that whatever a power cut does to the blocks around one of them, the other is safe.
    fn write(&mut self, position: u32, block: &BlockBytes) -> Result<(), Self::Error> {
        self.write_copy(position, block)?;
        self.sync_card()?;
        self.write_copy(position + self.map.places(), block)
    }

    fn sync(&mut self) -> Result<(), Self::Error> {
        self.sync_card()
    }

    /// Both copies.
    fn holds(&mut self, position: u32, block: &BlockBytes) -> Result<bool, Self::Error> {
        let mut found = [0; BLOCK_LEN];
        self.read_copy(position, &mut found)?;
        let first_holds = found == *block;
        self.read_copy(position + self.map.places(), &mut found)?;
        Ok(first_holds && found == *block)
    }
}
