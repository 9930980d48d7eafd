//! The way in, which never waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use tokio::sync::mpsc::{Receiver, Sender, channel, error::TrySendError};

use crate::lamp::Lamps;
use crate::notice::{Contact, Mark};
use crate::sample::Sample;

/// Updates that may wait for the server's thread: more than six minutes of epochs, or four seconds at a hundred times
/// their speed. Half a megabyte.
const WAITING: usize = 4096;

/// Something new.
#[derive(Clone, Debug, PartialEq)]
pub enum Update {
    /// An epoch.
    Sample(Sample),
    /// How the parts of the system are.
    Lamps(Lamps),
    /// A line of text: an answer of the body, or about it.
    Text(String),
    /// A mark that was kept.
    Mark(Mark),
    /// A target that was found.
    Contact(Contact),
    /// There is no more to come.
    End,
}

/// Where updates go. When the server cannot follow they are lost, and counted; whoever records never waits.
#[derive(Clone, Debug)]
pub struct Feed {
    sender: Sender<Update>,
    lost: Arc<AtomicU64>,
}

impl Feed {
    pub(crate) fn new() -> (Self, Inflow) {
        let (sender, receiver) = channel(WAITING);
        let lost = Arc::new(AtomicU64::new(0));
        (Self { sender, lost: Arc::clone(&lost) }, Inflow { receiver, lost })
    }

    /// Give an update; returns at once, whatever the viewers do.
    pub fn send(&self, update: Update) {
        if let Err(TrySendError::Full(_)) = self.sender.try_send(update) {
            self.lost.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Updates that the server was too slow for.
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }
}

/// The server's end.
pub(crate) struct Inflow {
    pub(crate) receiver: Receiver<Update>,
    pub(crate) lost: Arc<AtomicU64>,
}
