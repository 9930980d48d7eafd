//! What the body finds out about itself: on `selftest`, and once some seconds after each start.
//!
//! Each part looks at itself where it is used, and leaves what it found in [`Checks`](crate::health::Checks). Here it is put
//! together. The command also sends some bytes out of the sensors' UARTs: with a wire from TX to RX in place of the sensor
//! they come back, and the receiver counts them as rubbish.

mod report;

pub use report::{FlashCheck, SelfTestReport};

use crate::hardware::{SensorPort, SensorTransmitters};
use crate::health::Health;
use crate::link::{NMEA_RUBBISH, SCALAR_RUBBISH};
use crate::microcontroller::ClockCheck;

/// At the start, after so many ticks: a card has its seconds to be found, and the slowest sensor to send.
const START_TICKS: u32 = 120;

/// On command, after so many: a converter that is silent is looked at once a second.
const COMMAND_TICKS: u32 = 25;

/// Bytes that are sent to each UART.
pub const LOOP_BYTES: u8 = 8;

/// Its bits alternate, and it begins no sentence of any sensor.
pub const LOOP_BYTE: u8 = b'U';

/// What is under way.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The start's is due at this tick.
    Start,
    Idle,
    /// An operator's, since that tick: bytes sent so far, and what the receivers had counted before.
    Asked {
        since_tick: u32,
        sent: u8,
        before: [u32; 2],
    },
}

/// When a report is due, and what it is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Due {
    /// The body has started.
    Start,
    /// An operator wants it: so many of [`LOOP_BYTES`] came back on each UART.
    Asked([u8; 2]),
}

/// The self-test between the tasks.
pub struct SelfTest<T> {
    transmitters: T,
    clock: ClockCheck,
    phase: Phase,
}

impl<T: SensorTransmitters> SelfTest<T> {
    /// One at the start is due.
    pub fn new(transmitters: T, clock: ClockCheck) -> Self {
        Self { transmitters, clock, phase: Phase::Start }
    }

    /// What the start has found out about the oscillators.
    pub fn clock(&self) -> ClockCheck {
        self.clock
    }

    /// An operator wants one.
    pub fn ask(&mut self, tick: u32, health: &Health) {
        health.checks.ask_converter();
        self.phase = Phase::Asked { since_tick: tick, sent: 0, before: rubbish(health) };
    }

    /// To be called some 25 times a second: go on, and tell when a report is due. `tick` is the latest.
    pub fn step(&mut self, tick: u32, health: &Health) -> Option<Due> {
        let due = match &mut self.phase {
            Phase::Idle => return None,
            Phase::Start => (tick >= START_TICKS).then_some(Due::Start),
            Phase::Asked { since_tick, sent, before } => {
                if *sent < LOOP_BYTES {
                    // One at a time: a call later the slowest UART has sent it.
                    SensorPort::ALL.iter().for_each(|port| self.transmitters.send(*port, LOOP_BYTE));
                    *sent += 1;
                }
                let is_over = tick.wrapping_sub(*since_tick) >= COMMAND_TICKS;
                is_over.then(|| Due::Asked(came_back(*before, rubbish(health))))
            }
        }?;
        self.phase = Phase::Idle;
        Some(due)
    }
}

/// What the sensors' receivers have counted that was no sentence.
fn rubbish(health: &Health) -> [u32; 2] {
    let faults = health.counts.faults();
    [faults.0[SCALAR_RUBBISH], faults.0[NMEA_RUBBISH]]
}

fn came_back(before: [u32; 2], after: [u32; 2]) -> [u8; 2] {
    let [scalar, nmea] = [0, 1].map(|port| after[port].wrapping_sub(before[port]));
    [scalar, nmea].map(|bytes| bytes.min(LOOP_BYTES.into()) as u8)
}
