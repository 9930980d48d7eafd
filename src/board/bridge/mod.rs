//! What an emulator lacks, bridged to its host by semihosting: the fluxgate's SPI device with its data-ready edge, and
//! what keeps data (`storage`). Everything above `SpiDevice`, `serial::Read`, `BlockDevice` and `NorFlash` is the program
//! for the board.
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
//! host can replay the very same calls. Where a board would reset its chip, a last request goes out whose frame is all
//! ones and which nobody answers, and the emulator ends: the host starts it again.

mod host;
mod storage;

pub use storage::{LogCard, SettingsFlash, load_kept};

use super::clock::{Source, SpinDelay, first_count, now_us, stamp_us};
use super::cost::Wait;
use core::cell::{Cell, RefCell};
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use cortex_m::interrupt::{self, Mutex};
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{self, ErrorKind, Operation, SpiDevice};
use embedded_hal_nb::nb;
use embedded_hal_nb::serial;
use host::{File, Mode};
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

/// The frame of the last request of a life.
const FAREWELL: [u8; FRAME_BYTES] = [0xff; FRAME_BYTES];

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
pub fn start_data_ready(timer: pac::TIM5, rcc: &mut Rcc, conversions_per_epoch: u8) {
    const TIMER_MHZ: u16 = 1_000;
    let per_epoch = u32::from(conversions_per_epoch).max(1);
    pac::TIM5::enable(rcc);
    pac::TIM5::reset(rcc);
    timer.psc().write(|w| w.psc().set(TIMER_MHZ - 1));
    timer.arr().write(|w| w.arr().set(100_000 / per_epoch - 1));
    timer.egr().write(|w| w.ug().set_bit());
    timer.cnt().write(|w| w.cnt().set(first_count()));
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
        Self { requests: requests(), answers: File::open(c"/dev/stdin", Mode::Read) }
    }

    fn exchange(&mut self, frame: &mut [u8; FRAME_BYTES]) {
        let wait = Wait::begin();
        send_request(&self.requests, frame);
        let mut answer = [0; ANSWER_BYTES];
        // Without its host there is no point in going on.
        self.answers.read(&mut answer).unwrap_or_else(|_| host::exit());
        frame.copy_from_slice(&answer[..FRAME_BYTES]);
        let [a, b, c, d, command, _] = answer[FRAME_BYTES..] else { return };
        self.wait_for_scalar_bytes(u32::from_le_bytes([a, b, c, d]));
        wait.end();
        obey(command);
    }

    /// The bytes are on their way.
    fn wait_for_scalar_bytes(&self, expected: u32) {
        while (SCALAR_BYTES.load(Relaxed).wrapping_sub(expected) as i32) < 0 {
            host::pass_time();
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

/// Where requests go.
fn requests() -> File {
    File::open(c"/dev/stdout", Mode::Write)
}

fn send_request(requests: &File, frame: &[u8; FRAME_BYTES]) {
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
    requests.write(&request).unwrap_or_else(|_| host::exit());
}

/// What the host can make happen to the body.
fn obey(command: u8) {
    match command {
        1 => super::restart(),
        2 => panic!("the emulator's host asked for a panic"),
        3 => host::exit(),
        _ => {}
    }
}

/// Where a board would reset its chip: tell the host what has happened since the last request, and end.
pub fn end_life(kept: &[u8]) -> ! {
    storage::save_kept(kept);
    send_request(&requests(), &FAREWELL);
    host::exit()
}
