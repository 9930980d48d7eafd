//! What happens at one time: marks, contacts; and what viewers want done.

use serde::Serialize;

/// Longest label of a mark, bytes.
pub(crate) const LONGEST_LABEL: usize = 60;

/// Something that a person has marked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// Place on the strip, s.
    pub time_s: f64,
    /// What it is, in the person's words; may be empty.
    pub label: String,
}

/// A target that was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// From 1 on.
    pub number: u32,
    /// Closest approach, s, on the strip.
    pub time_s: f64,
    /// Largest of the anomaly by size, signed, nT.
    pub peak_nt: f64,
    /// Between the half heights, s.
    pub width_s: f64,
    /// Signal to noise.
    pub snr: f64,
    /// Where the body was then: latitude and longitude, degrees.
    pub position_deg: Option<[f64; 2]>,
}

/// What a viewer on this machine wants done by whoever listens to the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Order {
    /// Keep a mark, and give it back as [`Update::Mark`](crate::Update::Mark): what is shown is in the file.
    Mark(Mark),
    /// Send a line to the body. Never given unless commands are allowed.
    Command(String),
    /// Keep that a person has seen an alarm; it is silent by now.
    Note(String),
}
