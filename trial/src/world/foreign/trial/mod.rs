//! Mechanisms that judge a diagnosis. Whoever tunes one does not look at what they do to it.

mod clock;
mod electronics;
mod loose;
mod memory;
mod ship;

use super::mechanism::Mechanism;

pub(super) fn all() -> impl Iterator<Item = &'static Mechanism> {
    memory::ALL.iter().chain(&loose::ALL).chain(&electronics::ALL).chain(&clock::ALL).chain(&ship::ALL)
}
