//! Is there a card?

use super::bus::{CardBus, STOP, Wire};
use crate::hardware::System;
use embedded_hal::digital::OutputPin;
use embedded_sdmmc::SdCardError as Error;

/// At least 74 clocks with chip select high, before the first command after power-up (Physical Layer Specification,
/// 6.4.1.1).
const POWER_UP_BYTES: u32 = 10;

/// CMD0, go to the idle state, with its CRC.
const GO_IDLE: [u8; 6] = [0x40, 0, 0, 0, 0, 0x95];

/// A card in its idle state answers with this,
const IDLE: u8 = 0x01;

/// within eight bytes.
const ANSWER_BYTES: u32 = 9;

/// To the end of a block that the card was sending or waiting for when the microcontroller was reset.
const BLOCK_BYTES: u32 = 600;

/// Whether a card answers. The driver would ask an empty socket for 0.6 s; this takes some 0.04 s.
pub(super) fn probe<BUS: CardBus, CS: OutputPin, S: System>(wire: &mut Wire<BUS, CS, S>) -> Result<(), Error> {
    for _ in 0..3 {
        wire.release();
        wire.idle(POWER_UP_BYTES)?;
        wire.select()?;
        wire.transfer(&mut [STOP, 0xff])?;
        wire.transfer(&mut GO_IDLE.clone())?;
        for _ in 0..ANSWER_BYTES {
            if wire.idle(1)? == IDLE {
                return Ok(());
            }
        }
        wire.idle(BLOCK_BYTES)?;
    }
    wire.release();
    Err(Error::CardNotFound)
}
