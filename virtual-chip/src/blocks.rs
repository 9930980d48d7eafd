//! Which code has run, and how many instructions each block of it has.

use crate::image::FLASH_BASE;

/// `b .`
pub const BRANCH_TO_SELF: u16 = 0xE7FE;

/// What is known of the block that begins at an address.
#[derive(Clone, Copy, Default)]
struct Block {
    size: u16,
    instructions: u16,
}

/// The blocks of the flash by half-word.
pub struct Blocks {
    flash: Vec<u8>,
    blocks: Vec<Block>,
}

impl Blocks {
    /// Of a flash with this content.
    pub fn new(flash: &[u8]) -> Self {
        Self { flash: flash.to_vec(), blocks: vec![Block::default(); flash.len() / 2] }
    }

    /// A block runs. Returns its instructions.
    pub fn run(&mut self, address: u32, size: u32) -> u32 {
        let at = (address.wrapping_sub(FLASH_BASE) / 2) as usize;
        let Some(block) = self.blocks.get_mut(at) else { return size / 2 };
        if u32::from(block.size) < size {
            let code = &self.flash[2 * at..][..size as usize];
            *block = Block { size: size as u16, instructions: instructions(code) };
        }
        block.instructions.into()
    }

    /// Whether the instruction at an address jumps to itself.
    pub fn is_endless(&self, address: u32) -> bool {
        let at = address.wrapping_sub(FLASH_BASE) as usize;
        self.flash.get(at..at + 2).is_some_and(|bytes| bytes == BRANCH_TO_SELF.to_le_bytes())
    }

    /// Where this half-word is.
    pub fn find(&self, halfword: u16) -> Option<u32> {
        let at = self.flash.chunks_exact(2).position(|bytes| bytes == halfword.to_le_bytes())?;
        Some(FLASH_BASE + 2 * at as u32)
    }

    /// First address and size of each block that has run.
    pub fn seen(&self) -> impl Iterator<Item = (u32, u32)> {
        let blocks = self.blocks.iter().enumerate().filter(|(_, block)| block.size > 0);
        blocks.map(|(at, block)| (FLASH_BASE + 2 * at as u32, block.size.into()))
    }
}

/// Instructions of Thumb code: those that begin with 11101, 11110 or 11111 have two half-words.
fn instructions(code: &[u8]) -> u16 {
    let mut halfwords = code.chunks_exact(2).map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
    let mut count = 0;
    while let Some(first) = halfwords.next() {
        if first >> 11 >= 0b11101 {
            halfwords.next();
        }
        count += 1;
    }
    count
}
