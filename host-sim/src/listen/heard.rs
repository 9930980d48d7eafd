//! What a session of listening comes to.

use towmag::housekeeping::Housekeeping;
use towmag::link::FrameCounters;
use towmag::navigation::Navigation;

/// What the body has told beside its epochs, as far as it is known at one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Told {
    pub(super) navigation: Navigation,
    pub(super) housekeeping: Housekeeping,
}

/// What was heard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Heard {
    /// Telemetry messages.
    pub messages: u64,
    /// Lines of text.
    pub lines: u64,
    /// Ticks between messages of one run of the body that never arrived.
    pub lost_ticks: u64,
    /// Times that the ticks went back: restarts of the body.
    pub restarts: u64,
    /// Frames of a known kind whose body makes no sense: another version of the firmware.
    pub undecodable: u64,
    /// Frames by the reader's count.
    pub frames: FrameCounters,
}

impl Heard {
    /// Ticks that have passed, as far as they were heard or missed.
    pub(super) fn ticks(&self) -> u64 {
        self.messages + self.lost_ticks
    }
}
