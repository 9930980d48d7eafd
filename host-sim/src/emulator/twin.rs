//! The same body in this process: every byte and frame at the stamp that the emulated one has noted for it.

use std::collections::VecDeque;

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use towmag::body::{Conversion, Converter, Recorder};
use towmag::link::{Activity, FaultSlice, Telemetry};
use towmag::logbook::EpochRecord;
use towmag::sensors::ads131m04::FRAME_BYTES;
use towmag::sensors::grid::{Grid, GridState, MarkedEpoch};
use towmag::sensors::scalar::{Reading, ScalarParser};
use towmag::store::Stored;
use towmag::{Pipeline, SettingsError};

/// Something that the body has stamped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    ScalarByte(u32),
    Conversion(u32),
    Poll(u32),
    SetUp(u32),
    Boot,
}

impl Event {
    /// From the bridge's protocol; `None` when the body has lost events.
    pub(super) fn decode([kind, stamp @ ..]: [u8; 5]) -> Option<Self> {
        let stamp_us = u32::from_le_bytes(stamp);
        Some(match kind {
            1 => Self::ScalarByte(stamp_us),
            2 => Self::Conversion(stamp_us),
            3 => Self::Poll(stamp_us),
            4 => Self::SetUp(stamp_us),
            5 => Self::Boot,
            _ => return None,
        })
    }

    /// Whether SPI transactions follow.
    pub(super) fn starts_transactions(self) -> bool {
        matches!(self, Self::Conversion(_) | Self::SetUp(_))
    }
}

/// The body's tasks without the tasks.
pub(super) struct Twin {
    life: Life,
    /// What it made of each of its lives.
    pub(super) sessions: Vec<Vec<Made>>,
}

/// An epoch's record, what the cable tells of it, and when it was.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Made {
    pub(super) record: EpochRecord,
    pub(super) telemetry: Telemetry,
    pub(super) instant_us: u32,
}

/// From one start to the next.
struct Life {
    bytes: VecDeque<u8>,
    parser: ScalarParser,
    converter: Converter<Frames>,
    readings: Vec<Reading>,
    conversions: Vec<Conversion>,
    grid: Grid,
    state: GridState,
    pipeline: Pipeline,
    recorder: Recorder,
}

impl Life {
    fn new(stored: &Stored) -> Result<Self, SettingsError> {
        let settings = &stored.settings;
        Ok(Self {
            bytes: VecDeque::new(),
            parser: settings.scalar.build()?,
            converter: Converter::new(Frames(VecDeque::new())),
            readings: Vec::new(),
            conversions: Vec::new(),
            grid: settings.grid.build(settings.fluxgate.build()?)?,
            state: GridState::new(),
            pipeline: Pipeline::new(&settings.estimator, stored.prior())?,
            recorder: Recorder::default(),
        })
    }
}

impl Twin {
    pub(super) fn new(stored: &Stored) -> Result<Self, SettingsError> {
        Ok(Self { life: Life::new(stored)?, sessions: Vec::new() })
    }

    /// What the scalar sensor has sent.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        self.life.bytes.extend(bytes);
    }

    /// What the converter has answered.
    pub(super) fn answer(&mut self, frame: [u8; FRAME_BYTES]) {
        self.life.converter_frames().push_back(frame);
    }

    /// The core, as it is now.
    pub(super) fn pipeline(&self) -> &Pipeline {
        &self.life.pipeline
    }

    /// The body has started with what its flash holds: whatever was under way is gone.
    pub(super) fn boot(&mut self, stored: &Stored) -> Result<(), SettingsError> {
        self.life = Life::new(stored)?;
        self.sessions.push(Vec::new());
        Ok(())
    }

    /// Do what the body did at this event. [`Event::Boot`] is the caller's.
    pub(super) fn live(&mut self, event: Event) {
        let life = &mut self.life;
        match event {
            Event::ScalarByte(stamp_us) => {
                let byte = life.bytes.pop_front();
                life.readings.extend(byte.and_then(|byte| life.parser.push(byte, stamp_us)));
            }
            Event::Conversion(stamp_us) => life.conversions.extend(life.converter.fetch(stamp_us, &mut NoDelay)),
            Event::SetUp(stamp_us) => _ = life.converter.set_up(stamp_us, &mut NoDelay),
            Event::Poll(stamp_us) => {
                let made = life.poll(stamp_us);
                if let Some(session) = self.sessions.last_mut() {
                    session.extend(made);
                }
            }
            Event::Boot => {}
        }
    }
}

impl Life {
    fn converter_frames(&mut self) -> &mut VecDeque<[u8; FRAME_BYTES]> {
        &mut self.converter.bus_mut().0
    }

    fn poll(&mut self, now_us: u32) -> Vec<Made> {
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
                record: self.recorder.record(*epoch, marks, output),
                telemetry: Telemetry::new(&marked, &output, None, Activity::default(), FaultSlice::default()),
                instant_us: marks.instant_us,
            });
        }
        made
    }
}

/// The frames that the emulated converter has answered with.
struct Frames(VecDeque<[u8; FRAME_BYTES]>);

impl ErrorType for Frames {
    type Error = ErrorKind;
}

impl SpiDevice for Frames {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let [Operation::TransferInPlace(bytes)] = operations else { return Err(ErrorKind::Other) };
        bytes.copy_from_slice(&self.0.pop_front().ok_or(ErrorKind::Other)?);
        Ok(())
    }
}

/// The emulated body has waited; its stamps tell.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}
