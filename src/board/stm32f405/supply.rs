//! The brown-out level: below 2.7 V the flash is too slow for 168 MHz, so the chip had better be in reset.
//!
//! An option of the chip that is programmed once, by the first start of a new chip. The chip erases the sector of its options
//! and writes it anew; should the power go in between, all options are as erased: the flash is protected from being read by
//! a probe, and the program runs all the same. `docs/body.md` says how to get out of that.

use stm32f4xx_hal::pac;
use towmag::microcontroller::with_brown_out_level_3;

/// What unlocks the options: reference manual RM0090, FLASH_OPTKEYR.
const KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

/// For PWR_CR: the detector's highest threshold, 2.9 V.
const HIGHEST: u8 = 0b111;

/// Some microseconds, which the detector wants to settle.
const SETTLING_CYCLES: u32 = 1_600;

/// Set the level to 3 if it is not, while the supply is well above it.
pub fn hold_below_2v7(flash: &pac::FLASH, power: &pac::PWR, rcc: &pac::RCC) {
    let Some(options) = with_brown_out_level_3(flash.optcr().read().bits()) else { return };
    if is_low(power, rcc) {
        return;
    }
    while flash.sr().read().bsy().bit_is_set() {}
    // SAFETY: the keys and the order are those of the reference manual; the value is what the chip has, but for the level.
    #[allow(unsafe_code)]
    unsafe {
        for key in KEYS {
            flash.optkeyr().write(|w| w.bits(key));
        }
        flash.optcr().write(|w| w.bits(options));
    }
    flash.optcr().modify(|_, w| w.optstrt().set_bit());
    // The watchdog runs.
    while flash.sr().read().bsy().bit_is_set() {}
    flash.optcr().modify(|_, w| w.optlock().set_bit());
}

/// Whether the supply is below 2.9 V.
fn is_low(power: &pac::PWR, rcc: &pac::RCC) -> bool {
    rcc.apb1enr().modify(|_, w| w.pwren().set_bit());
    power.cr().modify(|_, w| w.pls().set(HIGHEST).pvde().set_bit());
    cortex_m::asm::delay(SETTLING_CYCLES);
    let is_low = power.csr().read().pvdo().bit_is_set();
    power.cr().modify(|_, w| w.pvde().clear_bit());
    is_low
}
