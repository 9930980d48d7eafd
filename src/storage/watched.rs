//! The card under the eyes of the watchdog.

use crate::hardware::CardSlot;
use crate::health::{Health, Task};
use crate::log::Card;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};

/// A card whose every call tells the watchdog that storage is at work, before and after: none takes longer than two
/// seconds, but an attempt to open a log is many of them.
pub(super) struct WatchedCard<'a, D> {
    pub(super) card: D,
    pub(super) health: &'a Health,
}

impl<D> WatchedCard<'_, D> {
    fn watch<T>(&self, work: impl FnOnce(&D) -> T) -> T {
        self.health.tasks.ran(Task::Storage);
        let done = work(&self.card);
        self.health.tasks.ran(Task::Storage);
        done
    }
}

impl<D: BlockDevice> BlockDevice for WatchedCard<'_, D> {
    type Error = D::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.watch(|card| card.read(blocks, start))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.watch(|card| card.write(blocks, start))
    }

    fn num_blocks(&self) -> Result<BlockCount, Self::Error> {
        self.watch(BlockDevice::num_blocks)
    }
}

impl<D: CardSlot> CardSlot for WatchedCard<'_, D> {
    fn look_again(&self) {
        self.card.look_again();
    }
}

impl<D: BlockDevice> Card for WatchedCard<'_, D> {
    /// The card's driver returns from a write only when the card is no longer busy: all that SPI mode tells.
    fn sync(&self) -> Result<(), Self::Error> {
        Ok(())
    }
}
