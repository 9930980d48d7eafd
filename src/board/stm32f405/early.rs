//! What runs before anything else: the watchdog.
//!
//! It starts with the first instruction, before the statics have their values, so that nothing after it can hang for ever:
//! no oscillator that is waited for, no flash that is busy. Hence the assembly, which needs neither statics nor stack.

#![allow(unsafe_code)] // assembly: it writes registers of the watchdog and of the debug unit, with what a call may change

use core::arch::global_asm;
use towmag::microcontroller::WATCHDOG;

// IWDG at 0x40003000: key, prescaler, reload, status. The prescaler and the reload value are taken over within some
// periods of the slow oscillator, then they are fed into the counter: until then it counts from its longest. DBGMCU_APB1_FZ
// at 0xE0042008, bit 12: the watchdog stands still while a debugger has halted the core.
global_asm!(
    ".section .text.__pre_init, \"ax\"",
    ".global __pre_init",
    ".type __pre_init, %function",
    ".thumb_func",
    "__pre_init:",
    "movw r0, #0x3000",
    "movt r0, #0x4000",
    "movw r1, #0xCCCC", // start
    "str r1, [r0]",
    "movw r1, #0x5555", // unlock the two that follow
    "str r1, [r0]",
    "movs r1, #{prescaler}",
    "str r1, [r0, #4]",
    "movw r1, #{reload}",
    "str r1, [r0, #8]",
    "movw r2, #0x2008",
    "movt r2, #0xE004",
    "ldr r1, [r2]",
    "orr r1, r1, #0x1000",
    "str r1, [r2]",
    "movw r2, #20000", // at least 5 ms at 16 MHz, if the slow oscillator is dead
    "2: ldr r1, [r0, #12]",
    "cbz r1, 3f",
    "subs r2, #1",
    "bne 2b",
    "3: movw r1, #0xAAAA",
    "str r1, [r0]",
    "bx lr",
    ".size __pre_init, . - __pre_init",
    prescaler = const WATCHDOG.prescaler,
    reload = const WATCHDOG.reload,
);
