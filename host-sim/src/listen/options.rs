//! What to listen to, what to keep of it, and what to show.

use std::net::SocketAddr;
use std::path::PathBuf;

/// What to listen to, and what to keep of it.
#[derive(Clone, Debug)]
pub struct ListenOptions {
    /// A serial port, the address `host:port` of a TCP server, or a recording.
    pub port: String,
    /// Baud rate of a serial port, `None` for that at which the body is found to talk; of no meaning to others.
    pub baud: Option<u32>,
    /// File for every byte as it comes; must not exist yet.
    pub record: Option<PathBuf>,
    /// File for the telemetry as a table; must not exist yet.
    pub csv: Option<PathBuf>,
}

/// What is shown beside the terminal.
#[derive(Clone, Debug)]
pub struct ShowOptions {
    /// Where the page is; `None` for UDP alone.
    pub serve: Option<SocketAddr>,
    /// Whether viewers on this machine may send commands to the body.
    pub allow_commands: bool,
    /// Height above the bottom below which there is an alarm, m.
    pub lowest_altitude_m: f64,
    /// Where each epoch goes as a datagram, `host:port`.
    pub udp: Option<String>,
}

impl ShowOptions {
    /// Whether anything is asked for.
    pub fn is_any(&self) -> bool {
        self.serve.is_some() || self.udp.is_some()
    }
}
