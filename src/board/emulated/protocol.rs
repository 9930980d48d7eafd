//! What goes to the emulator's host with each SPI transaction, and what comes back.
//!
//! Each SPI transaction is one request on standard output and one answer on standard input, little-endian:
//!
//! ```text
//! request: length u16 of what follows | frame, 18 bytes | conversions so far u32 | events: (kind u8, stamp_us u32) ...
//! answer:  frame, 18 bytes | bytes that the UARTs of the sensors must have got by now u32 | command u8
//!          | flags u8: 1 leak contact wet, 2 battery converted | battery u16, counts
//! ```
//!
//! While this waits for an answer, emulated time stands still. The host sends the sensors' bytes to their UARTs
//! before it answers, and the transaction ends only when they have arrived: so host and body go in lock-step, and
//! nothing depends on how fast either is. Events are the stamps that the grid has seen, and the samples of leak and battery
//! (counts u16, flags u8, 0 u8 instead of a stamp), in their order, so that the host can replay the very same calls. Where a board would reset its chip, a last request goes out whose frame is all
//! ones and which nobody answers, and the emulator ends: the host starts it again.

use super::host::{self, File, Mode};
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::interrupt::{self, Mutex};
use towmag::hardware::Stamp;
use towmag::housekeeping::HousekeepingSample;
use towmag::sensors::ads131m04::FRAME_BYTES;

const ANSWER_BYTES: usize = FRAME_BYTES + 8;
const EVENT_BYTES: usize = 5;

/// Events kept between two requests; an epoch makes some thirty.
const EVENTS: usize = 400;

const EVENT_SCALAR_BYTE: u8 = 1;
const EVENT_CONVERSION: u8 = 2;
const EVENT_POLL: u8 = 3;
const EVENT_SET_UP: u8 = 4;
/// The body has started: events and counts begin again.
const EVENT_BOOT: u8 = 5;
/// Events were lost, the replay will differ.
const EVENT_LOST: u8 = 6;
/// A sample of leak and battery was taken.
const EVENT_HOUSEKEEPING: u8 = 7;

/// Flags of leak and battery.
const WET: u32 = 1;
const CONVERTED: u32 = 2;

/// The frame of the last request of a life.
const FAREWELL: [u8; FRAME_BYTES] = [0xff; FRAME_BYTES];

static EVENTS_NOTED: Mutex<RefCell<heapless::Vec<u8, { EVENTS * EVENT_BYTES }>>> =
    Mutex::new(RefCell::new(heapless::Vec::new()));
static SCALAR_STAMP_US: AtomicU32 = AtomicU32::new(0);
static SENSOR_BYTES: AtomicU32 = AtomicU32::new(0);
static CONVERSIONS: AtomicU32 = AtomicU32::new(0);
/// Leak and battery of the latest answer: counts, and flags above them.
static HOUSEKEEPING: AtomicU32 = AtomicU32::new(0);

/// What the host can make happen to the body.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Order {
    GoOn,
    Restart,
    Panic,
    Exit,
}

/// What the host answers to a request.
pub struct Answer {
    pub frame: [u8; FRAME_BYTES],
    /// Bytes that the UARTs of the sensors must have got by now, together.
    pub sensor_bytes: u32,
    pub order: Order,
}

/// Keep a stamp for the host. That of a scalar byte counts only when a byte comes with it.
pub fn note(stamp: Stamp, stamp_us: u32) {
    match stamp {
        Stamp::ScalarByte => SCALAR_STAMP_US.store(stamp_us, Relaxed),
        Stamp::Conversion => push_event(EVENT_CONVERSION, stamp_us),
        Stamp::Poll => push_event(EVENT_POLL, stamp_us),
        Stamp::SetUp => push_event(EVENT_SET_UP, stamp_us),
        Stamp::Other => {}
    }
}

/// The body has started.
pub fn note_boot(now_us: u32) {
    push_event(EVENT_BOOT, now_us);
}

/// A byte of the scalar sensor has come, at the stamp that was noted last.
pub fn note_scalar_byte() {
    push_event(EVENT_SCALAR_BYTE, SCALAR_STAMP_US.load(Relaxed));
    count_sensor_byte();
}

/// A byte of either sensor with a UART has come.
pub fn count_sensor_byte() {
    SENSOR_BYTES.fetch_add(1, Relaxed);
}

/// A conversion is ready.
pub fn note_conversion() {
    CONVERSIONS.fetch_add(1, Relaxed);
}

/// Whether so many bytes of the sensors have come.
pub fn has_sensor_bytes(expected: u32) -> bool {
    SENSOR_BYTES.load(Relaxed).wrapping_sub(expected) as i32 >= 0
}

/// Leak and battery as the host has told them last, and told to the host as an event.
pub fn housekeeping() -> HousekeepingSample {
    let told = HOUSEKEEPING.load(Relaxed);
    push_event(EVENT_HOUSEKEEPING, told);
    let has = |flag: u32| told >> 16 & flag != 0;
    HousekeepingSample { is_wet: has(WET), battery_counts: has(CONVERTED).then_some(told as u16) }
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

/// Where requests go.
pub fn requests() -> File {
    File::open(c"/dev/stdout", Mode::Write)
}

/// Where answers come from.
pub fn answers() -> File {
    File::open(c"/dev/stdin", Mode::Read)
}

/// Send a frame, and what has happened since the last.
pub fn send_request(requests: &File, frame: &[u8; FRAME_BYTES]) {
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

/// Wait for the answer to a request. Without its host there is no point in going on.
pub fn receive_answer(answers: &File) -> Answer {
    let mut bytes = [0; ANSWER_BYTES];
    answers.read(&mut bytes).unwrap_or_else(|_| host::exit());
    let mut frame = [0; FRAME_BYTES];
    frame.copy_from_slice(&bytes[..FRAME_BYTES]);
    let [a, b, c, d, order, flags, low, high] = bytes[FRAME_BYTES..] else {
        unreachable!("eight bytes follow the frame")
    };
    HOUSEKEEPING.store(u32::from_le_bytes([low, high, flags, 0]), Relaxed);
    let order = match order {
        1 => Order::Restart,
        2 => Order::Panic,
        3 => Order::Exit,
        _ => Order::GoOn,
    };
    Answer { frame, sensor_bytes: u32::from_le_bytes([a, b, c, d]), order }
}

/// Tell the host what has happened since the last request, and that this life ends.
pub fn say_farewell() {
    send_request(&requests(), &FAREWELL);
}
