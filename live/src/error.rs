//! Why there is no page.

use std::io;
use std::net::SocketAddr;

/// Why there is no page. Its display is one line: what, where, what to do.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// The address cannot be listened on.
    #[error("--serve {address}: {source}: is another program there? Name another port")]
    Address {
        /// As it was asked for.
        address: SocketAddr,
        /// The system's own words.
        source: io::Error,
    },
    /// Where UDP should go to is no place.
    #[error("--udp {target}: {source}")]
    Udp {
        /// As it was asked for.
        target: String,
        /// The system's own words.
        source: io::Error,
    },
    /// A thread, a timer or a random number is not to be had.
    #[error("the page cannot be served: {0}")]
    System(#[from] io::Error),
}

impl LiveError {
    /// Whether another word on the command line would do.
    pub fn is_bad_usage(&self) -> bool {
        !matches!(self, Self::System(_))
    }
}
