//! The chip's own flash, where the settings lie.

use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use stm32f4xx_hal::flash::{Error, FlashExt, LockedFlash, UnlockedFlash};
use stm32f4xx_hal::pac;

/// Error flags of FLASH_SR, which a one clears: reference manual RM0090, 3.9.4. The HAL reads them and leaves them, so
/// that one failure would make every later write look like one.
const ERROR_FLAGS: u32 = 0b1111_0010;

/// The flash. Writing stalls the program for milliseconds, erasing for one to four seconds: half the watchdog's time.
pub struct SettingsFlash(LockedFlash);

impl SettingsFlash {
    pub fn new(flash: pac::FLASH) -> Self {
        Self(LockedFlash::new(flash))
    }

    fn unlocked(&mut self) -> UnlockedFlash<'_> {
        // SAFETY: the flags concern operations that have ended, and `self` is the only owner of the flash.
        #[allow(unsafe_code)]
        unsafe {
            (*pac::FLASH::ptr()).sr().write(|w| w.bits(ERROR_FLAGS));
        }
        self.0.unlocked()
    }
}

impl ErrorType for SettingsFlash {
    type Error = Error;
}

impl ReadNorFlash for SettingsFlash {
    const READ_SIZE: usize = <LockedFlash as ReadNorFlash>::READ_SIZE;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        ReadNorFlash::read(&mut self.0, offset, bytes)
    }

    fn capacity(&self) -> usize {
        ReadNorFlash::capacity(&self.0)
    }
}

impl NorFlash for SettingsFlash {
    const WRITE_SIZE: usize = <UnlockedFlash<'static> as NorFlash>::WRITE_SIZE;
    const ERASE_SIZE: usize = <UnlockedFlash<'static> as NorFlash>::ERASE_SIZE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        let erased = NorFlash::erase(&mut self.unlocked(), from, to);
        flush_data_cache();
        erased
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        NorFlash::write(&mut self.unlocked(), offset, bytes)
    }
}

/// A write changes what the cache holds as well, an erasure does not: reference manual RM0090, 3.5.4. The cache can only be
/// cleared while it is off.
fn flush_data_cache() {
    // SAFETY: three changes of a register that only the set-up of the clocks writes besides, and that has ended.
    #[allow(unsafe_code)]
    let flash = unsafe { &*pac::FLASH::ptr() };
    flash.acr().modify(|_, w| w.dcen().clear_bit());
    flash.acr().modify(|_, w| w.dcrst().set_bit());
    flash.acr().modify(|_, w| w.dcrst().clear_bit().dcen().set_bit());
}
