//! As much of the Thumb-2 instruction set as tells what a function does to the stack (ARM DDI 0403, A7.7).

/// What the code of a function does to the stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Code {
    /// All that its instructions take off the stack pointer, bytes: as if each ran once, which is never too little, as
    /// compilers let no loop do it.
    pub(super) frame_bytes: u32,
    /// Calls through a register.
    pub(super) indirect_calls: u32,
    /// Instructions that set the stack pointer in a way that this does not understand.
    pub(super) unknown: u32,
}

/// Read the instructions of a function; `is_code` tells them from the constants between them.
pub(super) fn read(bytes: &[u8], is_code: impl Fn(usize) -> bool) -> Code {
    let half = |at: usize| bytes.get(at..at + 2).map(|two| u16::from_le_bytes([two[0], two[1]]));
    let (mut code, mut at) = (Code::default(), 0);
    while let Some(first) = half(at) {
        if !is_code(at) {
            at += 2;
        } else if first >> 11 >= 0b11101 {
            let second = half(at + 2).unwrap_or(0);
            wide(&mut code, first, second);
            at += 4;
        } else {
            narrow(&mut code, first);
            at += 2;
        }
    }
    code
}

fn narrow(code: &mut Code, instruction: u16) {
    match instruction {
        // PUSH
        0xB400..=0xB5FF => code.frame_bytes += 4 * (instruction & 0x1FF).count_ones(),
        // SUB SP, #
        0xB080..=0xB0FF => code.frame_bytes += 4 * u32::from(instruction & 0x7F),
        // BLX register
        _ if instruction & 0xFF87 == 0x4780 => code.indirect_calls += 1,
        // BX register, which is a call as the last act unless it is LR
        _ if instruction & 0xFF87 == 0x4700 && instruction != 0x4770 => code.indirect_calls += 1,
        // ADD SP, register; MOV SP, register
        _ if instruction & 0xFF87 == 0x4485 || instruction & 0xFF87 == 0x4685 => code.unknown += 1,
        _ => {}
    }
}

fn wide(code: &mut Code, first: u16, second: u16) {
    let low = u32::from(second & 0xFF);
    let writes_sp = second & 0x0F00 == 0x0D00;
    match first {
        // PUSH.W
        0xE92D => code.frame_bytes += 4 * second.count_ones(),
        // STR register, [SP, #-]!
        0xF84D if writes_sp => code.frame_bytes += low,
        // STRD registers, [SP, #-]!
        0xE96D => code.frame_bytes += 4 * low,
        // VPUSH of either width: the field counts words
        0xED2D | 0xED6D => code.frame_bytes += 4 * low,
        // SUB.W SP, SP, #
        0xF1AD | 0xF5AD if writes_sp => code.frame_bytes += expanded(first, second),
        // SUBW SP, SP, #
        0xF2AD | 0xF6AD if writes_sp => code.frame_bytes += immediate(first, second),
        // SUB.W SP, SP, register
        0xEBAD if writes_sp => code.unknown += 1,
        _ => {}
    }
}

/// The twelve bits of an immediate.
fn immediate(first: u16, second: u16) -> u32 {
    u32::from(first >> 10 & 1) << 11 | u32::from(second >> 12 & 7) << 8 | u32::from(second & 0xFF)
}

/// What the twelve bits stand for: `ThumbExpandImm`.
fn expanded(first: u16, second: u16) -> u32 {
    let bits = immediate(first, second);
    let byte = bits & 0xFF;
    match bits >> 8 {
        0b0000 => byte,
        0b0001 => byte << 16 | byte,
        0b0010 => byte << 24 | byte << 8,
        0b0011 => byte * 0x0101_0101,
        _ => (0x80 | bits & 0x7F).rotate_right(bits >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(halves: &[u16]) -> Code {
        let bytes: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
        read(&bytes, |_| true)
    }

    #[test]
    fn frames_are_what_an_assembler_means() {
        let frame = |halves: &[u16]| of(halves).frame_bytes;
        assert_eq!(frame(&[0xB5F0]), 20, "push {{r4-r7, lr}}");
        assert_eq!(frame(&[0xE92D, 0x0F00]), 16, "push.w {{r8-r11}}");
        assert_eq!(frame(&[0xF84D, 0xBD04]), 4, "str r11, [sp, #-4]!");
        assert_eq!(frame(&[0xED2D, 0x8B10]), 64, "vpush {{d8-d15}}");
        assert_eq!(frame(&[0xB082]), 8, "sub sp, #8");
        assert_eq!(frame(&[0xF5AD, 0x7D48]), 800, "sub.w sp, sp, #800");
        assert_eq!(frame(&[0xF2AD, 0x4D34]), 1076, "subw sp, sp, #1076");
        assert_eq!(frame(&[0xF84D, 0x0B04, 0xB002]), 0, "ldr r0, [sp], #4; add sp, #8");
    }

    #[test]
    fn calls_through_registers_and_what_is_not_understood_are_seen() {
        assert_eq!(of(&[0x4798, 0x4710, 0x4770]).indirect_calls, 2, "blx r3; bx r2; bx lr");
        assert_eq!(of(&[0x46A5, 0x44A5, 0xEBAD, 0x0D04]).unknown, 3, "mov sp, r4; add sp, r4; sub.w sp, sp, r4");
    }

    #[test]
    fn constants_are_no_code() {
        let bytes: Vec<u8> = [0xB5F0_u16, 0xB5F0].iter().flat_map(|half| half.to_le_bytes()).collect();
        assert_eq!(read(&bytes, |at| at < 2).frame_bytes, 20);
    }
}
