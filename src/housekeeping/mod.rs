//! How the body itself is: water at the leak contact, and the battery's voltage. For log, cable and lights; the core never
//! sees them.
//!
//! ```text
//! leak contact, divider of the battery -> HousekeepingSample, at every epoch
//!                                      -> Housekeeper -> Housekeeping, once a second -> event of the log; every 5 s a frame of the cable
//!                                                     -> Alarm, when one comes or goes -> notice in the log, text on the cable
//! ```

mod alarm;
mod battery;
mod housekeeper;
mod leak;
mod settings;
mod values;

pub use alarm::{Alarm, LONGEST_ALARM};
pub use housekeeper::{Housekeeper, HousekeepingNews, HousekeepingSample};
pub use settings::HousekeepingSettings;
pub use values::Housekeeping;
