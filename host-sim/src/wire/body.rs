//! The tasks of the firmware without the tasks.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;
use towmag::body::{Conversion, Converter, RecordBuilder};
use towmag::link::{Activity, FaultSlice, Telemetry};
use towmag::log::EpochRecord;
use towmag::sensors::ads131m04::AdcFaults;
use towmag::sensors::grid::{Grid, GridCounters, GridState, MarkedEpoch};
use towmag::sensors::scalar::{Reading, ScalarFaults, ScalarParser};
use towmag::store::Stored;
use towmag::{Pipeline, SettingsError};

/// Half the distance of two epochs.
const HALF_EPOCH_US: i32 = 50_000;

/// An epoch's record, what the cable tells of it, and when it was.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Made {
    pub(crate) record: EpochRecord,
    pub(crate) telemetry: Telemetry,
    pub(crate) instant_us: u32,
}

/// A body from one start to the next, its converter on `Bus`.
pub(crate) struct Body<Bus> {
    parser: ScalarParser,
    converter: Converter<Bus>,
    readings: Vec<Reading>,
    conversions: Vec<Conversion>,
    grid: Grid,
    state: GridState,
    pipeline: Pipeline,
    records: RecordBuilder,
}

impl<Bus: SpiDevice> Body<Bus> {
    pub(crate) fn new(stored: &Stored, bus: Bus) -> Result<Self, SettingsError> {
        let settings = &stored.settings;
        Ok(Self {
            parser: settings.scalar.build()?,
            converter: Converter::new(bus),
            readings: Vec::new(),
            conversions: Vec::new(),
            grid: settings.grid.build(settings.fluxgate.build()?)?,
            state: GridState::new(),
            pipeline: Pipeline::new(&settings.estimator, stored.prior())?,
            records: RecordBuilder::default(),
        })
    }

    /// The scalar sensor's line has brought a byte.
    pub(crate) fn scalar_byte(&mut self, byte: u8, stamp_us: u32) {
        self.readings.extend(self.parser.push(byte, stamp_us));
    }

    /// The converter says that a conversion is ready.
    pub(crate) fn conversion(&mut self, ready_us: u32) {
        self.conversions.extend(self.converter.fetch(ready_us, &mut NoDelay));
    }

    pub(crate) fn set_up(&mut self, stamp_us: u32) {
        self.converter.set_up(stamp_us, &mut NoDelay);
    }

    /// The epochs whose time is over.
    pub(crate) fn poll(&mut self, now_us: u32) -> Vec<Made> {
        for reading in self.readings.drain(..) {
            self.grid.push_scalar(&mut self.state, &reading);
        }
        for conversion in self.conversions.drain(..) {
            self.grid.push_flux(&mut self.state, conversion.counts, conversion.ready_us);
        }
        let mut made = Vec::new();
        while let Some(marked) = self.grid.poll(&mut self.state, now_us) {
            let MarkedEpoch { epoch, marks } = &marked;
            let output = self.pipeline.step(epoch);
            made.push(Made {
                record: self.records.record(*epoch, marks, output),
                telemetry: Telemetry::new(&marked, &output, None, Activity::default(), FaultSlice::default()),
                instant_us: marks.instant_us,
            });
        }
        made
    }

    pub(crate) fn bus_mut(&mut self) -> &mut Bus {
        self.converter.bus_mut()
    }

    /// The core, as it is now.
    pub(crate) fn pipeline(&self) -> &Pipeline {
        &self.pipeline
    }

    /// What went wrong on the scalar sensor's line.
    pub(crate) fn scalar_faults(&self) -> &ScalarFaults {
        self.parser.faults()
    }

    /// What became of the readings on the grid.
    pub(crate) fn grid_counters(&self) -> &GridCounters {
        self.state.counters()
    }

    /// What went wrong on the converter's bus.
    pub(crate) fn converter_faults(&self) -> &AdcFaults {
        self.converter.faults()
    }
}

/// Which epoch each row has become: `stamps` are the instants of the rows on the body's timer and their numbers.
pub(crate) fn epochs_of_rows(stamps: impl Iterator<Item = (u32, u64)>, made: &[Made]) -> Vec<(u64, &Made)> {
    // Stamps wrap after 71 minutes: walk both in their order instead of searching.
    let mut stamps = stamps.peekable();
    let mut found = Vec::with_capacity(made.len());
    for epoch in made {
        let after = |stamp_us: u32| stamp_us.wrapping_sub(epoch.instant_us) as i32;
        while stamps.next_if(|(stamp_us, _)| after(*stamp_us) < -HALF_EPOCH_US).is_some() {}
        found.extend(stamps.next_if(|(stamp_us, _)| after(*stamp_us) <= HALF_EPOCH_US).map(|(_, row)| (row, epoch)));
    }
    found
}

/// A converter in this process needs no time.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}
