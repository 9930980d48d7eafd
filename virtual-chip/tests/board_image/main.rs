//! The board's own image, as `cargo fw` makes it, on a virtual chip.
//!
//! Each test is a scenario that runs once, also for the test that asks which lines of the board none of them has run.
#![cfg(not(target_os = "none"))]

mod absent;
mod bench;
mod coverage;
mod crystal;
mod housekeeping;
mod navigation;
mod power_up;
mod restarts;
mod settings;

use std::sync::LazyLock;

/// What a test does, once.
type Scenario = LazyLock<()>;

/// All of them.
static SCENARIOS: [&Scenario; 25] = [
    &power_up::EVERYTHING,
    &power_up::FIRST_START,
    &power_up::LOW_SUPPLY,
    &absent::NO_CARD,
    &absent::NO_CONVERTER,
    &absent::NOTHING,
    &absent::CARD_LATER,
    &absent::BAD_WIRES,
    &crystal::GOOD,
    &crystal::DEAD,
    &crystal::WRONG,
    &crystal::DIES,
    &crystal::NO_LOW_SPEED,
    &settings::KEPT,
    &settings::CUT_WHILE_PROGRAMMING,
    &settings::CUT_WHILE_ERASING,
    &restarts::HANGS,
    &restarts::FAULTS,
    &restarts::PANICS,
    &restarts::NO_HANDLER,
    &navigation::SENTENCES,
    &navigation::PULSE,
    &navigation::OVERRUN,
    &housekeeping::LEAK_AND_BATTERY,
    &housekeeping::SELF_TEST,
];
