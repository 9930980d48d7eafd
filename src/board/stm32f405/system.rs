//! The chip of this board, as far as others with the same differ from it.

use crate::board::chip::{retained_ram, system};
use crc::{Digest, Table};
use stm32f4xx_hal::signature::Uid;
use towmag::hardware::Stamp;

/// Start the microcontroller anew.
pub fn restart() -> ! {
    // A reset leaves the memory alone.
    retained_ram::end(|_| ());
    cortex_m::peripheral::SCB::sys_reset()
}

/// The chip.
pub type System = system::System<Real>;

/// A real one.
pub struct Real;

impl system::Particulars for Real {
    fn note(_: Stamp, _: u32) {}

    fn add_unique_number(digest: &mut Digest<'static, u32, Table<1>>) {
        let uid = Uid::get();
        digest.update(&[uid.waf_num()]);
        digest.update(&uid.x().to_le_bytes());
        digest.update(&uid.y().to_le_bytes());
    }

    fn restart() -> ! {
        restart()
    }

    fn ticks_of_known_loop() -> u32 {
        0
    }
}
