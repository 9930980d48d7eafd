//! What comes down the emulated cable.

use std::collections::BTreeMap;

use towmag::logbook::{EpochRecord, Record};

const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);
const STATUS_KIND: u8 = 0x80;

/// Names of the status values, in the order of the firmware's `Count`.
const NAMES: [&str; 13] = [
    "readings_lost",
    "conversions_lost",
    "epochs_lost",
    "records_lost",
    "cable_bytes_lost",
    "cable_overruns",
    "uart_overruns",
    "fluxgate_crc_errors",
    "log_errors",
    "log_records_safe",
    "ticks_per_epoch_worst",
    "ticks_per_epoch_mean",
    "stack_bytes_worst",
];

/// The body's counters and costs, by name, as of its last status.
pub type Figures = BTreeMap<&'static str, u32>;

/// What was found in the stream.
#[derive(Default)]
pub(super) struct Telemetry {
    pub(super) epochs: Vec<EpochRecord>,
    pub(super) figures: Figures,
    pub(super) bad_bytes: usize,
}

/// Take the stream apart; what is no message is stepped over and counted.
pub(super) fn read(mut bytes: &[u8]) -> Telemetry {
    let mut telemetry = Telemetry::default();
    while !bytes.is_empty() {
        match message(bytes) {
            Some((content, rest)) => {
                telemetry.take(content);
                bytes = rest;
            }
            None => {
                telemetry.bad_bytes += 1;
                bytes = &bytes[1..];
            }
        }
    }
    telemetry
}

fn message(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (&len, rest) = bytes.strip_prefix(&[0xA5, 0x5A])?.split_first()?;
    let (content, rest) = rest.split_at_checked(len.into())?;
    let (crc, rest) = rest.split_first_chunk::<2>()?;
    (CRC.checksum(content).to_le_bytes() == *crc).then_some((content, rest))
}

impl Telemetry {
    fn take(&mut self, content: &[u8]) {
        if let Some(values) = content.strip_prefix(&[STATUS_KIND]) {
            let (values, _) = values.as_chunks::<4>();
            self.figures = NAMES.into_iter().zip(values.iter().map(|value| u32::from_le_bytes(*value))).collect();
        } else if let Ok((Record::Epoch(record), _)) = Record::decode(content) {
            self.epochs.push(record);
        }
    }
}
