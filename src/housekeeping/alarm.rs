//! What people must know at once.

use core::fmt;

/// Longest text of an alarm, bytes: a notice with it finds room in the queue of the log's records.
pub const LONGEST_ALARM: usize = 45;

/// Something that has begun, lasts, or is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alarm {
    /// The leak contact has become wet.
    Leak,
    /// It is still wet.
    StillLeak {
        /// For how long.
        minutes: u32,
    },
    /// It is dry again.
    LeakOver,
    /// The battery has become low.
    BatteryLow {
        /// Its voltage, V.
        battery_v: f32,
    },
    /// It is low no longer.
    BatteryWell {
        /// Its voltage, V.
        battery_v: f32,
    },
}

impl Alarm {
    /// Whether it goes into the log: what has changed, not what lasts.
    pub fn is_change(&self) -> bool {
        !matches!(self, Self::StillLeak { .. })
    }
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The formatting of a second type would be a kilobyte.
        let volts = |battery_v: &f32| f64::from(*battery_v);
        match self {
            Self::Leak => f.write_str("LEAK: water at the contact"),
            Self::StillLeak { minutes } => write!(f, "LEAK: water at the contact for {minutes} min"),
            Self::LeakOver => f.write_str("leak over: the contact is dry"),
            Self::BatteryLow { battery_v } => write!(f, "BATTERY LOW: {:.2} V", volts(battery_v)),
            Self::BatteryWell { battery_v } => write!(f, "battery no longer low: {:.2} V", volts(battery_v)),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::string::ToString;

    #[test]
    fn the_longest_text_is_as_long_as_is_said() {
        let battery_v = 65_535.0 * 0.1;
        let all = [
            Alarm::Leak,
            Alarm::StillLeak { minutes: u32::MAX },
            Alarm::LeakOver,
            Alarm::BatteryLow { battery_v },
            Alarm::BatteryWell { battery_v },
        ];
        assert_eq!(all.iter().map(|alarm| alarm.to_string().len()).max(), Some(LONGEST_ALARM));
    }
}
