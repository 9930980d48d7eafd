//! What decides about the STM32F405's clocks, UARTs, watchdog and supply, as functions of counted values and register
//! contents, so that it runs on the desk. What touches the registers is in `src/board`.

mod clocks;
mod supply;
mod uart;
mod watchdog;

pub use clocks::{COUNTED_PERIODS, ClockCheck, ClockFault, ClockPlan, ON_CRYSTAL, ON_INTERNAL, judge_crystal};
pub use supply::with_brown_out_level_3;
pub use uart::{BaudError, divided_baud};
pub use watchdog::{WATCHDOG, WatchdogPeriod, watchdog_period};
