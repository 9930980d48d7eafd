//! What is served, where, and to whom.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use crate::places::Limits;

/// Where the page is unless somebody says otherwise: this machine alone reaches it.
pub const DEFAULT_ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 8080);

/// What is served, where, and to whom.
#[derive(Clone, Debug)]
pub struct LiveOptions {
    /// Where the page is; port 0 for any that is free. `None`: nowhere, for UDP alone.
    pub address: Option<SocketAddr>,
    /// What is shown, as its page calls it.
    pub title: String,
    /// Whether viewers on this machine may send commands to the body.
    pub allow_commands: bool,
    /// Whether what is shown happens now, so that silence is an alarm.
    pub is_live: bool,
    /// Height above the bottom below which there is an alarm, m.
    pub lowest_altitude_m: f64,
    /// Where each epoch goes as a datagram of JSON, `host:port`.
    pub udp: Option<String>,
    /// How many may connect, and what they may send.
    pub limits: Limits,
}

impl LiveOptions {
    /// A live page at an address; no commands, no UDP, an alarm below 2 m.
    pub fn new(address: SocketAddr, title: impl Into<String>) -> Self {
        Self {
            address: Some(address),
            title: title.into(),
            allow_commands: false,
            is_live: true,
            lowest_altitude_m: LOWEST_ALTITUDE_M,
            udp: None,
            limits: Limits::default(),
        }
    }
}

/// Bodies are towed 2 to 6 m above the bottom for what is in it; below that a wave of the ship, a metre either way, and
/// the lag of the crew at the winch are all that is left.
pub(crate) const LOWEST_ALTITUDE_M: f64 = 2.0;
