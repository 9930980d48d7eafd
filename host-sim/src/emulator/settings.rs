//! How to emulate, and the body that is emulated.

use std::path::PathBuf;
use std::str::FromStr;

use towmag::Settings;
use towmag::housekeeping::HousekeepingSettings;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::sensors::grid::GridSettings;
use towmag::sensors::nmea::NmeaSettings;
use towmag::sensors::scalar::{ChannelSettings, ScalarSettings};
use towmag::store::{BodySettings, CABLE_BAUD};

use crate::recording::{Column, RecordingReader};
use crate::wire::Fault;
use crate::wire::feed::{NT_PER_COUNT, V_PER_COUNT};

/// How to emulate.
#[derive(Clone, Debug)]
pub struct EmulationSettings {
    /// The firmware, built for emulation.
    pub image: PathBuf,
    /// The scalar sensor; its format is what the body is sent.
    pub scalar: ScalarSettings,
    /// Fluxgate conversions to an epoch, odd, 1 to 25.
    pub conversions_per_epoch: u8,
    /// What befalls the body.
    pub faults: Vec<Fault>,
    /// What the operator types.
    pub typed: Vec<Typed>,
}

/// A line for the console, and the row at which it is typed: `ROW:LINE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Typed {
    /// From 0.
    pub row: u64,
    /// Without its end.
    pub line: String,
}

impl FromStr for Typed {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let usage = "ROW:LINE, such as 100:status";
        let (row, line) = text.split_once(':').ok_or(usage)?;
        Ok(Self { row: row.trim().parse().map_err(|_| usage)?, line: line.trim().into() })
    }
}

/// Room for the log, hours: six rows a block, each with its depth, are less than what fits. A row takes at least twenty bytes.
fn log_hours(recording: &dyn RecordingReader) -> u32 {
    let most_rows = recording.byte_len().unwrap_or(40_000_000) / 20;
    u32::try_from(most_rows / 6 / 3_600 + 1).unwrap_or(u32::MAX).min(240)
}

/// A body whose sensors have no delay, whose fluxgate has the resolution of a recording, and that has a leak contact and a
/// divider for its battery where the recording has their columns.
pub(super) fn body_settings(
    settings: &Settings,
    emulation: &EmulationSettings,
    recording: &dyn RecordingReader,
) -> BodySettings {
    let has = |column| recording.schema().position(column).is_some();
    let battery_v_per_count = if has(Column::BatteryVoltage) { V_PER_COUNT } else { 0.0 };
    let is_leak_fitted = has(Column::Leak);
    BodySettings {
        housekeeping: HousekeepingSettings { battery_v_per_count, is_leak_fitted, ..Default::default() },
        estimator: *settings,
        scalar: emulation.scalar,
        channels: ChannelSettings::default(),
        nmea: NmeaSettings { baud: 115_200, ..NmeaSettings::default() },
        scalar_baud: 115_200,
        cable_baud: CABLE_BAUD,
        grid: GridSettings {
            scalar_delay_us: 0,
            flux_delay_us: 0,
            conversions_per_epoch: emulation.conversions_per_epoch,
            ..GridSettings::default()
        },
        fluxgate: FluxgateSettings { nt_per_count: [NT_PER_COUNT; 3], ..FluxgateSettings::default() },
        log: true,
        log_file_h: log_hours(recording),
    }
}
