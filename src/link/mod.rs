//! The tow cable: telemetry and answers up to the ship, commands down to the body.
//!
//! ```text
//! body -> ship   frames (COBS, CRC-32): Telemetry at 10 Hz, at most 50 bytes each, NavigationMessage at 2 Hz, at most 34,
//!                HousekeepingMessage every 5 s, at most 17, and lines of text
//! ship -> body   lines of text as an operator types them, or numbered and with a CRC: LineReader -> Command
//! ```
//!
//! At 9,600 baud, the slowest, the cable carries 96 bytes in an epoch. Frames keep their borders, so that text between them harms no
//! telemetry; neither direction can be held up by rubbish. Nothing here waits, and nothing knows a UART.

mod answer;
mod command;
mod execute;
mod faults;
mod found;
mod found_lines;
mod frame;
mod housekeeping;
mod line_reader;
mod message;
mod navigation;
mod numbered;
mod session;
mod session_error;
mod timer_told;

pub use answer::{Answer, StatusReport};
pub use command::{Calibrate, Command, CommandError, HELP, LONGEST_LINE, TextLine, Word, parse};
pub use execute::{Action, execute};
pub use faults::{FAULT_NAMES, FAULTS, FaultCounters, FaultSlice, ProgramFaults};
pub(crate) use faults::{NMEA_RUBBISH, SCALAR_RUBBISH, converter_counts, grid_counts, nmea_counts, scalar_counts};
pub use found::{CalibrationSummary, Found};
pub use frame::{
    FRAME_OVERHEAD, Frame, FrameCounters, FrameKind, FrameReader, MAX_BODY, MAX_FRAME, Received, frame, text_frame,
};
pub use housekeeping::HousekeepingMessage;
pub use line_reader::{ConsoleCounters, Dropped, Input, LineReader};
pub use message::{Activity, CompensatedField, MAX_TELEMETRY_BODY, Quality, Telemetry};
pub use navigation::NavigationMessage;
pub use numbered::{NumberedLine, acknowledged, acknowledgement, numbered};
pub use session::{Accepted, CalibrationSession, SessionState, Subject};
pub use session_error::SessionError;
pub use timer_told::TimerTold;
