//! The telemetry as a table: one row per message.

use std::io::{BufWriter, Write};

use towmag::Status;
use towmag::housekeeping::Housekeeping;
use towmag::link::Telemetry;
use towmag::navigation::Navigation;

use super::heard::Told;
use super::screen::{flux_name, nanotesla, scalar_name, status_name};
use crate::error::HostError;

const HEADER: [&str; 29] = [
    "tick",
    "time_s",
    "time_error_s",
    "ship_time_s",
    "scalar_nT",
    "compensated_nT",
    "residual_nT",
    "valid",
    "status",
    "scalar",
    "fluxgate",
    "signal",
    "duplicates",
    "relocked",
    "logging",
    "calibrating",
    "log_failing",
    "fault_number",
    "fault_counts",
    "depth_m",
    "altitude_m",
    "latitude_deg",
    "longitude_deg",
    "position_fix",
    "heading_deg",
    "heading_magnetic_deg",
    "battery_V",
    "leak",
    "notes",
];

/// Writes row after row.
pub(super) struct CsvTable<W: Write> {
    writer: csv::Writer<BufWriter<W>>,
    /// What goes into the next row.
    notes: Vec<String>,
}

impl<W: Write> CsvTable<W> {
    /// Write the header.
    pub(super) fn new(writer: W) -> Result<Self, HostError> {
        let mut table = Self { writer: csv::Writer::from_writer(BufWriter::new(writer)), notes: Vec::new() };
        table.writer.write_record(HEADER)?;
        Ok(table)
    }

    /// Keep a note: it goes into the next row.
    pub(super) fn note(&mut self, note: &str) {
        self.notes.push(note.into());
    }

    /// Write one message, which came at `ship_us` of the ship's time, microseconds since 1970-01-01 UTC; what it does not
    /// have is empty. Times are written as seconds.
    pub(super) fn write(&mut self, message: &Telemetry, told: &Told, ship_us: Option<u64>) -> Result<(), HostError> {
        let Telemetry { tick, unix_ms, time_error_ms, raw_scalar_pt, compensated, status, quality, activity, faults } =
            message;
        let is = |set: bool| String::from(if set { "1" } else { "0" });
        let [first, second] = faults.counts;
        let fields = [
            tick.to_string(),
            unix_ms.map_or_else(String::new, seconds),
            time_error_ms.map_or_else(String::new, |error_ms| format!("{:.3}", f64::from(error_ms) / 1e3)),
            ship_us.map_or_else(String::new, |unix_us| seconds(unix_us / 1_000)),
            raw_scalar_pt.map_or_else(String::new, nanotesla),
            compensated.map_or_else(String::new, |compensated| nanotesla(compensated.compensated_pt)),
            compensated.map_or_else(String::new, |compensated| compensated.residual_nt.to_string()),
            is(matches!(status, Status::Used | Status::Settling)),
            status_name(*status).into(),
            scalar_name(quality.scalar).into(),
            flux_name(quality.flux).into(),
            quality.signal.map_or_else(String::new, |signal| signal.to_string()),
            is(quality.duplicates),
            is(quality.relocked),
            is(activity.logging),
            is(activity.calibrating),
            is(activity.log_failing),
            faults.first.to_string(),
            format!("{first} {second}"),
        ];
        let Housekeeping { battery_v, has_leak } = told.housekeeping;
        let housekeeping =
            [battery_v.map_or_else(String::new, |volts| volts.to_string()), has_leak.map_or_else(String::new, is)];
        let state = navigation_fields(&told.navigation).into_iter().chain(housekeeping);
        let notes = self.notes.join("; ");
        self.notes.clear();
        self.writer.write_record(fields.into_iter().chain(state).chain([notes]))?;
        Ok(())
    }

    /// What is written so far reaches the file.
    pub(super) fn flush(&mut self) -> Result<(), HostError> {
        Ok(self.writer.flush()?)
    }
}

fn navigation_fields(navigation: &Navigation) -> [String; 7] {
    let Navigation { depth_m, altitude_m, position, heading } = *navigation;
    let single = |value: Option<f32>| value.map_or_else(String::new, |value| value.to_string());
    let angle = |angle_e7: i32| format!("{:.7}", f64::from(angle_e7) * 1e-7);
    let heading = |is_magnetic| heading.filter(|heading| heading.is_magnetic == is_magnetic).map(|heading| heading.deg);
    [
        single(depth_m),
        single(altitude_m),
        position.map_or_else(String::new, |position| angle(position.latitude_e7)),
        position.map_or_else(String::new, |position| angle(position.longitude_e7)),
        position.map_or_else(String::new, |position| position.fix.to_string()),
        single(heading(false)),
        single(heading(true)),
    ]
}

fn seconds(unix_ms: u64) -> String {
    format!("{}.{:03}", unix_ms / 1000, unix_ms % 1000)
}
