//! One port of general-purpose pins (RM0090, 8).

/// What a pin is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pin {
    /// Read by the program.
    Input,
    /// Driven by the program.
    Output(bool),
    /// Of a peripheral, by this number.
    Alternate(u32),
    /// Neither.
    Analogue,
}

/// The registers of a port.
#[derive(Clone, Debug)]
pub struct Gpio {
    mode: u32,
    output_type: u32,
    speed: u32,
    pull: u32,
    output: u32,
    alternate: [u32; 2],
    /// Levels from outside.
    pub input: u16,
}

impl Gpio {
    /// After a reset: port 0 is A.
    pub fn new(port: usize) -> Self {
        let (mode, speed, pull) = match port {
            0 => (0xA800_0000, 0x0C00_0000, 0x6400_0000),
            1 => (0x0000_0280, 0x0000_00C0, 0x0000_0100),
            _ => (0, 0, 0),
        };
        Self { mode, output_type: 0, speed, pull, output: 0, alternate: [0; 2], input: 0xFFFF }
    }

    /// What a pin is for.
    pub fn pin(&self, pin: u32) -> Pin {
        match self.mode >> (2 * pin) & 0b11 {
            0 => Pin::Input,
            1 => Pin::Output(self.output >> pin & 1 == 1),
            2 => Pin::Alternate(self.alternate[pin as usize / 8] >> (4 * (pin % 8)) & 0xF),
            _ => Pin::Analogue,
        }
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32) -> Option<u32> {
        Some(match offset {
            0x00 => self.mode,
            0x04 => self.output_type,
            0x08 => self.speed,
            0x0C => self.pull,
            0x10 => self.levels(),
            0x14 => self.output,
            0x20 => self.alternate[0],
            0x24 => self.alternate[1],
            _ => return None,
        })
    }

    /// Write a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Option<()> {
        match offset {
            0x00 => self.mode = value,
            0x04 => self.output_type = value,
            0x08 => self.speed = value,
            0x0C => self.pull = value,
            0x14 => self.output = value & 0xFFFF,
            0x18 => self.output = self.output & !(value >> 16) | value & 0xFFFF,
            0x20 => self.alternate[0] = value,
            0x24 => self.alternate[1] = value,
            _ => return None,
        }
        Some(())
    }

    fn levels(&self) -> u32 {
        (0..16)
            .map(|pin| match self.pin(pin) {
                Pin::Output(level) => u32::from(level) << pin,
                Pin::Analogue => 0,
                _ => u32::from(self.input) & 1 << pin,
            })
            .sum()
    }
}
