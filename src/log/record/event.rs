//! Things that happen between two ticks.

use super::fluxgate_axes::FluxgateAxes;
use super::information::InformationPart;
use super::kind::EVENT;
use crate::Settings;
use crate::body::UnixTime;
use crate::bytes::{Put, Take};
use crate::housekeeping::Housekeeping;
use crate::model::Coefficients;
use crate::navigation::Navigation;
use crate::wire::{put_coefficients, put_settings, take_coefficients, take_settings};

/// Longest text in an event, bytes of UTF-8.
pub const TEXT_LEN: usize = 200;

/// Something that happened. Body: `tick u32, code u8, payload`.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The tick at which it happened, or the latest before it.
    pub tick: u32,
    /// What happened.
    pub kind: EventKind,
}

/// What happened. The number is the code on the card, then comes the payload's layout.
#[derive(Clone, Debug, PartialEq)]
// See `Record`: nothing keeps more than one of these.
#[allow(clippy::large_enum_variant)]
pub enum EventKind {
    /// 1, `cause u8`: the firmware has started.
    Reset(ResetCause),
    /// 2, `length u8, UTF-8`: the message of the panic that ended the session before this.
    Panic(heapless::String<TEXT_LEN>),
    /// 3, settings as in the header: an operator changed them; they hold from the next tick.
    SettingsChanged(Settings),
    /// 4, `unix_ms u64`: in logs of an earlier program, the time at the event's tick, ms since 1970-01-01 UTC.
    TimeSet {
        /// Milliseconds since 1970-01-01 UTC.
        unix_ms: u64,
    },
    /// 5, `18 x f32, used_epochs u32, std_before_nt f32, rms_after_nt f32`: a calibration has a result.
    Calibrated {
        /// Coefficients in the core's basis, nT.
        coefficients: Coefficients,
        /// Epochs behind them.
        used_epochs: u32,
        /// Standard deviation of the band-passed scalar over these epochs, nT.
        std_before_nt: f32,
        /// Root mean square of what the coefficients leave of it, nT.
        rms_after_nt: f32,
    },
    /// 6, `used_epochs u32`: a calibration ended without a result.
    CalibrationFailed {
        /// Usable epochs that there were.
        used_epochs: u32,
    },
    /// 7: logging was switched on.
    LogStart,
    /// 8: logging was switched off; without it the session ended in a power cut or a reset.
    LogStop,
    /// 9, `first_position u32, blocks u32`: blocks of the region would not be written and were left out.
    BadBlocks {
        /// Position in the region of the first.
        first_position: u32,
        /// How many attempts failed; the blocks need not be consecutive.
        blocks: u32,
    },
    /// 10, `8 x u16`: the firmware's fault counters, in its own order, wrapping.
    FaultCounters([u16; 8]),
    /// 11, `length u8, UTF-8`: something that the operator should know.
    Notice(heapless::String<TEXT_LEN>),
    /// 12, `part u8, 38 x f32`: a part of the information behind the header's coefficients, which `adaptive` starts from.
    /// Five follow the header where there is any. A log without them is of an earlier program, or of a body without it.
    Information(InformationPart),
    /// 19, as 12: a part of what the calibration has learnt of the level, which `adaptive` starts from too, in columns
    /// [2](crate::estimate::LEVEL_COLUMNS). Five follow those of the information.
    Level(InformationPart),
    /// 18, as 19, from an earlier firmware: in columns 1, of which this core makes no use.
    EarlierLevel(InformationPart),
    /// 13, [`FluxgateAxes`], `used_epochs u32, rms_before_nt f32, rms_after_nt f32`: a calibration of the fluxgate has a
    /// result. It holds from the next start, if it is accepted.
    FluxgateCalibrated {
        /// The axes.
        axes: FluxgateAxes,
        /// Epochs behind them.
        used_epochs: u32,
        /// Root mean square of the fluxgate's magnitude less the scalar over these epochs, nT, as it was.
        rms_before_nt: f32,
        /// The same with these axes.
        rms_after_nt: f32,
    },
    /// 14, `unix_us u64, error_us u32`: the time at the event's tick; when it was set, and every minute while it is known.
    Time(UnixTime),
    /// 15, [`Navigation`]: the values that have come since the last such event; each holds for
    /// [`LONGEST_AGE_S`](crate::navigation::LONGEST_AGE_S). Before the record of its epoch, at most once an epoch.
    Navigation(Navigation),
    /// 17, [`Housekeeping`]: leak contact and battery, once a second, and at once when the contact has changed; each value
    /// holds for three seconds. Before the record of its epoch.
    Housekeeping(Housekeeping),
}

/// Why the microcontroller started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// 0: power came.
    PowerOn,
    /// 1: the supply sagged.
    BrownOut,
    /// 2: the reset pin.
    Pin,
    /// 3: the firmware itself, after a panic among others.
    Software,
    /// 4: a watchdog.
    Watchdog,
    /// 5: a low-power mode was entered where it must not be.
    LowPower,
    /// 255: the hardware does not say.
    Unknown,
}

impl core::fmt::Display for ResetCause {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::PowerOn => "power",
            Self::BrownOut => "a supply that sagged",
            Self::Pin => "the reset pin",
            Self::Software => "the program",
            Self::Watchdog => "the watchdog",
            Self::LowPower => "a low-power mode",
            Self::Unknown => "an unknown cause",
        })
    }
}

impl Event {
    pub(super) fn put(&self, put: &mut Put<'_>) -> u8 {
        put.u32(self.tick);
        self.kind.put(put);
        EVENT
    }

    pub(super) fn take(take: &mut Take<'_>) -> Option<Self> {
        Some(Self { tick: take.u32()?, kind: EventKind::take(take)? })
    }
}

impl EventKind {
    fn put(&self, put: &mut Put<'_>) {
        put.u8(self.code());
        match self {
            Self::Reset(cause) => put.u8(cause.code()),
            Self::Panic(text) | Self::Notice(text) => put.text(text),
            Self::SettingsChanged(settings) => put_settings(settings, put),
            Self::TimeSet { unix_ms } => put.u64(*unix_ms),
            Self::Calibrated { coefficients, used_epochs, std_before_nt, rms_after_nt } => {
                put_coefficients(coefficients, put);
                put.u32(*used_epochs);
                put.f32(*std_before_nt);
                put.f32(*rms_after_nt);
            }
            Self::CalibrationFailed { used_epochs } => put.u32(*used_epochs),
            Self::LogStart | Self::LogStop => {}
            Self::BadBlocks { first_position, blocks } => {
                put.u32(*first_position);
                put.u32(*blocks);
            }
            Self::Information(part) | Self::Level(part) | Self::EarlierLevel(part) => part.put(put),
            Self::FluxgateCalibrated { axes, used_epochs, rms_before_nt, rms_after_nt } => {
                axes.put(put);
                put.u32(*used_epochs);
                put.f32(*rms_before_nt);
                put.f32(*rms_after_nt);
            }
            Self::Time(time) => {
                put.u64(time.unix_us);
                put.u32(time.error_us);
            }
            Self::Navigation(navigation) => navigation.put(put),
            Self::Housekeeping(housekeeping) => housekeeping.put(put),
            Self::FaultCounters(counters) => counters.iter().for_each(|&count| put.u16(count)),
        }
    }

    fn take(take: &mut Take<'_>) -> Option<Self> {
        Some(match take.u8()? {
            1 => Self::Reset(ResetCause::of(take.u8()?)?),
            2 => Self::Panic(take.text()?),
            3 => Self::SettingsChanged(take_settings(take)?),
            4 => Self::TimeSet { unix_ms: take.u64()? },
            5 => Self::Calibrated {
                coefficients: take_coefficients(take)?,
                used_epochs: take.u32()?,
                std_before_nt: take.f32()?,
                rms_after_nt: take.f32()?,
            },
            6 => Self::CalibrationFailed { used_epochs: take.u32()? },
            7 => Self::LogStart,
            8 => Self::LogStop,
            9 => Self::BadBlocks { first_position: take.u32()?, blocks: take.u32()? },
            10 => Self::FaultCounters(take_counters(take)?),
            11 => Self::Notice(take.text()?),
            12 => Self::Information(InformationPart::take(take)?),
            18 => Self::EarlierLevel(InformationPart::take(take)?),
            19 => Self::Level(InformationPart::take(take)?),
            13 => Self::FluxgateCalibrated {
                axes: FluxgateAxes::take(take)?,
                used_epochs: take.u32()?,
                rms_before_nt: take.f32()?,
                rms_after_nt: take.f32()?,
            },
            14 => Self::Time(UnixTime { unix_us: take.u64()?, error_us: take.u32()? }),
            15 => Self::Navigation(Navigation::take(take)?),
            17 => Self::Housekeeping(Housekeeping::take(take)?),
            _ => return None,
        })
    }

    fn code(&self) -> u8 {
        match self {
            Self::Reset(_) => 1,
            Self::Panic(_) => 2,
            Self::SettingsChanged(_) => 3,
            Self::TimeSet { .. } => 4,
            Self::Calibrated { .. } => 5,
            Self::CalibrationFailed { .. } => 6,
            Self::LogStart => 7,
            Self::LogStop => 8,
            Self::BadBlocks { .. } => 9,
            Self::FaultCounters(_) => 10,
            Self::Notice(_) => 11,
            Self::Information(_) => 12,
            Self::Level(_) => 19,
            Self::EarlierLevel(_) => 18,
            Self::FluxgateCalibrated { .. } => 13,
            Self::Time(_) => 14,
            Self::Navigation(_) => 15,
            Self::Housekeeping(_) => 17,
        }
    }
}

fn take_counters(take: &mut Take<'_>) -> Option<[u16; 8]> {
    let mut counters = [0; 8];
    for count in &mut counters {
        *count = take.u16()?;
    }
    Some(counters)
}

impl ResetCause {
    fn code(self) -> u8 {
        match self {
            Self::PowerOn => 0,
            Self::BrownOut => 1,
            Self::Pin => 2,
            Self::Software => 3,
            Self::Watchdog => 4,
            Self::LowPower => 5,
            Self::Unknown => 255,
        }
    }

    fn of(code: u8) -> Option<Self> {
        Some(match code {
            0 => Self::PowerOn,
            1 => Self::BrownOut,
            2 => Self::Pin,
            3 => Self::Software,
            4 => Self::Watchdog,
            5 => Self::LowPower,
            255 => Self::Unknown,
            _ => return None,
        })
    }
}
