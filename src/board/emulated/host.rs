//! Files of the emulator's host, by semihosting: Arm, "Semihosting for AArch32 and AArch64", version 2.0, chapter 6.

const SYS_OPEN: u32 = 0x01;
const SYS_WRITE: u32 = 0x05;
const SYS_READ: u32 = 0x06;
const SYS_SEEK: u32 = 0x0A;
const SYS_FLEN: u32 = 0x0C;
const SYS_CLOCK: u32 = 0x10;
const SYS_EXIT: u32 = 0x18;
const APPLICATION_EXIT: u32 = 0x20026;

/// How a file is opened: "rb", "r+b" and "wb" of `fopen`.
#[derive(Clone, Copy)]
pub enum Mode {
    Read = 1,
    ReadWrite = 3,
    Write = 5,
}

/// The host's file does not work.
#[derive(Clone, Copy, Debug)]
pub struct FileError;

impl core::fmt::Display for FileError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the host's file does not work")
    }
}

impl core::error::Error for FileError {}

/// A file of the host.
pub struct File(u32);

impl File {
    pub fn open(path: &core::ffi::CStr, mode: Mode) -> Self {
        let len = path.count_bytes() as u32;
        Self(semihost(SYS_OPEN, &[path.as_ptr() as u32, mode as u32, len]))
    }

    pub fn len(&self) -> Result<u32, FileError> {
        let len = semihost(SYS_FLEN, &[self.0]);
        if (len as i32) < 0 { Err(FileError) } else { Ok(len) }
    }

    pub fn seek(&self, to: u32) -> Result<(), FileError> {
        if semihost(SYS_SEEK, &[self.0, to]) == 0 { Ok(()) } else { Err(FileError) }
    }

    /// The calls answer with the number of bytes that they did not transfer.
    pub fn read(&self, bytes: &mut [u8]) -> Result<(), FileError> {
        let left = semihost(SYS_READ, &[self.0, bytes.as_mut_ptr() as u32, bytes.len() as u32]);
        if left == 0 { Ok(()) } else { Err(FileError) }
    }

    pub fn write(&self, bytes: &[u8]) -> Result<(), FileError> {
        let left = semihost(SYS_WRITE, &[self.0, bytes.as_ptr() as u32, bytes.len() as u32]);
        if left == 0 { Ok(()) } else { Err(FileError) }
    }
}

/// Let the emulator look after what it has to do; costs its time and hardly any of ours.
pub fn pass_time() {
    semihost(SYS_CLOCK, &[]);
}

/// End the emulation.
pub fn exit() -> ! {
    loop {
        semihost_word(SYS_EXIT, APPLICATION_EXIT);
    }
}

fn semihost(operation: u32, arguments: &[u32]) -> u32 {
    semihost_word(operation, arguments.as_ptr() as u32)
}

fn semihost_word(operation: u32, argument: u32) -> u32 {
    let result;
    // SAFETY: the semihosting call of a Cortex-M. All callers pass either a word or a block of words that describes
    // memory which they own for as long as the call lasts; the compiler must assume that any memory changes.
    #[allow(unsafe_code)]
    unsafe {
        core::arch::asm!("bkpt 0xAB", inout("r0") operation => result, in("r1") argument, options(nostack));
    }
    result
}
