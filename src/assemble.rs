//! Readings and conversions to epochs.

use crate::body::Conversion;
use crate::hardware::{Stamp, System};
use crate::health::{Count, Health, Task};
use crate::sensors::grid::{Grid, GridState, MarkedEpoch};
use crate::sensors::scalar::Reading;
use heapless::spsc::{Consumer, Producer, Queue};

/// Readings on their way to the grid.
pub type ReadingQueue = Queue<Reading, 8>;

/// Conversions on their way to the grid.
pub type ConversionQueue = Queue<Conversion, 64>;

/// Epochs on their way to the core.
pub type EpochQueue = Queue<MarkedEpoch, 32>;

/// The grid between its queues.
pub struct Assembler<'a, S> {
    grid: Grid,
    state: GridState,
    queues: AssemblerQueues<'a>,
    health: &'a Health,
    system: S,
}

/// The queues at either end of the grid.
pub struct AssemblerQueues<'a> {
    /// In.
    pub readings: Consumer<'a, Reading>,
    /// In.
    pub conversions: Consumer<'a, Conversion>,
    /// Out.
    pub epochs: Producer<'a, MarkedEpoch>,
}

impl<'a, S: System> Assembler<'a, S> {
    /// A grid that has seen nothing yet.
    pub fn new(grid: Grid, queues: AssemblerQueues<'a>, health: &'a Health, system: S) -> Self {
        Self { grid, state: GridState::new(), queues, health, system }
    }

    /// Take in what has come, and give on the epochs whose time is over. To be called 25 times a second.
    pub fn run(&mut self) {
        let now_us = self.system.stamp_us(Stamp::Poll);
        let Self { grid, state, queues, health, .. } = self;
        while let Some(reading) = queues.readings.dequeue() {
            grid.push_scalar(state, &reading);
        }
        while let Some(Conversion { counts, ready_us }) = queues.conversions.dequeue() {
            grid.push_flux(state, counts, ready_us);
        }
        while let Some(epoch) = grid.poll(state, now_us) {
            health.tasks.epoch_made();
            health.counts.add_if(queues.epochs.enqueue(epoch).is_err(), Count::EpochsLost);
            health.counts.set_grid(state.counters());
        }
        if health.tasks.converter_is_silent() {
            self.system.wake_fluxgate();
        }
        health.tasks.ran(Task::Assemble);
    }
}
