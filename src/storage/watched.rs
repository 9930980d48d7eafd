//! The card under the eyes of the watchdog.

use crate::hardware::{CardSlot, System};
use crate::health::{Health, Task};
use crate::log::Card;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};

/// A card whose every call tells the watchdog that storage is at work, before and after: none takes longer than two
/// seconds, but an attempt to open a log is many of them. Tells the self-test how long its writes take.
pub(super) struct WatchedCard<'a, D, S> {
    pub(super) card: D,
    pub(super) health: &'a Health,
    pub(super) system: S,
}

impl<D, S> WatchedCard<'_, D, S> {
    fn watch<T>(&self, work: impl FnOnce(&D) -> T) -> T {
        self.health.tasks.ran(Task::Storage);
        let done = work(&self.card);
        self.health.tasks.ran(Task::Storage);
        done
    }
}

impl<D: BlockDevice, S: System> BlockDevice for WatchedCard<'_, D, S> {
    type Error = D::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.watch(|card| card.read(blocks, start))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Self::Error> {
        let begin_us = self.system.now_us();
        self.watch(|card| card.write(blocks, start))?;
        self.health.checks.card_took(self.system.now_us().wrapping_sub(begin_us));
        Ok(())
    }

    fn num_blocks(&self) -> Result<BlockCount, Self::Error> {
        self.watch(BlockDevice::num_blocks)
    }
}

impl<D: CardSlot, S: System> CardSlot for WatchedCard<'_, D, S> {
    fn look_again(&self) {
        self.card.look_again();
    }
}

impl<D: BlockDevice, S: System> Card for WatchedCard<'_, D, S> {
    /// The card's driver returns from a write only when the card is no longer busy: all that SPI mode tells.
    fn sync(&self) -> Result<(), Self::Error> {
        Ok(())
    }
}
