//! Effects put into a real recording: those that need no other physics than what was recorded.

mod csv;
mod injection;
mod recording;

pub(crate) use injection::{answer, injected};
pub use recording::RealRecording;
