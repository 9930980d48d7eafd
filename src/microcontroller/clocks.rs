//! Which oscillator the body runs from.
//!
//! The crystal is trusted only after it was compared with the internal oscillator of 16 MHz. That one is within 1 % at
//! 25 degrees, and within -8 to +4.5 % over all temperatures of the chip (data sheet DS8626), which is enough to tell
//! 8 MHz from every other usual crystal but its neighbours 7.3728 and 8.192 MHz.

use core::fmt;

/// The internal oscillator, Hz.
const INTERNAL_HZ: u64 = 16_000_000;

/// What the crystal shall be, Hz.
const CRYSTAL_HZ: u32 = 8_000_000;

/// How far the crystal may seem to be off, parts of ten: the internal oscillator at its worst makes 8 MHz seem 7.66 to
/// 8.70 MHz, and 10 MHz no less than 9.57 MHz.
const TENTHS: u32 = 1;

/// Frequencies of a clock tree, MHz.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockPlan {
    /// Core.
    pub core_mhz: u32,
    /// First peripheral bus: the tow cable's USART2; the timers on it run at twice that.
    pub bus_1_mhz: u32,
    /// Second peripheral bus: the scalar sensor's USART1.
    pub bus_2_mhz: u32,
}

/// With the crystal: as fast as the chip may run.
pub const ON_CRYSTAL: ClockPlan = ClockPlan { core_mhz: 168, bus_1_mhz: 42, bus_2_mhz: 84 };

/// Without: so much slower that nothing is overclocked with the internal oscillator 4.5 % fast.
pub const ON_INTERNAL: ClockPlan = ClockPlan { core_mhz: 160, bus_1_mhz: 40, bus_2_mhz: 80 };

/// What the start has found out about the oscillators, by the internal one of 16 MHz.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClockCheck {
    /// Why the crystal does not run the body, if it does not.
    pub fault: Option<ClockFault>,
    /// Frequency of the crystal, kHz; 0 where it was not measured.
    pub crystal_khz: u32,
    /// Frequency of the low-speed oscillator, Hz; 0 where it was not measured.
    pub low_speed_hz: u32,
}

/// Why the body does not run from its crystal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClockFault {
    /// It did not start in time.
    DoesNotStart,
    /// Its frequency is another.
    WrongFrequency {
        /// What it is, by the internal oscillator.
        khz: u32,
    },
    /// The low-speed oscillator, which both are timed with, gave no edges, or the switch-over never ended.
    NotMeasured,
    /// It stopped while the body ran from it, since power came.
    Stopped,
}

impl ClockFault {
    /// What is wrong, without what follows from it.
    pub fn put_reason(&self, f: &mut impl fmt::Write) -> fmt::Result {
        match self {
            Self::DoesNotStart => f.write_str("the crystal does not start"),
            Self::WrongFrequency { khz } => write!(f, "the crystal has {khz} kHz instead of 8000"),
            Self::NotMeasured => f.write_str("the crystal could not be measured"),
            Self::Stopped => f.write_str("the crystal stopped"),
        }
    }
}

impl fmt::Display for ClockFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.put_reason(f)?;
        f.write_str("; on the internal oscillator: times and rates are off by up to some per cent")
    }
}

impl core::error::Error for ClockFault {}

/// Periods of the low-speed oscillator that are counted over.
pub const COUNTED_PERIODS: u32 = 64;

/// Whether a crystal may be used, and what its frequency is: ticks of the internal oscillator, and of the crystal, in
/// [`COUNTED_PERIODS`] of the low-speed one, one after the other. How fast that one is does not matter.
pub fn judge_crystal(internal_ticks: u32, crystal_ticks: u32) -> ClockCheck {
    let measured = |numerator: u64| {
        let hz = (INTERNAL_HZ * numerator).checked_div(u64::from(internal_ticks))?;
        Some(u32::try_from(hz).unwrap_or(u32::MAX))
    };
    let (Some(crystal_hz), Some(low_speed_hz)) = (measured(crystal_ticks.into()), measured(COUNTED_PERIODS.into()))
    else {
        return ClockCheck { fault: Some(ClockFault::NotMeasured), ..ClockCheck::default() };
    };
    let khz = crystal_hz / 1_000;
    let is_off = crystal_hz.abs_diff(CRYSTAL_HZ) > CRYSTAL_HZ * TENTHS / 10;
    let fault = is_off.then_some(ClockFault::WrongFrequency { khz });
    ClockCheck { fault, crystal_khz: khz, low_speed_hz }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(crystal_hz: f64, internal_hz: f64, low_speed_hz: f64) -> ClockCheck {
        let ticks = |hz: f64| (hz * f64::from(COUNTED_PERIODS) / low_speed_hz) as u32;
        judge_crystal(ticks(internal_hz), ticks(crystal_hz))
    }

    /// Over the data sheet's ranges of both internal oscillators.
    fn corners(mut check: impl FnMut(f64, f64)) {
        for low_speed_hz in [17e3, 32e3, 47e3] {
            for off in [-0.08, -0.04, -0.01, 0.0, 0.01, 0.04, 0.045] {
                check(16e6 * (1.0 + off), low_speed_hz);
            }
        }
    }

    #[test]
    fn eight_megahertz_pass_and_others_do_not_whatever_the_internal_oscillators_are() {
        corners(|internal, low| {
            let good = judged(8e6, internal, low);
            assert_eq!(good.fault, None);
            assert!((f64::from(good.low_speed_hz) - low * 16e6 / internal).abs() < 2.0, "{low}: {good:?}");
            for other in [4e6, 6e6, 10e6, 12e6, 16e6, 20e6, 25e6, 26e6] {
                let told = judged(other, internal, low).fault;
                assert!(
                    matches!(told, Some(ClockFault::WrongFrequency { .. })),
                    "{other} Hz at {internal} Hz: {told:?}"
                );
            }
        });
    }

    #[test]
    fn the_frequency_is_told() {
        let fault = |internal, crystal| judge_crystal(internal, crystal).fault;
        assert_eq!(fault(32_000, 24_000), Some(ClockFault::WrongFrequency { khz: 12_000 }));
        assert_eq!(judge_crystal(32_000, 16_100), ClockCheck { fault: None, crystal_khz: 8_050, low_speed_hz: 32_000 });
        assert_eq!(fault(0, 24_000), Some(ClockFault::NotMeasured));
        assert_eq!(fault(1, u32::MAX), Some(ClockFault::WrongFrequency { khz: u32::MAX / 1_000 }));
    }

    #[test]
    fn nothing_is_overclocked_on_a_fast_internal_oscillator() {
        let at_worst = |mhz: u32| f64::from(mhz) * 1.045;
        assert!(at_worst(ON_INTERNAL.core_mhz) <= 168.0);
        assert!(at_worst(ON_INTERNAL.bus_1_mhz) <= 42.0);
        assert!(at_worst(ON_INTERNAL.bus_2_mhz) <= 84.0);
    }
}
