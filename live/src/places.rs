//! How many may be connected at a time.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How many may connect, and how long they may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Connections from this machine.
    pub local: usize,
    /// From all other machines together: none of them takes a place of this one.
    pub remote: usize,
    /// From one other address: a browser opens six at most.
    pub per_address: usize,
    /// How long a request may take to come.
    pub request: Duration,
    /// How long a viewer may take to accept a message, and how long it may be silent.
    pub patience: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            local: 32,
            remote: 32,
            per_address: 8,
            request: Duration::from_secs(5),
            patience: Duration::from_secs(20),
        }
    }
}

/// The connections that there are.
#[derive(Debug)]
pub(crate) struct Places {
    limits: Limits,
    taken: Mutex<HashMap<Whose, usize>>,
}

/// Who has connections: this machine, or another by its address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Whose {
    Local,
    Remote(IpAddr),
}

/// One connection's place, until it is dropped.
#[derive(Debug)]
pub(crate) struct Place {
    places: Arc<Places>,
    whose: Whose,
}

impl Places {
    pub(crate) fn new(limits: Limits) -> Arc<Self> {
        Arc::new(Self { limits, taken: Mutex::default() })
    }

    pub(crate) fn limits(&self) -> Limits {
        self.limits
    }

    /// A place for a connection from this address, if there is one.
    pub(crate) fn take(self: &Arc<Self>, address: IpAddr) -> Option<Place> {
        let address = address.to_canonical();
        let whose = if address.is_loopback() { Whose::Local } else { Whose::Remote(address) };
        let mut taken = self.taken();
        let own = taken.get(&whose).copied().unwrap_or(0);
        let all_remote =
            || taken.iter().filter(|(whose, _)| **whose != Whose::Local).map(|(_, count)| count).sum::<usize>();
        let is_free = match whose {
            Whose::Local => own < self.limits.local,
            Whose::Remote(_) => own < self.limits.per_address && all_remote() < self.limits.remote,
        };
        if !is_free {
            return None;
        }
        *taken.entry(whose).or_default() += 1;
        Some(Place { places: Arc::clone(self), whose })
    }

    fn taken(&self) -> MutexGuard<'_, HashMap<Whose, usize>> {
        self.taken.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut taken = self.places.taken();
        let count = taken.entry(self.whose).or_default();
        *count = count.saturating_sub(1);
        if *count == 0 {
            taken.remove(&self.whose);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn others_never_take_the_places_of_this_machine() {
        let places = Places::new(Limits { local: 2, remote: 5, per_address: 3, ..Limits::default() });
        let address = |last: u8| IpAddr::from([192, 168, 1, last]);
        let take = |address, count| (0..count).filter_map(|_| places.take(address)).collect::<Vec<_>>();
        let first = take(address(1), 10);
        let second = take(address(2), 10);
        assert_eq!((first.len(), second.len()), (3, 2));
        let own = take("::ffff:127.0.0.1".parse().unwrap(), 10);
        assert_eq!((own.len(), take("127.0.0.1".parse().unwrap(), 1).len()), (2, 0));
        drop((first, own));
        assert_eq!((take(address(3), 10).len(), take("::1".parse().unwrap(), 10).len()), (3, 2));
        drop(second);
        assert!(places.taken().is_empty());
    }
}
