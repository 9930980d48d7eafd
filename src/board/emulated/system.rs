//! The emulated chip, as far as it differs from a real one.

use super::cost;
use super::host;
use super::protocol;
use super::storage::save_retained;
use crate::board::chip::{retained_ram, system};
use crc::{Digest, Table};
use towmag::hardware::Stamp;

/// Where a board would reset its chip: leave its memory to the next life, and end. The host starts the emulator again.
pub fn restart() -> ! {
    retained_ram::end(save_retained);
    protocol::say_farewell();
    host::exit()
}

/// The chip.
pub type System = system::System<Emulated>;

/// An emulated one.
pub struct Emulated;

impl system::Particulars for Emulated {
    fn note(stamp: Stamp, stamp_us: u32) {
        protocol::note(stamp, stamp_us);
    }

    /// Reading it is a bus fault.
    fn add_unique_number(_: &mut Digest<'static, u32, Table<1>>) {}

    fn restart() -> ! {
        restart()
    }

    fn ticks_of_known_loop() -> u32 {
        cost::ticks_of_known_loop()
    }
}
