//! What an emulator lacks, bridged to its host by semihosting: the fluxgate's SPI device with its data-ready edge, and
//! the card. Everything above `SpiDevice`, `serial::Read` and `BlockDevice` is the program for the board.
//!
//! # Protocol
//!
//! Each SPI transaction is one request on standard output and one answer on standard input, little-endian:
//!
//! ```text
//! request: length u16 of what follows | frame, 18 bytes | conversions so far u32 | events: (kind u8, stamp_us u32) ...
//! answer:  frame, 18 bytes | bytes that the scalar sensor's UART must have got by now u32 | command u8 | 0 u8
//! ```
//!
//! While this waits for an answer, emulated time stands still. The host sends the scalar sensor's bytes to the UART
//! before it answers, and the transaction ends only when they have arrived: so host and body go in lock-step, and
//! nothing depends on how fast either is. Events are the stamps that the grid has seen, in their order, so that the
//! host can replay the very same calls.

use super::clock::{Source, SpinDelay, now_us, stamp_us};
use super::cost::Wait;
use core::cell::{Cell, RefCell};
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use cortex_m::interrupt::{self, Mutex};
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{self, ErrorKind, Operation, SpiDevice};
use embedded_hal_nb::nb;
use embedded_hal_nb::serial;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32f4xx_hal::serial::Rx;
use towmag::sensors::ads131m04::FRAME_BYTES;

const ANSWER_BYTES: usize = FRAME_BYTES + 6;
const EVENT_BYTES: usize = 5;

/// Events kept between two requests; an epoch makes some thirty.
const EVENTS: usize = 400;

/// The body has started: events and counts begin again.
const EVENT_BOOT: u8 = 5;
/// Events were lost, the replay will differ.
const EVENT_LOST: u8 = 6;

static EVENTS_NOTED: Mutex<RefCell<heapless::Vec<u8, { EVENTS * EVENT_BYTES }>>> =
    Mutex::new(RefCell::new(heapless::Vec::new()));
static SCALAR_STAMP_US: Mutex<Cell<u32>> = Mutex::new(Cell::new(0));
static SCALAR_BYTES: AtomicU32 = AtomicU32::new(0);
static CONVERSIONS: AtomicU32 = AtomicU32::new(0);
static IS_READY: AtomicBool = AtomicBool::new(false);

/// Keep a stamp for the host. That of a scalar byte counts only when a byte comes with it.
pub fn note(source: Source, stamp_us: u32) {
    match source {
        Source::ScalarByte => interrupt::free(|cs| SCALAR_STAMP_US.borrow(cs).set(stamp_us)),
        Source::Other => {}
        Source::Conversion | Source::Poll | Source::SetUp => push_event(source as u8, stamp_us),
    }
}

fn push_event(kind: u8, stamp_us: u32) {
    let mut event = [0; EVENT_BYTES];
    event[0] = kind;
    event[1..].copy_from_slice(&stamp_us.to_le_bytes());
    interrupt::free(|cs| {
        let mut events = EVENTS_NOTED.borrow(cs).borrow_mut();
        if events.extend_from_slice(&event).is_err() {
            events.clear();
            _ = events.extend_from_slice(&[EVENT_LOST, 0, 0, 0, 0]);
        }
    });
}

/// TIM5 stands for the converter's DRDY: it makes as many edges to an epoch as the grid expects.
pub fn start_data_ready(timer: pac::TIM5, rcc: &mut Rcc) {
    const TIMER_MHZ: u16 = 1_000;
    let per_epoch = u32::from(super::setup().grid.conversions_per_epoch).max(1);
    pac::TIM5::enable(rcc);
    pac::TIM5::reset(rcc);
    timer.psc().write(|w| w.psc().set(TIMER_MHZ - 1));
    timer.arr().write(|w| w.arr().set(100_000 / per_epoch - 1));
    timer.egr().write(|w| w.ug().set_bit());
    timer.cnt().write(|w| w.cnt().set(0));
    timer.sr().write(|w| w.uif().clear_bit());
    timer.dier().write(|w| w.uie().set_bit());
    timer.cr1().write(|w| w.cen().set_bit());
    // Keeps the edges off the instants at which `assemble` runs, whose stamps would else come out of order.
    SpinDelay.delay_ms(13);
    // An edge during the wait has come too early for anyone to see.
    IS_READY.store(false, Relaxed);
}

/// The edge: pend the interrupt that the pin would.
pub fn data_ready() {
    // SAFETY: clears the interrupt flag of a timer that nothing else touches once it runs.
    #[allow(unsafe_code)]
    let timer = unsafe { &*pac::TIM5::ptr() };
    timer.sr().write(|w| w.uif().clear_bit());
    CONVERSIONS.fetch_add(1, Relaxed);
    IS_READY.store(true, Relaxed);
    rtic::pend(pac::Interrupt::EXTI9_5);
}

/// The data-ready pin.
pub struct DataReady;

impl DataReady {
    /// The stamp of the edge, once.
    pub fn take(&mut self) -> Option<u32> {
        IS_READY.swap(false, Relaxed).then(|| stamp_us(Source::Conversion))
    }
}

/// The UART of the scalar sensor, whose bytes are counted for the lock-step.
pub struct ScalarPort(Rx<pac::USART1>);

impl ScalarPort {
    pub fn new(rx: Rx<pac::USART1>) -> Self {
        Self(rx)
    }
}

impl serial::ErrorType for ScalarPort {
    type Error = stm32f4xx_hal::serial::Error;
}

impl serial::Read<u8> for ScalarPort {
    fn read(&mut self) -> nb::Result<u8, Self::Error> {
        let byte = serial::Read::<u8>::read(&mut self.0)?;
        push_event(Source::ScalarByte as u8, interrupt::free(|cs| SCALAR_STAMP_US.borrow(cs).get()));
        SCALAR_BYTES.fetch_add(1, Relaxed);
        Ok(byte)
    }
}

/// The SPI device of the converter.
pub struct FluxgateBus {
    requests: File,
    answers: File,
}

impl FluxgateBus {
    pub fn open() -> Self {
        push_event(EVENT_BOOT, now_us());
        Self { requests: File::open(c"/dev/stdout", WRITE), answers: File::open(c"/dev/stdin", READ) }
    }

    fn exchange(&mut self, frame: &mut [u8; FRAME_BYTES]) {
        let wait = Wait::begin();
        let mut request: heapless::Vec<u8, { 2 + FRAME_BYTES + 4 + EVENTS * EVENT_BYTES }> = heapless::Vec::new();
        _ = request.extend_from_slice(&[0, 0]);
        _ = request.extend_from_slice(frame);
        _ = request.extend_from_slice(&CONVERSIONS.load(Relaxed).to_le_bytes());
        interrupt::free(|cs| {
            let mut events = EVENTS_NOTED.borrow(cs).borrow_mut();
            _ = request.extend_from_slice(&events);
            events.clear();
        });
        let len = (request.len() - 2) as u16;
        request[..2].copy_from_slice(&len.to_le_bytes());
        self.requests.write(&request);
        let mut answer = [0; ANSWER_BYTES];
        self.answers.read(&mut answer);
        frame.copy_from_slice(&answer[..FRAME_BYTES]);
        let [a, b, c, d, command, _] = answer[FRAME_BYTES..] else { return };
        self.wait_for_scalar_bytes(u32::from_le_bytes([a, b, c, d]));
        wait.end();
        obey(command);
    }

    /// The bytes are on their way; looking at the emulator's clock costs its time and hardly any of ours.
    fn wait_for_scalar_bytes(&self, expected: u32) {
        while (SCALAR_BYTES.load(Relaxed).wrapping_sub(expected) as i32) < 0 {
            semihost(SYS_CLOCK, &[]);
        }
    }
}

impl spi::ErrorType for FluxgateBus {
    type Error = ErrorKind;
}

impl SpiDevice for FluxgateBus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let [Operation::TransferInPlace(bytes)] = operations else { return Err(ErrorKind::Other) };
        let frame = bytes.first_chunk_mut().ok_or(ErrorKind::Other)?;
        self.exchange(frame);
        Ok(())
    }
}

/// What the host can make happen to the body.
fn obey(command: u8) {
    match command {
        1 => cortex_m::peripheral::SCB::sys_reset(),
        2 => panic!("the emulator's host asked for a panic"),
        3 => exit(),
        _ => {}
    }
}

/// The card: a file of blocks.
pub struct LogCard(File);

impl LogCard {
    pub fn open() -> Self {
        Self(File::open(c"card.img", READ_WRITE))
    }
}

/// The host's file does not work.
#[derive(Clone, Copy, Debug)]
pub struct FileError;

impl core::fmt::Display for FileError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the card's file on the host does not work")
    }
}

impl core::error::Error for FileError {}

impl BlockDevice for LogCard {
    type Error = FileError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), FileError> {
        self.0.seek(start.0 * Block::LEN_U32)?;
        blocks.iter_mut().try_for_each(|block| self.0.try_read(&mut block.contents))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), FileError> {
        self.0.seek(start.0 * Block::LEN_U32)?;
        blocks.iter().try_for_each(|block| self.0.try_write(&block.contents))
    }

    fn num_blocks(&self) -> Result<BlockCount, FileError> {
        let len = semihost(SYS_FLEN, &[self.0.0]);
        if (len as i32) < 0 { Err(FileError) } else { Ok(BlockCount(len / Block::LEN_U32)) }
    }
}

// Arm semihosting, version 2.0, chapter 6.
const SYS_OPEN: u32 = 0x01;
const SYS_WRITE: u32 = 0x05;
const SYS_READ: u32 = 0x06;
const SYS_SEEK: u32 = 0x0A;
const SYS_FLEN: u32 = 0x0C;
const SYS_CLOCK: u32 = 0x10;
const SYS_EXIT: u32 = 0x18;
const APPLICATION_EXIT: u32 = 0x20026;

/// "rb", "r+b" and "wb" of `fopen`.
const READ: u32 = 1;
const READ_WRITE: u32 = 3;
const WRITE: u32 = 5;

/// A file of the host.
struct File(u32);

impl File {
    fn open(path: &core::ffi::CStr, mode: u32) -> Self {
        let len = path.count_bytes() as u32;
        Self(semihost(SYS_OPEN, &[path.as_ptr() as u32, mode, len]))
    }

    fn seek(&self, to: u32) -> Result<(), FileError> {
        if semihost(SYS_SEEK, &[self.0, to]) == 0 { Ok(()) } else { Err(FileError) }
    }

    /// The calls answer with the number of bytes that they did not transfer.
    fn try_read(&self, bytes: &mut [u8]) -> Result<(), FileError> {
        let left = semihost(SYS_READ, &[self.0, bytes.as_mut_ptr() as u32, bytes.len() as u32]);
        if left == 0 { Ok(()) } else { Err(FileError) }
    }

    fn try_write(&self, bytes: &[u8]) -> Result<(), FileError> {
        let left = semihost(SYS_WRITE, &[self.0, bytes.as_ptr() as u32, bytes.len() as u32]);
        if left == 0 { Ok(()) } else { Err(FileError) }
    }

    /// Without its host there is no point in going on.
    fn read(&self, bytes: &mut [u8]) {
        self.try_read(bytes).unwrap_or_else(|_| exit());
    }

    fn write(&self, bytes: &[u8]) {
        self.try_write(bytes).unwrap_or_else(|_| exit());
    }
}

fn exit() -> ! {
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
