//! Interrupts by pins, and which port each comes from (RM0090, 9 and 12).

/// The registers of both EXTI and SYSCFG.
#[derive(Clone, Debug, Default)]
pub struct Exti {
    mask: u32,
    event_mask: u32,
    rising: u32,
    falling: u32,
    pending: u32,
    ports: [u32; 4],
    memory_remap: u32,
}

impl Exti {
    /// A pin of a port changes its level.
    pub fn edge(&mut self, port: u32, pin: u32, rises: bool) {
        let is_source = self.ports[pin as usize / 4] >> (4 * (pin % 4)) & 0xF == port;
        let edges = if rises { self.rising } else { self.falling };
        if is_source {
            self.pending |= edges & 1 << pin;
        }
    }

    /// Lines whose interrupt is wanted and pending.
    pub fn lines(&self) -> u32 {
        self.pending & self.mask
    }

    /// Read a register of EXTI.
    pub fn read(&mut self, offset: u32) -> Option<u32> {
        Some(match offset {
            0x00 => self.mask,
            0x04 => self.event_mask,
            0x08 => self.rising,
            0x0C => self.falling,
            0x10 => 0,
            0x14 => self.pending,
            _ => return None,
        })
    }

    /// Write a register of EXTI.
    pub fn write(&mut self, offset: u32, value: u32) -> Option<()> {
        match offset {
            0x00 => self.mask = value,
            0x04 => self.event_mask = value,
            0x08 => self.rising = value,
            0x0C => self.falling = value,
            0x10 => self.pending |= value & self.mask,
            0x14 => self.pending &= !value,
            _ => return None,
        }
        Some(())
    }

    /// Read a register of SYSCFG.
    pub fn read_configuration(&mut self, offset: u32) -> Option<u32> {
        match offset {
            0x00 => Some(self.memory_remap),
            0x08..=0x14 => Some(self.ports[(offset as usize - 8) / 4]),
            _ => None,
        }
    }

    /// Write a register of SYSCFG.
    pub fn write_configuration(&mut self, offset: u32, value: u32) -> Option<()> {
        match offset {
            0x00 => self.memory_remap = value,
            0x08..=0x14 => self.ports[(offset as usize - 8) / 4] = value,
            _ => return None,
        }
        Some(())
    }
}
