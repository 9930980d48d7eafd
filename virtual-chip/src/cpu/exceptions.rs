//! Entry to exceptions and return from them: Unicorn runs the code in between, and knows nothing of either (ARMv7-M, B1.5).
//!
//! The floating-point registers are put on the stack at once, where the chip leaves room for them and puts them there when
//! they are used: it makes no difference but in time.

use super::Cpu;
use unicorn_engine::RegisterARM as Register;

/// First of the frame, in this order; then the return address and the state.
const FRAME: [Register; 6] = [Register::R0, Register::R1, Register::R2, Register::R3, Register::R12, Register::LR];

/// Single registers of the floating-point unit that are part of a frame, and the first of them.
const FLOATS: u32 = 16;
const FIRST_FLOAT: i32 = Register::S0 as i32;

/// Words of a frame without and with them: with them there is also the status, and one that nobody uses.
const BASIC_WORDS: u32 = 8;
const FLOAT_WORDS: u32 = FLOATS + 2;

/// In the stacked state: the frame was moved by a word, to lie at a multiple of eight.
const WAS_MOVED: u32 = 1 << 9;

/// Bit of CONTROL: the floating-point unit is in use.
const USES_FLOATS: u32 = 1 << 2;

/// Parts of the state that an exception begins with none of, flags but no number; and Thumb code.
const FLAGS: u32 = 0xF80F_0000;
const THUMB: u32 = 1 << 24;

/// Return to code that used no floats; the bit says so.
const NO_FLOATS: u32 = 1 << 4;
const RETURN_TO_HANDLER: u32 = 0xFFFF_FFE1;
const RETURN_TO_THREAD: u32 = 0xFFFF_FFE9;

/// Cycles of either.
const CYCLES: u64 = 12;

impl Cpu {
    /// Begin an exception. False when the stack does not take its frame.
    pub(super) fn enter(&mut self, number: u32) -> bool {
        let engine = &mut self.engine;
        let state = engine.get(Register::XPSR);
        let uses_floats = engine.get(Register::CONTROL) & USES_FLOATS != 0;
        let words = BASIC_WORDS + if uses_floats { FLOAT_WORDS } else { 0 };
        let stack = engine.get(Register::SP);
        let frame = stack.wrapping_sub(4 * words) & !7;
        let was_moved = if stack & 4 != 0 { WAS_MOVED } else { 0 };
        if self.push(frame, state | was_moved, uses_floats).is_none() {
            return false;
        }
        let from_handler = self.machine().bus.core.nvic.running() != 0;
        let to = if from_handler { RETURN_TO_HANDLER } else { RETURN_TO_THREAD };
        let vector = self.vectors() + 4 * number;
        let engine = &mut self.engine;
        engine.set(Register::SP, frame);
        engine.set(Register::LR, if uses_floats { to } else { to | NO_FLOATS });
        engine.set(Register::CONTROL, 0);
        engine.set(Register::XPSR_NZCVQG, state & FLAGS | THUMB | number);
        let handler = engine.word(vector).unwrap_or(0);
        engine.jump(handler);
        self.machine_mut().bus.core.nvic.enter(number);
        self.machine_mut().pass(CYCLES);
        true
    }

    /// End the exception that runs: the program counter holds what it returns to.
    pub(super) fn leave(&mut self) {
        let engine = &mut self.engine;
        let to = engine.get(Register::PC);
        let uses_floats = to & NO_FLOATS == 0;
        let frame = engine.get(Register::SP);
        let state = self.pop(frame, uses_floats);
        let words = BASIC_WORDS + if uses_floats { FLOAT_WORDS } else { 0 };
        let was_moved = if state & WAS_MOVED != 0 { 4 } else { 0 };
        let engine = &mut self.engine;
        let address = engine.word(frame + 4 * 6).unwrap_or(0);
        engine.set(Register::XPSR_NZCVQG, state & !WAS_MOVED);
        engine.set(Register::CONTROL, if uses_floats { USES_FLOATS } else { 0 });
        engine.set(Register::FAULTMASK, 0);
        engine.set(Register::SP, frame + 4 * words + was_moved);
        engine.jump(address);
        self.machine_mut().bus.core.nvic.leave();
        self.machine_mut().pass(CYCLES);
    }

    fn push(&mut self, frame: u32, state: u32, uses_floats: bool) -> Option<()> {
        let engine = &mut self.engine;
        for (at, register) in (frame..).step_by(4).zip(FRAME) {
            let value = engine.get(register);
            engine.set_word(at, value)?;
        }
        let address = engine.get(Register::PC);
        engine.set_word(frame + 24, address)?;
        engine.set_word(frame + 28, state)?;
        if uses_floats {
            for float in 0..FLOATS {
                let value = engine.get_float(FIRST_FLOAT + float as i32);
                engine.set_word(frame + 32 + 4 * float, value)?;
            }
            let status = engine.get(Register::FPSCR);
            engine.set_word(frame + 32 + 4 * FLOATS, status)?;
        }
        Some(())
    }

    /// Returns the state.
    fn pop(&mut self, frame: u32, uses_floats: bool) -> u32 {
        let engine = &mut self.engine;
        let word = |engine: &super::Engine, at: u32| engine.word(at).unwrap_or(0);
        for (at, register) in (frame..).step_by(4).zip(FRAME) {
            let value = word(engine, at);
            engine.set(register, value);
        }
        if uses_floats {
            for float in 0..FLOATS {
                let value = word(engine, frame + 32 + 4 * float);
                engine.set_float(FIRST_FLOAT + float as i32, value);
            }
            let status = word(engine, frame + 32 + 4 * FLOATS);
            engine.set(Register::FPSCR, status);
        }
        word(engine, frame + 28)
    }
}
