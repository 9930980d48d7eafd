//! `host-sim listen`: the tow cable's telemetry live, recorded and as a table; commands the other way.

mod baud;
mod commands;
mod csv_table;
mod files;
mod hear;
mod heard;
mod notes;
mod options;
mod page;
mod port;
mod receiver;
mod replay;
mod screen;
mod session;
mod ship_time;

#[cfg(unix)]
pub use hear::watch;
pub use hear::{listen, listen_and_show};
pub use heard::Heard;
pub use options::{ListenOptions, ShowOptions};
pub use replay::{ReplayOptions, replay};
pub use screen::Screen;
