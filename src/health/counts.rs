//! What went wrong, counted.

use crate::link::{FaultCounters, ProgramFaults, converter_counts, grid_counts, nmea_counts, scalar_counts};
use crate::sensors::ads131m04::AdcFaults;
use crate::sensors::grid::GridCounters;
use crate::sensors::nmea::NmeaFaults;
use crate::sensors::scalar::ScalarFaults;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// What the program counts. What a driver counts itself, it hands over as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// Readings of the scalar sensor, and sentences of the third UART, that found no room in their queue.
    ReadingsLost,
    /// Conversions that found no room in their queue.
    ConversionsLost,
    /// Epochs that found no room in their queue.
    EpochsLost,
    /// Log records that found no room in their queue.
    RecordsLost,
    /// Telemetry frames that found no room in the transmitter's queue.
    FramesDropped,
    /// Bytes of the console that found no room in their queue, and errors of its receiver.
    CableOverruns,
    /// Attempts to write the log, or to find a card, that failed.
    LogErrors,
    /// Log records that would survive a power cut.
    LogRecordsSafe,
    /// Console lines dropped because they were overlong or damaged.
    ConsoleLinesDropped,
    /// Panics, hard faults and resets by the watchdog since power came.
    RestartsByFault,
    /// 1 while the body runs on its internal oscillator.
    CrystalFailed,
}

const COUNTS: usize = 11;

/// Counters of one kind, each of which is written by one task alone.
#[derive(Debug)]
struct Counters<const N: usize>([AtomicU32; N]);

impl<const N: usize> Counters<N> {
    const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; N])
    }

    fn set(&self, values: [u32; N]) {
        self.0.iter().zip(values).for_each(|(counter, value)| counter.store(value, Relaxed));
    }

    fn get(&self) -> [u32; N] {
        self.0.each_ref().map(|counter| counter.load(Relaxed))
    }
}

/// All counters of the body.
#[derive(Debug)]
pub struct Counts {
    own: Counters<COUNTS>,
    scalar: Counters<11>,
    converter: Counters<8>,
    grid: Counters<9>,
    nmea: Counters<4>,
}

impl Counts {
    pub(super) const fn new() -> Self {
        Self {
            own: Counters::new(),
            scalar: Counters::new(),
            converter: Counters::new(),
            grid: Counters::new(),
            nmea: Counters::new(),
        }
    }

    /// Count some more.
    pub fn add(&self, count: Count, more: u32) {
        self.counter(count).fetch_add(more, Relaxed);
    }

    /// Count one more if it is so.
    pub fn add_if(&self, is_so: bool, count: Count) {
        if is_so {
            self.add(count, 1);
        }
    }

    /// A count that something else keeps.
    pub fn set(&self, count: Count, value: u32) {
        self.counter(count).store(value, Relaxed);
    }

    /// A count as it is.
    pub fn get(&self, count: Count) -> u32 {
        self.counter(count).load(Relaxed)
    }

    fn counter(&self, count: Count) -> &AtomicU32 {
        &self.own.0[count as usize]
    }

    /// What the scalar sensor's parser has counted.
    pub fn set_scalar(&self, faults: &ScalarFaults) {
        self.scalar.set(scalar_counts(faults));
    }

    /// What the converter's driver has counted.
    pub fn set_converter(&self, faults: &AdcFaults) {
        self.converter.set(converter_counts(faults));
    }

    /// What the grid has counted.
    pub fn set_grid(&self, counters: &GridCounters) {
        self.grid.set(grid_counts(counters));
    }

    /// What the parser of the third UART has counted.
    pub fn set_nmea(&self, faults: &NmeaFaults) {
        self.nmea.set(nmea_counts(faults));
    }

    /// Every fault counter of the body, as the cable has them.
    pub fn faults(&self) -> FaultCounters {
        let program = ProgramFaults {
            records_lost: self.get(Count::RecordsLost),
            card_errors: self.get(Count::LogErrors),
            frames_dropped: self.get(Count::FramesDropped),
            console_lines_dropped: self.get(Count::ConsoleLinesDropped),
            console_receive_errors: self.get(Count::CableOverruns),
            epochs_late: self.get(Count::EpochsLost),
            sensor_bytes_lost: self.get(Count::ReadingsLost).saturating_add(self.get(Count::ConversionsLost)),
            restarts_by_fault: self.get(Count::RestartsByFault),
            crystal_failed: self.get(Count::CrystalFailed),
        };
        FaultCounters::new(self.scalar.get(), self.converter.get(), self.grid.get(), &program, self.nmea.get())
    }
}
