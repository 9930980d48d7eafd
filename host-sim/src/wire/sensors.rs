//! A recording through the sensors' wires: as sentences and SPI frames to the drivers of the firmware, and back as epochs.

use std::collections::VecDeque;

use towmag::Epoch;
use towmag::model::Coefficients;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::sensors::grid::{EPOCH_US, GridSettings};
use towmag::sensors::scalar::ScalarSettings;
use towmag::store::{BodySettings, Stored};

use super::adc::AdcBus;
use super::body::{Body, Made, epochs_of_rows};
use super::faults::{Fault, FaultKind};
use super::feed::{Feed, NT_PER_COUNT, Step};
use crate::error::HostError;
use crate::recording::CsvReader;

/// Bits of a byte on the line, in microseconds at one baud.
const BYTE_US_BAUD: u32 = 10_000_000;

/// What a recording is sent through.
#[derive(Clone, Debug)]
pub struct Wires {
    /// The scalar sensor.
    pub scalar: ScalarSettings,
    /// What befalls the wires.
    pub faults: Vec<Fault>,
}

/// What the body has made of a recording.
#[derive(Clone, Debug)]
pub struct Sensed {
    /// The epoch of each row; none where the body had none.
    pub epochs: Vec<Option<Epoch>>,
    /// What the drivers have counted, and how often.
    pub faults: Vec<(&'static str, u32)>,
}

/// Send a recording, as CSV, over the wires. The body's timer is the sensors' own, its settings are a new body's.
///
/// # Errors
///
/// Rows that are no recording's, and faults that are none of the wires.
pub fn through_sensors(csv: &[u8], wires: &Wires) -> Result<Sensed, HostError> {
    let is_of_body = |fault: &Fault| [FaultKind::Reset, FaultKind::Power, FaultKind::Panic].contains(&fault.kind);
    if wires.faults.iter().any(is_of_body) {
        let what = "--fault: reset, power and panic befall the body, as in emulate; the wires know drop, damage, late, stuck, noise, crc and unplug";
        return Err(HostError::Usage(what.into()));
    }
    let settings = body_settings(wires.scalar);
    let GridSettings { scalar_delay_us, flux_delay_us, conversions_per_epoch, .. } = settings.grid;
    let (period_us, byte_us) = (EPOCH_US / u32::from(conversions_per_epoch), BYTE_US_BAUD / settings.scalar_baud);
    let recording = Box::new(CsvReader::from_reader("simulated recording", csv)?);
    let mut feed =
        Feed::new(recording, wires.scalar.format.build()?, conversions_per_epoch.into(), wires.faults.clone());
    let stored = Stored { settings, coefficients: Coefficients::ZERO, information: None, level: None };
    let mut body = Body::new(&stored, AdcBus::default())?;
    let (mut made, mut stamps): (Vec<Made>, Vec<(u32, u64)>) = Default::default();
    let mut line = VecDeque::new();
    let mut instant_us = 0_u32;
    while let Some(step) = feed.next()? {
        instant_us = instant_us.wrapping_add(period_us);
        stamps.extend(step.row.map(|row| (instant_us, row)));
        let first_byte_us = instant_us.wrapping_add(scalar_delay_us);
        let bytes = step.sentence.iter().zip(0..);
        line.extend(bytes.map(|(&byte, k)| (byte, first_byte_us.wrapping_add(k * byte_us))));
        made.extend(live(&mut body, &mut line, step, instant_us.wrapping_add(flux_delay_us)));
    }
    let mut epochs = vec![None; usize::try_from(feed.rows()).unwrap_or(usize::MAX)];
    for (row, made) in epochs_of_rows(stamps.into_iter(), &made) {
        epochs[row as usize] = Some(made.record.epoch);
    }
    Ok(Sensed { epochs, faults: faults(&body) })
}

/// One conversion, and what has come over the line by the time that it is ready.
fn live(body: &mut Body<AdcBus>, line: &mut VecDeque<(u8, u32)>, step: Step, ready_us: u32) -> Vec<Made> {
    let is_due = |(_, stamp_us): &(u8, u32)| ready_us.wrapping_sub(*stamp_us) as i32 >= 0;
    while line.front().is_some_and(is_due) {
        line.pop_front().into_iter().for_each(|(byte, stamp_us)| body.scalar_byte(byte, stamp_us));
    }
    body.bus_mut().convert(&step);
    body.conversion(ready_us);
    body.poll(ready_us)
}

/// A new body, but for a fluxgate with the resolution of a recording.
fn body_settings(scalar: ScalarSettings) -> BodySettings {
    let scalar_baud = scalar.format.format().baud;
    let fluxgate = FluxgateSettings { nt_per_count: [NT_PER_COUNT; 3], ..FluxgateSettings::default() };
    BodySettings { scalar, scalar_baud, fluxgate, ..BodySettings::default() }
}

/// What was counted at all.
fn faults(body: &Body<AdcBus>) -> Vec<(&'static str, u32)> {
    let (scalar, converter, grid) = (body.scalar_faults(), body.converter_faults(), body.grid_counters());
    let all = [
        ("rubbish bytes", scalar.rubbish_bytes),
        ("cut sentences", scalar.cut_lines),
        ("overlong sentences", scalar.overlong),
        ("sentences with a bad number", scalar.bad_number),
        ("malformed sentences", scalar.malformed),
        ("readings out of range", scalar.out_of_range),
        ("readings with a wrong signal", scalar.signal_out_of_limits),
        ("readings flagged invalid", scalar.flagged_invalid),
        ("readings off their time", grid.scalar_off_time),
        ("readings after their epoch", grid.scalar_late),
        ("doubled readings", grid.scalar_duplicates),
        ("damaged frames", converter.crc),
        ("failed set-ups of the converter", converter.set_up),
        ("resets of the converter", converter.resets),
        ("resynchronisations of the converter", converter.resynchronisations),
        ("commands damaged on their way", converter.command_crc),
        ("damaged set-ups of the converter", converter.corrupted),
        ("stale conversions", converter.stale),
    ];
    all.into_iter().filter(|(_, count)| *count > 0).collect()
}
