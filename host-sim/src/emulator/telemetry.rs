//! What comes down the emulated cable.

use std::collections::BTreeMap;

use towmag::link::{Activity, FaultSlice, FrameKind, FrameReader, Received, Telemetry};

/// Names of the figures, in the order in which the firmware sends them; costs are in ticks there.
pub const FIGURE_NAMES: [&str; 15] = [
    "readings_lost",
    "conversions_lost",
    "epochs_lost",
    "records_lost",
    "frames_dropped",
    "cable_overruns",
    "uart_overruns",
    "fluxgate_crc_errors",
    "log_errors",
    "log_records_safe",
    "console_lines_dropped",
    "ticks_per_epoch_worst",
    "ticks_per_epoch_mean",
    "stack_bytes_worst",
    "ticks_per_100000_instructions",
];

/// The body's counters and costs, by name, as of the last that it sent.
pub type Figures = BTreeMap<&'static str, u32>;

/// What was found in the stream.
#[derive(Default)]
pub(super) struct Cable {
    /// Messages of each life.
    pub(super) lives: Vec<Vec<Telemetry>>,
    pub(super) figures: Figures,
    /// Lines of text.
    pub(super) texts: Vec<String>,
}

/// Take the streams of all lives apart.
pub(super) fn read(lives: &[Vec<u8>]) -> Cable {
    let mut cable = Cable::default();
    for bytes in lives {
        cable.lives.push(Vec::new());
        let mut frames = FrameReader::default();
        for &byte in bytes {
            if let Some(received) = frames.push(byte) {
                cable.take(&received);
            }
        }
    }
    cable
}

impl Cable {
    fn take(&mut self, received: &Received<'_>) {
        match received.kind {
            FrameKind::Telemetry => {
                if let Some(life) = self.lives.last_mut() {
                    life.extend(Telemetry::decode(received.body));
                }
            }
            // Not in the replay of the epochs: held against the recording, and the twin's own, by way of the log.
            FrameKind::Navigation | FrameKind::Housekeeping => {}
            FrameKind::Text => self.texts.push(String::from_utf8_lossy(received.body).into_owned()),
            FrameKind::Figures => {
                let (values, _) = received.body.as_chunks::<4>();
                self.figures =
                    FIGURE_NAMES.into_iter().zip(values.iter().map(|value| u32::from_le_bytes(*value))).collect();
            }
        }
    }
}

/// A message without what only the body knows: its date, what it is doing, and the counters whose turn it is.
pub(super) fn comparable(message: &Telemetry) -> Telemetry {
    Telemetry {
        unix_ms: None,
        time_error_ms: None,
        activity: Activity::default(),
        faults: FaultSlice::default(),
        ..*message
    }
}

/// The figures with the costs in instructions, by what the body has found a known number of them to take.
pub fn in_instructions(figures: &Figures) -> BTreeMap<&'static str, u32> {
    let known = figures.get("ticks_per_100000_instructions").copied().unwrap_or(0);
    let instructions = |ticks: u32| (f64::from(ticks) * 100_000.0 / f64::from(known.max(1))) as u32;
    let convert = |(&name, &value): (&&'static str, &u32)| match name {
        "ticks_per_epoch_worst" => ("instructions_per_epoch_worst", instructions(value)),
        "ticks_per_epoch_mean" => ("instructions_per_epoch_mean", instructions(value)),
        _ => (name, value),
    };
    figures.iter().map(convert).collect()
}
