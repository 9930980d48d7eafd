//! What goes up the cable at every epoch.

use super::faults::FaultSlice;
use super::frame::{Frame, FrameKind, frame};
use crate::body::UnixTime;
use crate::bytes::{Put, Take, put_some, take_some};
use crate::sensors::grid::{FluxMark, MarkedEpoch, ScalarMark};
use crate::{Output, Status};

/// Longest body of a telemetry message, bytes: with its frame 50, half of what 9,600 baud carry in an epoch.
pub const MAX_TELEMETRY_BODY: usize = 42;

/// One epoch for the people on the ship. The log on the card has all; this has what one looks at while it runs.
///
/// Body, little-endian, fields in brackets only when their flag is set: `flags u8, tick u32, status u8
/// (`[`Status::code`]`), marks u8, first_fault u8, 2 faults u32, [0: unix_ms u64], [1: raw_scalar_pt i32], [2:
/// compensated_pt i32, residual_nt f32], [3: signal u32], [7: time_error_ms u16]`. Flags 4 logging, 5 calibrating, 6 log failing. Marks:
/// bits 0 and 1 scalar, 2 and 3 fluxgate, in the order of [`ScalarMark`] and [`FluxMark`]; 4 duplicates, 5 relocked;
/// the rest zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Tick of the epoch.
    pub tick: u32,
    /// Time at that tick, milliseconds since 1970-01-01 UTC; `None` while the clock is not set.
    pub unix_ms: Option<u64>,
    /// By how much that time may be off, milliseconds; 65,535 stands for more. `None` where it is not told.
    pub time_error_ms: Option<u16>,
    /// Total field as the sensor sent it, picotesla: also when it is invalid. `None` when nothing came.
    pub raw_scalar_pt: Option<i32>,
    /// The compensated reading; `None` exactly when the epoch was rejected.
    pub compensated: Option<CompensatedField>,
    /// What became of the epoch, and why it was rejected.
    pub status: Status,
    /// How good the readings are.
    pub quality: Quality,
    /// What the body is doing.
    pub activity: Activity,
    /// Two of the fault counters in turn.
    pub faults: FaultSlice,
}

/// The compensated reading of an epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensatedField {
    /// Scalar reading less the interference, picotesla.
    pub compensated_pt: i32,
    /// Band-passed scalar less the prediction, nT: strictly predictive.
    pub residual_nt: f32,
}

/// How good the readings of an epoch are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// The scalar reading.
    pub scalar: ScalarMark,
    /// The fluxgate reading.
    pub flux: FluxMark,
    /// Whether further scalar readings of this epoch were dropped.
    pub duplicates: bool,
    /// Whether the grid was moved to the scalar sensor's phase at this epoch.
    pub relocked: bool,
    /// Signal strength of the scalar sensor, in its own units.
    pub signal: Option<u32>,
}

/// What the body is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Activity {
    /// Epochs go to the card.
    pub logging: bool,
    /// A calibration is being recorded.
    pub calibrating: bool,
    /// The card does not take what it should.
    pub log_failing: bool,
}

const TIME: u8 = 1 << 0;
const SCALAR: u8 = 1 << 1;
const COMPENSATED: u8 = 1 << 2;
const SIGNAL: u8 = 1 << 3;
const LOGGING: u8 = 1 << 4;
const CALIBRATING: u8 = 1 << 5;
const LOG_FAILING: u8 = 1 << 6;
const TIME_ERROR: u8 = 1 << 7;

const DUPLICATES: u8 = 1 << 4;
const RELOCKED: u8 = 1 << 5;
const KNOWN_MARKS: u8 = 0x3f;

impl Telemetry {
    /// The message of an epoch and of what the pipeline made of it.
    pub fn new(
        marked: &MarkedEpoch,
        output: &Output,
        time: Option<UnixTime>,
        activity: Activity,
        faults: FaultSlice,
    ) -> Self {
        let MarkedEpoch { epoch, marks } = marked;
        Self {
            tick: epoch.tick,
            unix_ms: time.map(|time| time.unix_us / 1_000),
            time_error_ms: time.map(|time| u16::try_from(time.error_us.div_ceil(1_000)).unwrap_or(u16::MAX)),
            raw_scalar_pt: epoch.scalar_pt.or(marks.raw_scalar_pt),
            compensated: output.compensated.map(|compensated| CompensatedField {
                compensated_pt: compensated.compensated_pt,
                residual_nt: compensated.residual_nt,
            }),
            status: output.status,
            quality: Quality {
                scalar: marks.scalar,
                flux: marks.flux,
                duplicates: marks.duplicates > 0,
                relocked: marks.relocked,
                signal: marks.signal,
            },
            activity,
            faults,
        }
    }

    /// The message in its frame, 24 to 50 bytes.
    pub fn frame(&self) -> Frame {
        let mut body = [0; MAX_TELEMETRY_BODY];
        // The body has room for every field: neither step fails, and an empty frame would be nothing to the receiver.
        let len = self.encode(&mut body).unwrap_or(0);
        frame(FrameKind::Telemetry, body.get(..len).unwrap_or_default()).unwrap_or_default()
    }

    /// Write the body; returns its length, `None` when `body` is too short.
    pub fn encode(&self, body: &mut [u8]) -> Option<usize> {
        let mut put = Put::new(body);
        put.u8(self.flags());
        put.u32(self.tick);
        put.u8(self.status.code());
        put.u8(self.quality.marks());
        put.u8(self.faults.first);
        self.faults.counts.iter().for_each(|&count| put.u32(count));
        put_some(self.unix_ms, |unix_ms| put.u64(unix_ms));
        put_some(self.raw_scalar_pt, |scalar_pt| put.i32(scalar_pt));
        put_some(self.compensated, |compensated| {
            put.i32(compensated.compensated_pt);
            put.f32(compensated.residual_nt);
        });
        put_some(self.quality.signal, |signal| put.u32(signal));
        put_some(self.time_error_ms, |error_ms| put.u16(error_ms));
        put.finish()
    }

    /// Read a body; `None` when it is none. Exactly what [`encode`](Self::encode) writes is read.
    pub fn decode(body: &[u8]) -> Option<Self> {
        let mut take = Take(body);
        let flags = take.u8()?;
        let has = |flag| flags & flag != 0;
        let tick = take.u32()?;
        let status = Status::from_code(take.u8()?)?;
        let marks = take.u8()?;
        let faults = FaultSlice { first: take.u8()?, counts: [take.u32()?, take.u32()?] };
        let unix_ms = take_some(has(TIME), || take.u64())?;
        let raw_scalar_pt = take_some(has(SCALAR), || take.i32())?;
        let compensated = take_some(has(COMPENSATED), || {
            Some(CompensatedField { compensated_pt: take.i32()?, residual_nt: take.f32()? })
        })?;
        let quality = Quality::of(marks, take_some(has(SIGNAL), || take.u32())?)?;
        let time_error_ms = take_some(has(TIME_ERROR), || take.u16())?;
        let activity = Activity { logging: has(LOGGING), calibrating: has(CALIBRATING), log_failing: has(LOG_FAILING) };
        take.is_empty().then_some(Self {
            tick,
            unix_ms,
            time_error_ms,
            raw_scalar_pt,
            compensated,
            status,
            quality,
            activity,
            faults,
        })
    }

    fn flags(&self) -> u8 {
        flag(self.unix_ms.is_some(), TIME)
            | flag(self.raw_scalar_pt.is_some(), SCALAR)
            | flag(self.compensated.is_some(), COMPENSATED)
            | flag(self.quality.signal.is_some(), SIGNAL)
            | flag(self.time_error_ms.is_some(), TIME_ERROR)
            | flag(self.activity.logging, LOGGING)
            | flag(self.activity.calibrating, CALIBRATING)
            | flag(self.activity.log_failing, LOG_FAILING)
    }
}

impl Quality {
    fn marks(&self) -> u8 {
        let scalar = match self.scalar {
            ScalarMark::Present => 0,
            ScalarMark::Missing => 1,
            ScalarMark::Invalid => 2,
            ScalarMark::OffTime => 3,
        };
        let flux = match self.flux {
            FluxMark::Present => 0,
            FluxMark::Missing => 1,
            FluxMark::Clipped => 2,
        };
        scalar | flux << 2 | flag(self.duplicates, DUPLICATES) | flag(self.relocked, RELOCKED)
    }

    fn of(marks: u8, signal: Option<u32>) -> Option<Self> {
        let scalar = match marks & 3 {
            0 => ScalarMark::Present,
            1 => ScalarMark::Missing,
            2 => ScalarMark::Invalid,
            _ => ScalarMark::OffTime,
        };
        let flux = match marks >> 2 & 3 {
            0 => FluxMark::Present,
            1 => FluxMark::Missing,
            2 => FluxMark::Clipped,
            _ => return None,
        };
        let (duplicates, relocked) = (marks & DUPLICATES != 0, marks & RELOCKED != 0);
        (marks & !KNOWN_MARKS == 0).then_some(Self { scalar, flux, duplicates, relocked, signal })
    }
}

fn flag(is_set: bool, flag: u8) -> u8 {
    if is_set { flag } else { 0 }
}
