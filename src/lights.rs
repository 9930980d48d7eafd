//! What the three lights on the board say, to someone who has no cable at hand.
//!
//! | light | off | steady | quick (5 Hz) | slow (once in 2 s) | double (two flashes a second) |
//! |---|---|---|---|---|---|
//! | green | no epochs | | compensates and learns | epochs come, but are rejected or the filter settles | |
//! | yellow | log switched off | epochs go to the card | no card, or it does not take them | | |
//! | red | all is well | a panic, fault or watchdog has restarted the body since power came | a sensor is missing or invalid | the crystal failed, the internal oscillator runs the body | water in the body, whatever else there is |

use crate::Status;
use crate::link::Activity;
use crate::sensors::grid::{EpochMarks, FluxMark, ScalarMark};

/// Which lights are on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lights {
    /// Compensation.
    pub green: bool,
    /// Log.
    pub yellow: bool,
    /// Trouble.
    pub red: bool,
}

/// What is wrong besides the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// Nothing.
    None,
    /// A panic, fault or watchdog has restarted the body since power came.
    Restarted,
    /// The body runs on its internal oscillator: all times are off, which concerns more than a restart that is over.
    CrystalFailed,
    /// There is water at the leak contact, which concerns more than all else.
    Leak,
}

/// The lights at an epoch of number `tick`; they change ten times a second at most.
pub fn lights(tick: u32, status: Status, marks: &EpochMarks, activity: Activity, trouble: Trouble) -> Lights {
    let quick = tick.is_multiple_of(2);
    let slow = tick % 20 < 10;
    let double = matches!(tick % 10, 0 | 2);
    let both_sensors = marks.scalar == ScalarMark::Present && marks.flux == FluxMark::Present;
    Lights {
        green: if status == Status::Used { quick } else { slow },
        yellow: if activity.log_failing { quick } else { activity.logging },
        red: match trouble {
            Trouble::Leak => double,
            _ if !both_sensors => quick,
            Trouble::None => false,
            Trouble::Restarted => true,
            Trouble::CrystalFailed => slow,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rejection::ScalarMissing;

    const WELL: EpochMarks = EpochMarks {
        instant_us: 0,
        scalar: ScalarMark::Present,
        flux: FluxMark::Present,
        duplicates: 0,
        relocked: false,
        scalar_offset_us: 0,
        raw_scalar_pt: None,
        signal: None,
        channels: [None; 2],
        current_a: None,
    };

    /// How often each light changes in 20 epochs, and whether it was ever on.
    fn watch(at: impl Fn(u32) -> Lights) -> [(u32, bool); 3] {
        let seen: [[bool; 3]; 21] =
            core::array::from_fn(|tick| at(tick as u32)).map(|Lights { green, yellow, red }| [green, yellow, red]);
        core::array::from_fn(|light| {
            let changes = seen.windows(2).filter(|pair| pair[0][light] != pair[1][light]).count();
            (changes as u32, seen.iter().any(|now| now[light]))
        })
    }

    #[test]
    fn the_lights_tell_well_from_ill() {
        let logging = Activity { logging: true, ..Activity::default() };
        let failing = Activity { log_failing: true, ..Activity::default() };
        let unplugged = EpochMarks { scalar: ScalarMark::Missing, ..WELL };
        let rejected = Status::Rejected(ScalarMissing);
        assert_eq!(
            watch(|tick| lights(tick, Status::Used, &WELL, logging, Trouble::None)),
            [(20, true), (0, true), (0, false)]
        );
        assert_eq!(
            watch(|tick| lights(tick, rejected, &unplugged, failing, Trouble::CrystalFailed)),
            [(2, true), (20, true), (20, true)]
        );
        assert_eq!(
            watch(|tick| lights(tick, Status::Settling, &WELL, Activity::default(), Trouble::Restarted))[1..],
            [(0, false), (0, true)]
        );
        assert_eq!(watch(|tick| lights(tick, Status::Used, &WELL, logging, Trouble::CrystalFailed))[2], (2, true));
        // Two flashes in each of the two seconds, and the begin of another.
        assert_eq!(watch(|tick| lights(tick, rejected, &unplugged, failing, Trouble::Leak))[2], (8, true));
    }
}
