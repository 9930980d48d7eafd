//! What an emulation gives.

use towmag::log::Event as LogEvent;
use towmag::store::Stored;
use towmag::{Output, Pipeline};

use super::telemetry::Figures;

/// What an emulation gave, when body and replay are equal.
pub struct Emulated {
    /// The body's output for each row of the recording; `None` when the body had none for it.
    pub outputs: Vec<Option<Output>>,
    /// Epochs that were compared.
    pub epochs: usize,
    /// Starts of the body.
    pub starts: usize,
    /// The core as it is at the end.
    pub pipeline: Pipeline,
    /// What the body's flash holds at the end.
    pub stored: Stored,
    /// What came down the cable.
    pub telemetry: Vec<u8>,
    /// Lines of text that came down the cable.
    pub texts: Vec<String>,
    /// The sectors of the log.
    pub log: Vec<u8>,
    /// Epoch records in the log.
    pub log_epochs: usize,
    /// Events in the log.
    pub events: Vec<LogEvent>,
    /// The body's counters and costs.
    pub figures: Figures,
}
