//! Which exceptions wait, which run, and which goes first (ARMv7-M, B1.5 and B3.4).

/// Numbers of the exceptions before the interrupts.
pub const NMI: u32 = 2;
/// Hard fault.
pub const HARD_FAULT: u32 = 3;
/// The first interrupt.
const FIRST_INTERRUPT: u32 = 16;

/// Interrupts of the chip.
const INTERRUPTS: usize = 96;

/// What the program runs at when no exception does.
const THREAD_PRIORITY: i32 = 256;

/// Masks that the processor holds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Masks {
    /// No exception that can be masked.
    pub primask: bool,
    /// None with this priority or a lower one, unless 0.
    pub basepri: u8,
}

/// The controller.
#[derive(Clone, Debug)]
pub struct Nvic {
    enabled: [u32; 3],
    pending: [u32; 3],
    lines: [u32; 3],
    priorities: [u8; INTERRUPTS],
    nmi_pending: bool,
    active: Vec<u32>,
}

impl Default for Nvic {
    fn default() -> Self {
        Self {
            enabled: [0; 3],
            pending: [0; 3],
            lines: [0; 3],
            priorities: [0; INTERRUPTS],
            nmi_pending: false,
            active: Vec::new(),
        }
    }
}

impl Nvic {
    /// Level of an interrupt's line. It waits from a rising edge on.
    pub fn set_line(&mut self, interrupt: u32, level: bool) {
        let (word, bit) = (interrupt as usize / 32, 1 << (interrupt % 32));
        if level && self.lines[word] & bit == 0 {
            self.pending[word] |= bit;
        }
        self.lines[word] = if level { self.lines[word] | bit } else { self.lines[word] & !bit };
    }

    /// An interrupt of which the program knows nothing: a bit of the controller has flipped.
    pub fn pend_enabled(&mut self, interrupt: u32) {
        let (word, bit) = (interrupt as usize / 32, 1 << (interrupt % 32));
        self.enabled[word] |= bit;
        self.pending[word] |= bit;
    }

    /// The exception that nothing masks.
    pub fn set_nmi(&mut self, level: bool) {
        let is_running = self.active.contains(&NMI);
        self.nmi_pending = level && !is_running;
    }

    /// Whether anything waits that could go before what runs.
    pub fn has_candidate(&self) -> bool {
        self.nmi_pending || self.pending.iter().zip(self.enabled).any(|(pending, enabled)| pending & enabled != 0)
    }

    /// What goes now before what runs.
    pub fn next(&self, masks: Masks) -> Option<u32> {
        let running = self.running_priority();
        if self.nmi_pending && running > -2 {
            return Some(NMI);
        }
        if masks.primask {
            return None;
        }
        let (priority, interrupt) = self.first()?;
        let is_masked = masks.basepri != 0 && priority >= masks.basepri;
        (!is_masked && i32::from(priority) < running).then_some(FIRST_INTERRUPT + interrupt)
    }

    /// An exception begins.
    pub fn enter(&mut self, exception: u32) {
        self.active.push(exception);
        if exception == NMI {
            self.nmi_pending = false;
        }
        if let Some(interrupt) = exception.checked_sub(FIRST_INTERRUPT) {
            self.pending[interrupt as usize / 32] &= !(1 << (interrupt % 32));
        }
    }

    /// The latest exception ends. Its interrupt waits again if its line is still high.
    pub fn leave(&mut self) {
        if let Some(interrupt) = self.active.pop().and_then(|exception| exception.checked_sub(FIRST_INTERRUPT)) {
            let (word, bit) = (interrupt as usize / 32, 1 << (interrupt % 32));
            self.pending[word] |= self.lines[word] & bit;
        }
    }

    /// The exception that runs; 0 is none.
    pub fn running(&self) -> u32 {
        self.active.last().copied().unwrap_or(0)
    }

    /// Whether a fault now has nowhere to go.
    pub fn is_in_fault(&self) -> bool {
        self.running_priority() < 0
    }

    /// Read a register, counted from 0xE000E000.
    pub fn read(&self, offset: u32) -> Option<u32> {
        let word = (offset as usize & 0x7F) / 4;
        match offset {
            0x100..=0x108 | 0x180..=0x188 => Some(self.enabled[word % 32]),
            0x200..=0x208 | 0x280..=0x288 => Some(self.pending[word % 32]),
            0x400..=0x45C => {
                let at = (offset - 0x400) as usize;
                Some(u32::from_le_bytes([0, 1, 2, 3].map(|i| self.priorities[at + i])))
            }
            _ => None,
        }
    }

    /// Write a register, counted from 0xE000E000; priorities are written by bytes.
    pub fn write(&mut self, offset: u32, value: u32, size: usize) -> Option<()> {
        let word = (offset as usize & 0x7F) / 4;
        match offset {
            0x100..=0x108 => self.enabled[word] |= value,
            0x180..=0x188 => self.enabled[word] &= !value,
            0x200..=0x208 => self.pending[word] |= value,
            0x280..=0x288 => self.pending[word] &= !value,
            0x400..=0x45F => {
                let at = (offset - 0x400) as usize;
                for (priority, byte) in self.priorities[at..].iter_mut().zip(value.to_le_bytes()).take(size) {
                    *priority = byte & 0xF0;
                }
            }
            _ => return None,
        }
        Some(())
    }

    /// Priority and number of the interrupt that goes first among those that wait.
    fn first(&self) -> Option<(u8, u32)> {
        let mut first = None;
        for (word, (pending, enabled)) in (0_u32..).zip(self.pending.iter().zip(self.enabled)) {
            let mut waiting = pending & enabled;
            while waiting != 0 {
                let interrupt = 32 * word + waiting.trailing_zeros();
                let entry = (self.priorities[interrupt as usize], interrupt);
                first = Some(first.map_or(entry, |best: (u8, u32)| best.min(entry)));
                waiting &= waiting - 1;
            }
        }
        first
    }

    fn running_priority(&self) -> i32 {
        let priority = |exception: &u32| match *exception {
            NMI => -2,
            HARD_FAULT => -1,
            exception => i32::from(self.priorities[(exception - FIRST_INTERRUPT) as usize]),
        };
        self.active.iter().map(priority).min().unwrap_or(THREAD_PRIORITY)
    }
}
