//! The level below which the chip is held in reset.

/// Bits of FLASH_OPTCR (reference manual RM0090) that hold the brown-out level; both zero is level 3, 2.7 V.
const BROWN_OUT_BITS: u32 = 0b1100;

/// The two bits that start a programming and lock the register: never a part of what is written.
const COMMAND_BITS: u32 = 0b11;

/// What to write to FLASH_OPTCR so that the brown-out level is 3; `None` when it is. All other options stay, the
/// read-out protection above all: lowering that erases the flash.
pub fn with_brown_out_level_3(options: u32) -> Option<u32> {
    (options & BROWN_OUT_BITS != 0).then_some(options & !(BROWN_OUT_BITS | COMMAND_BITS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_level_changes_and_only_once() {
        // As the chip is delivered: no level, no protection, locked.
        let delivered = 0x0FFF_AAED;
        let wanted = with_brown_out_level_3(delivered).unwrap();
        assert_eq!(wanted, 0x0FFF_AAE0);
        assert_eq!(with_brown_out_level_3(wanted | 1), None);
        for level in [0b0100, 0b1000, 0b1100] {
            assert_eq!(with_brown_out_level_3(0x0FFF_55E0 | level), Some(0x0FFF_55E0));
        }
    }
}
