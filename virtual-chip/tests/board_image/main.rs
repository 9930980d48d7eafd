//! The board's own image, as `cargo fw` makes it, on a virtual chip.
//!
//! Each test is a scenario that runs once, also for the test that asks which lines of the board none of them has run.
#![cfg(not(target_os = "none"))]

mod bench;
mod coverage;
mod power_up;

use std::sync::LazyLock;

/// A test, once.
type Scenario = LazyLock<()>;

/// All of them.
static SCENARIOS: [&Scenario; 1] = [&power_up::EVERYTHING_CONNECTED];
