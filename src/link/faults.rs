//! Every fault counter of the body in one table, sent a few at a time.

use crate::sensors::ads131m04::AdcFaults;
use crate::sensors::grid::GridCounters;
use crate::sensors::nmea::NmeaFaults;
use crate::sensors::scalar::ScalarFaults;

/// Number of fault counters.
pub const FAULTS: usize = 41;

/// Names of the counters, in the order of their numbers on the cable: scalar sensor, converter, grid, program, third UART.
pub const FAULT_NAMES: [&str; FAULTS] = [
    "scalar rubbish bytes",
    "scalar cut lines",
    "scalar overlong",
    "scalar bad number",
    "scalar malformed",
    "scalar out of range",
    "scalar signal out of limits",
    "scalar flagged invalid",
    "scalar overruns",
    "scalar framing errors",
    "scalar other receive errors",
    "converter bus",
    "converter crc",
    "converter set-up",
    "converter resets",
    "converter resynchronisations",
    "converter command crc",
    "converter corrupted",
    "converter stale",
    "scalar missing",
    "scalar invalid",
    "scalar off time",
    "scalar late",
    "scalar duplicates",
    "fluxgate missing",
    "fluxgate clipped",
    "grid relocks",
    "ticks skipped",
    "records lost",
    "card errors",
    "frames dropped",
    "console lines dropped",
    "console receive errors",
    "epochs late",
    "sensor bytes lost",
    "restarts by fault",
    "crystal failed",
    "nmea bad checksum",
    "nmea malformed",
    "nmea rubbish bytes",
    "nmea receive errors",
];

/// Places in the table.
pub(crate) const SCALAR_RUBBISH: usize = 0;
pub(crate) const NMEA_RUBBISH: usize = 39;
const SCALAR_OVERRUNS: usize = 8;
const CONVERTER_CRC: usize = 12;

/// What goes wrong in the program rather than in a sensor. Counts since the start, full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProgramFaults {
    /// Log records that found no room in the queue, or no place on the card.
    pub records_lost: u32,
    /// Errors of the card.
    pub card_errors: u32,
    /// Telemetry and text frames that found no room in the transmitter's queue.
    pub frames_dropped: u32,
    /// Console lines dropped because they were overlong or damaged.
    pub console_lines_dropped: u32,
    /// Errors of the console's receiver.
    pub console_receive_errors: u32,
    /// Epochs that were not done when the next was due.
    pub epochs_late: u32,
    /// Sensor bytes and conversions that found no room in their queue.
    pub sensor_bytes_lost: u32,
    /// Panics, hard faults and watchdog resets since power came.
    pub restarts_by_fault: u32,
    /// 1 while the body runs on its internal oscillator.
    pub crystal_failed: u32,
}

/// All counters, in the order of [`FAULT_NAMES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultCounters(pub [u32; FAULTS]);

impl Default for FaultCounters {
    fn default() -> Self {
        Self([0; FAULTS])
    }
}

/// Neighbouring counters, as one telemetry message carries them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultSlice {
    /// Number of the first counter, its place in [`FAULT_NAMES`].
    pub first: u8,
    /// The counter, and the one after it; after the last comes the first.
    pub counts: [u32; 2],
}

impl FaultCounters {
    /// Gather the counters of the scalar sensor, the converter, the grid, the program and the third UART.
    pub(crate) fn new(
        scalar: [u32; 11],
        converter: [u32; 8],
        grid: [u32; 9],
        program: &ProgramFaults,
        nmea: [u32; 4],
    ) -> Self {
        let mut counts = [0; FAULTS];
        let all = scalar.into_iter().chain(converter).chain(grid).chain(program_counts(program)).chain(nmea);
        for (place, count) in counts.iter_mut().zip(all) {
            *place = count;
        }
        Self(counts)
    }

    /// The two counters whose turn it is at `tick`: every counter comes once in 21 epochs.
    /// Their number is odd: beside the last comes the first, under a number that no counter has.
    pub fn slice(&self, tick: u32) -> FaultSlice {
        let first = (tick % FAULTS.div_ceil(2) as u32 * 2) as usize;
        let at = |number: usize| self.0.get(number % FAULTS).copied().unwrap_or(0);
        FaultSlice { first: first as u8, counts: [at(first), at(first + 1)] }
    }

    /// Bytes of the scalar sensor that came while its receiver was full.
    pub(crate) fn scalar_overruns(&self) -> u32 {
        self.0[SCALAR_OVERRUNS]
    }

    /// Frames of the converter with a wrong CRC.
    pub(crate) fn converter_crc(&self) -> u32 {
        self.0[CONVERTER_CRC]
    }

    /// Take over what a message carries; numbers that this version does not know are left out.
    pub fn update(&mut self, slice: &FaultSlice) {
        for (number, count) in (usize::from(slice.first)..).zip(slice.counts) {
            if let Some(place) = self.0.get_mut(number) {
                *place = count;
            }
        }
    }
}

/// In the order of [`FAULT_NAMES`].
pub(crate) fn scalar_counts(faults: &ScalarFaults) -> [u32; 11] {
    let ScalarFaults { rubbish_bytes, cut_lines, overlong, bad_number, malformed, .. } = *faults;
    let ScalarFaults { out_of_range, signal_out_of_limits, flagged_invalid, .. } = *faults;
    let ScalarFaults { overruns, framing_errors, other_receive_errors, .. } = *faults;
    [
        rubbish_bytes,
        cut_lines,
        overlong,
        bad_number,
        malformed,
        out_of_range,
        signal_out_of_limits,
        flagged_invalid,
        overruns,
        framing_errors,
        other_receive_errors,
    ]
}

/// In the order of [`FAULT_NAMES`].
pub(crate) fn converter_counts(faults: &AdcFaults) -> [u32; 8] {
    let AdcFaults { spi, crc, set_up, resets, resynchronisations, command_crc, corrupted, stale } = *faults;
    [spi, crc, set_up, resets, resynchronisations, command_crc, corrupted, stale]
}

/// In the order of [`FAULT_NAMES`], without the epochs that came out, which are no fault.
pub(crate) fn grid_counts(counters: &GridCounters) -> [u32; 9] {
    let GridCounters { scalar_missing, scalar_invalid, scalar_off_time, scalar_late, .. } = *counters;
    let GridCounters { scalar_duplicates, flux_missing, flux_clipped, relocks, skipped, .. } = *counters;
    [
        scalar_missing,
        scalar_invalid,
        scalar_off_time,
        scalar_late,
        scalar_duplicates,
        flux_missing,
        flux_clipped,
        relocks,
        skipped,
    ]
}

/// In the order of [`FAULT_NAMES`].
pub(crate) fn nmea_counts(faults: &NmeaFaults) -> [u32; 4] {
    let NmeaFaults { bad_checksum, malformed, rubbish_bytes, receive_errors } = *faults;
    [bad_checksum, malformed, rubbish_bytes, receive_errors]
}

fn program_counts(faults: &ProgramFaults) -> [u32; 9] {
    let ProgramFaults { records_lost, card_errors, frames_dropped, console_lines_dropped, .. } = *faults;
    let ProgramFaults { console_receive_errors, epochs_late, sensor_bytes_lost, .. } = *faults;
    let ProgramFaults { restarts_by_fault, crystal_failed, .. } = *faults;
    [
        records_lost,
        card_errors,
        frames_dropped,
        console_lines_dropped,
        console_receive_errors,
        epochs_late,
        sensor_bytes_lost,
        restarts_by_fault,
        crystal_failed,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_names() {
        assert_eq!(FAULT_NAMES[SCALAR_OVERRUNS], "scalar overruns");
        assert_eq!(FAULT_NAMES[CONVERTER_CRC], "converter crc");
        assert_eq!(FAULT_NAMES[SCALAR_RUBBISH], "scalar rubbish bytes");
        assert_eq!(FAULT_NAMES[NMEA_RUBBISH], "nmea rubbish bytes");
    }
}
