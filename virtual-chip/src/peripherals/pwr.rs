//! Power control: the detector of the supply voltage (RM0090, 5).

const DETECTOR_ON: u32 = 1 << 4;
const IS_BELOW: u32 = 1 << 2;

/// Thresholds of the detector, millivolts (data sheet DS8626).
const THRESHOLDS_MV: [u32; 8] = [2140, 2300, 2450, 2600, 2690, 2830, 2930, 3030];

/// The registers.
pub struct Pwr {
    cr: u32,
    /// What the chip is fed with, millivolts.
    pub supply_mv: u32,
}

impl Pwr {
    /// After a reset.
    pub fn new(supply_mv: u32) -> Self {
        Self { cr: 0x4000, supply_mv }
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32) -> Option<u32> {
        let threshold_mv = THRESHOLDS_MV[(self.cr >> 5 & 7) as usize];
        let is_below = self.cr & DETECTOR_ON != 0 && self.supply_mv < threshold_mv;
        match offset {
            0x00 => Some(self.cr),
            0x04 => Some(1 << 14 | if is_below { IS_BELOW } else { 0 }),
            _ => None,
        }
    }

    /// Write a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Option<()> {
        (offset == 0).then(|| self.cr = value)
    }
}
