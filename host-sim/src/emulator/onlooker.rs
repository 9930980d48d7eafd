//! Somebody who looks on while the body is emulated.

use std::io::Write;
use std::os::unix::net::UnixStream;
use std::sync::Arc;

/// Somebody who looks on: sees what comes up the cable when it comes, and wants it at a speed that people can follow.
#[derive(Clone, Debug)]
pub struct Onlooker {
    cable: Arc<UnixStream>,
    /// So many times as fast as the recording was.
    pub(super) speed: f64,
}

impl Onlooker {
    /// One who reads the other end of this socket.
    pub fn new(cable: UnixStream, speed: f64) -> Self {
        Self { cable: Arc::new(cable), speed }
    }

    /// These bytes came up the cable. One who has gone sees them no more.
    pub(super) fn see(&self, bytes: &[u8]) {
        _ = (&*self.cable).write_all(bytes);
    }
}
