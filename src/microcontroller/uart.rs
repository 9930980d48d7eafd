//! Which baud rates a UART can make.

use core::fmt;

/// How far a rate may be off, per mille: a receiver that samples the middle of the tenth bit stands some 4 % in all, and
/// the other end wants its share.
const TOLERANCE_PERMILLE: u64 = 20;

/// Why a UART cannot make a rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BaudError {
    /// The divisor has more than the 16 bits of its register, which the driver cuts off silently.
    TooSlow,
    /// Above an eighth of the clock.
    TooFast,
    /// No divisor comes near enough; the nearest makes this rate.
    Coarse(u32),
}

impl fmt::Display for BaudError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooSlow => f.write_str("slower than the UART's clock can be divided"),
            Self::TooFast => f.write_str("faster than the UART's clock allows"),
            Self::Coarse(baud) => write!(f, "the nearest that the UART can make is {baud}"),
        }
    }
}

impl core::error::Error for BaudError {}

/// The rate that a UART with a clock of `clock_hz` makes of `baud`, by the divisor that stm32f4xx-hal 0.23 computes
/// (`calculate_brr`): with 16 samples a bit where they fit, else with 8.
pub fn divided_baud(clock_hz: u32, baud: u32) -> Result<u32, BaudError> {
    let (clock, wanted) = (u64::from(clock_hz), u64::from(baud));
    if clock / 8 < wanted {
        return Err(BaudError::TooFast);
    }
    let ticks = if clock / 16 >= wanted { clock } else { 2 * clock };
    let divisor = (ticks + wanted / 2).checked_div(wanted).ok_or(BaudError::TooSlow)?;
    // With 8 samples the fraction has a bit less.
    let divisor = if ticks == clock { divisor } else { divisor & !1 };
    if divisor > u64::from(u16::MAX) {
        return Err(BaudError::TooSlow);
    }
    let made = ticks / divisor.max(1);
    match u32::try_from(made) {
        Ok(made) if 1_000 * u64::from(made).abs_diff(wanted) <= TOLERANCE_PERMILLE * wanted => Ok(made),
        _ => Err(BaudError::Coarse(u32::try_from(made).unwrap_or(u32::MAX))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microcontroller::{ClockPlan, ON_CRYSTAL, ON_INTERNAL};
    use crate::store::{CABLE_BAUDS, SCALAR_BAUD};

    #[test]
    fn every_rate_that_can_be_set_can_be_made_on_both_clocks() {
        for ClockPlan { bus_1_mhz, bus_2_mhz, .. } in [ON_CRYSTAL, ON_INTERNAL] {
            let scalar = SCALAR_BAUD.map(|baud| (bus_2_mhz, baud));
            let cable = CABLE_BAUDS.map(|baud| (bus_1_mhz, baud));
            for (mhz, baud) in scalar.chain(cable) {
                assert!(divided_baud(mhz * 1_000_000, baud).is_ok(), "{baud} baud at {mhz} MHz");
            }
        }
    }

    #[test]
    fn what_would_be_cut_or_is_too_coarse_is_refused() {
        assert_eq!(divided_baud(84_000_000, 1_200), Err(BaudError::TooSlow));
        assert_eq!(divided_baud(84_000_000, 0), Err(BaudError::TooSlow));
        assert_eq!(divided_baud(0, 0), Err(BaudError::TooSlow));
        assert_eq!(divided_baud(42_000_000, 5_250_001), Err(BaudError::TooFast));
        // 21 half ticks, of which one is no step.
        assert_eq!(divided_baud(42_000_000, 4_000_000), Err(BaudError::Coarse(4_200_000)));
        assert_eq!(divided_baud(84_000_000, 9_600), Ok(9_600));
        assert_eq!(divided_baud(42_000_000, 921_600), Ok(913_043));
    }
}
