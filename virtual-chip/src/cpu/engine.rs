//! Unicorn: memories, registers, and the calls out of running code.
//!
//! Unicorn 2.0.1, when it is stopped while it reads or writes, breaks off within the block of code, and begins the whole
//! block anew when it goes on: so only the hook before each block stops it. At a fault its program counter is an old one: the
//! block's is told. What it derives from its registers, whether an exception runs above all, it derives anew only when the flags
//! alone are written.

#![allow(unsafe_code)] // Unicorn's bindings lack the choice of the processor

use crate::image::{FLASH_BASE, Image};
use crate::machine::{Machine, Stop};
use crate::peripherals::flash::SETTINGS;
use crate::peripherals::nvic::Masks;
use std::ffi::c_void;
use unicorn_engine::unicorn_const::{Arch, HookType, Mode, Permission, uc_error};
use unicorn_engine::{RegisterARM as Register, Unicorn};

const SETTINGS_BASE: u32 = FLASH_BASE + SETTINGS as u32;
const SETTINGS_LEN: usize = 0x4_0000;
const RAM: (u32, usize) = (0x2000_0000, 0x2_0000);
const CORE_COUPLED: (u32, usize) = (0x1000_0000, 0x1_0000);
/// Number of the chip and size of its flash, in the system memory.
const SYSTEM: (u32, usize) = (0x1FFF_7000, 0x1000);
const PERIPHERALS: (u32, usize) = (0x4000_0000, 0x3_0000);
const BIT_BAND: (u32, usize) = (0x4200_0000, 0x60_0000);
const PRIVATE: (u32, usize) = (0xE000_0000, 0x5_0000);

/// Unique number of the chip, and its flash, KiB.
const UNIQUE_NUMBER: [u32; 3] = [0x0037_002A, 0x3133_5107, 0x3735_3338];
const FLASH_KIB: u16 = 1024;

/// Returns from exceptions lie here.
const FIRST_RETURN: u32 = 0xFFFF_FFE0;

/// `UC_CTL_WRITE(UC_CTL_CPU_MODEL, 1)`, and `UC_CPU_ARM_CORTEX_M4`.
const SET_MODEL: u32 = 7 | 1 << 26 | 1 << 30;
const CORTEX_M4: i32 = 9;

unsafe extern "C" {
    fn uc_ctl(engine: *mut c_void, control: u32, ...) -> uc_error;
}

/// The engine, with what the hooks see.
pub(super) struct Engine {
    unicorn: Unicorn<'static, Machine>,
}

impl Engine {
    pub(super) fn new(image: &Image, machine: Machine) -> Self {
        let unicorn =
            Unicorn::new_with_data(Arch::ARM, Mode::LITTLE_ENDIAN, machine).expect("Unicorn knows this architecture");
        // SAFETY: a fresh engine, and the one argument that this control takes.
        let chosen = unsafe { uc_ctl(unicorn.get_handle(), SET_MODEL, CORTEX_M4) };
        assert_eq!(chosen, uc_error::OK, "Unicorn has a Cortex-M4");
        let mut engine = Self { unicorn };
        engine.map(image);
        engine.hook();
        engine
    }

    pub(super) fn machine(&self) -> &Machine {
        self.unicorn.get_data()
    }

    pub(super) fn machine_mut(&mut self) -> &mut Machine {
        self.unicorn.get_data_mut()
    }

    pub(super) fn get(&self, register: Register) -> u32 {
        self.unicorn.reg_read(register).expect("a register of this processor") as u32
    }

    pub(super) fn set(&mut self, register: Register, value: u32) {
        self.unicorn.reg_write(register, value.into()).expect("a register of this processor");
    }

    pub(super) fn get_float(&self, register: i32) -> u32 {
        self.unicorn.reg_read(register).expect("a register of this processor") as u32
    }

    pub(super) fn set_float(&mut self, register: i32, value: u32) {
        self.unicorn.reg_write(register, value.into()).expect("a register of this processor");
    }

    /// Go on there: the lowest bit says that it is Thumb code.
    pub(super) fn jump(&mut self, address: u32) {
        self.set(Register::PC, address | 1);
        // What Unicorn has derived from the registers is derived anew only with this one.
        let flags = self.get(Register::XPSR);
        self.set(Register::APSR_NZCV, flags);
    }

    pub(super) fn word(&self, address: u32) -> Option<u32> {
        let mut bytes = [0; 4];
        self.unicorn.mem_read(address.into(), &mut bytes).ok()?;
        Some(u32::from_le_bytes(bytes))
    }

    pub(super) fn set_word(&mut self, address: u32, value: u32) -> Option<()> {
        let is_memory = [RAM, CORE_COUPLED].iter().any(|(base, len)| (*base..*base + *len as u32).contains(&address));
        self.unicorn.mem_write(u64::from(address), &value.to_le_bytes()).ok().filter(|()| is_memory)
    }

    /// Noise in the memories, as power leaves it.
    pub(super) fn forget(&mut self) {
        for (base, len) in [RAM, CORE_COUPLED] {
            let mut state = 0x9E37_79B9_u32;
            let noise: Vec<u8> = std::iter::repeat_with(|| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8
            })
            .take(len)
            .collect();
            self.unicorn.mem_write(base.into(), &noise).expect("memory");
        }
    }

    pub(super) fn reset_registers(&mut self) {
        for register in [Register::PRIMASK, Register::BASEPRI, Register::FAULTMASK, Register::CONTROL, Register::FPSCR]
        {
            self.set(register, 0);
        }
        self.set(Register::XPSR_NZCVQG, 1 << 24);
        self.set(Register::LR, u32::MAX);
    }

    /// Until the machine wants a stop or the processor does.
    pub(super) fn run(&mut self) {
        let from = self.get(Register::PC) | 1;
        let ended = self.unicorn.emu_start(from.into(), 0, 0, 0);
        if self.machine().stop.is_some() {
            return;
        }
        match ended {
            // It waits for an interrupt.
            Ok(()) => {
                let masks = masks(&self.unicorn);
                self.machine_mut().sleep(masks);
            }
            Err(uc_error::EXCEPTION) if self.get(Register::PC) >= FIRST_RETURN => {
                self.machine_mut().stop = Some(Stop::Return);
            }
            Err(error) => {
                if !matches!(error, uc_error::FETCH_UNMAPPED | uc_error::FETCH_PROT) {
                    self.jump(self.machine().last_block);
                }
                self.machine_mut().stop = Some(Stop::Fault);
            }
        }
    }

    fn map(&mut self, image: &Image) {
        let code = Permission::READ | Permission::EXEC;
        let data = Permission::READ | Permission::WRITE;
        let map = |unicorn: &mut Unicorn<'static, Machine>, (base, len): (u32, usize), permission| {
            unicorn.mem_map(base.into(), len, permission).expect("memory that is not there yet");
        };
        for base in [0, FLASH_BASE] {
            map(&mut self.unicorn, (base, SETTINGS), code);
            self.unicorn.mem_write(base.into(), &image.flash).expect("the image fits");
        }
        map(&mut self.unicorn, RAM, data);
        map(&mut self.unicorn, CORE_COUPLED, data);
        map(&mut self.unicorn, SYSTEM, Permission::READ);
        let number: Vec<u8> = UNIQUE_NUMBER.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.unicorn.mem_write(0x1FFF_7A10, &number).expect("system memory");
        self.unicorn.mem_write(0x1FFF_7A22, &FLASH_KIB.to_le_bytes()).expect("system memory");
        self.map_registers(PERIPHERALS);
        self.map_registers(PRIVATE);
        self.map_bit_band();
        self.map_settings();
    }

    fn map_registers(&mut self, (base, len): (u32, usize)) {
        let read = move |unicorn: &mut Unicorn<'_, Machine>, offset: u64, size: usize| {
            unicorn.get_data_mut().read(base + offset as u32, size).into()
        };
        let write = move |unicorn: &mut Unicorn<'_, Machine>, offset: u64, size: usize, value: u64| {
            unicorn.get_data_mut().write(base + offset as u32, value as u32, size);
        };
        self.unicorn.mmio_map(base.into(), len, Some(read), Some(write)).expect("addresses that are free");
    }

    /// Each bit of the peripherals as a word of its own.
    fn map_bit_band(&mut self) {
        let place = |offset: u64| (PERIPHERALS.0 + ((offset as u32 / 32) & !3), offset as u32 / 4 % 32);
        let read = move |unicorn: &mut Unicorn<'_, Machine>, offset: u64, _: usize| {
            let (address, bit) = place(offset);
            (unicorn.get_data_mut().read(address, 4) >> bit & 1).into()
        };
        let write = move |unicorn: &mut Unicorn<'_, Machine>, offset: u64, _: usize, value: u64| {
            let (address, bit) = place(offset);
            let machine = unicorn.get_data_mut();
            let word = machine.read(address, 4) & !(1 << bit) | (value as u32 & 1) << bit;
            machine.write(address, word, 4);
        };
        self.unicorn.mmio_map(BIT_BAND.0.into(), BIT_BAND.1, Some(read), Some(write)).expect("addresses that are free");
    }

    fn map_settings(&mut self) {
        let read = |unicorn: &mut Unicorn<'_, Machine>, offset: u64, size: usize| {
            let cells = &unicorn.get_data().bus.flash.cells.settings[offset as usize..][..size];
            cells.iter().rev().fold(0, |value, byte| value << 8 | u64::from(*byte))
        };
        let write = |unicorn: &mut Unicorn<'_, Machine>, offset: u64, size: usize, value: u64| {
            unicorn.get_data_mut().program(offset as usize, value as u32, size);
        };
        self.unicorn.mmio_map(SETTINGS_BASE.into(), SETTINGS_LEN, Some(read), Some(write)).expect("free addresses");
    }

    fn hook(&mut self) {
        let block = |unicorn: &mut Unicorn<'_, Machine>, address: u64, size: u32| {
            if unicorn.get_data_mut().look() {
                let masks = masks(unicorn);
                unicorn.get_data_mut().preempt(masks);
            }
            if !unicorn.get_data_mut().run_block(address as u32, size) {
                _ = unicorn.emu_stop();
            }
        };
        self.unicorn.add_block_hook(block).expect("a hook");
        // Nothing is mended: the error ends the run.
        let fault = |_: &mut Unicorn<'_, Machine>, _, _, _, _| false;
        self.unicorn.add_mem_hook(HookType::MEM_INVALID, 1, 0, fault).expect("a hook");
    }
}

fn masks(unicorn: &Unicorn<'_, Machine>) -> Masks {
    let get = |register| unicorn.reg_read(register).expect("a register of this processor") as u32;
    Masks { primask: get(Register::PRIMASK) & 1 == 1, basepri: get(Register::BASEPRI) as u8 }
}
