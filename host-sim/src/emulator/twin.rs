//! The same body in this process: every byte and frame at the stamp that the emulated one has noted for it.

use std::collections::VecDeque;

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use towmag::housekeeping::{Housekeeper, Housekeeping, HousekeepingSample};
use towmag::sensors::ads131m04::FRAME_BYTES;
use towmag::store::Stored;
use towmag::{Pipeline, SettingsError};

use crate::wire::body::{Body, Made};

/// Flags of leak and battery in the bridge's protocol.
pub(super) const WET: u8 = 1;
pub(super) const CONVERTED: u8 = 2;

/// Something that the body has stamped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    ScalarByte(u32),
    Conversion(u32),
    Poll(u32),
    SetUp(u32),
    Boot,
    Housekeeping(HousekeepingSample),
}

impl Event {
    /// From the bridge's protocol; `None` when the body has lost events.
    pub(super) fn decode([kind, stamp @ ..]: [u8; 5]) -> Option<Self> {
        let stamp_us = u32::from_le_bytes(stamp);
        Some(match kind {
            1 => Self::ScalarByte(stamp_us),
            2 => Self::Conversion(stamp_us),
            3 => Self::Poll(stamp_us),
            4 => Self::SetUp(stamp_us),
            5 => Self::Boot,
            7 => {
                let [low, high, flags, _] = stamp;
                let battery_counts = (flags & CONVERTED != 0).then_some(u16::from_le_bytes([low, high]));
                Self::Housekeeping(HousekeepingSample { is_wet: flags & WET != 0, battery_counts })
            }
            _ => return None,
        })
    }

    /// Whether SPI transactions follow.
    pub(super) fn starts_transactions(self) -> bool {
        matches!(self, Self::Conversion(_) | Self::SetUp(_))
    }
}

/// The body, life by life.
pub(super) struct Twin {
    body: Body<Frames>,
    /// What the scalar sensor has sent and the body has not yet read.
    bytes: VecDeque<u8>,
    /// What it made of each of its lives.
    pub(super) sessions: Vec<Vec<Made>>,
    /// Of this life.
    housekeeper: Housekeeper,
    sampled: usize,
    /// What was told of leak and battery in each of its lives, with the tick.
    pub(super) housekeeping: Vec<Vec<(u32, Housekeeping)>>,
}

impl Twin {
    pub(super) fn new(stored: &Stored) -> Result<Self, SettingsError> {
        Ok(Self {
            body: Body::new(stored, Frames::default())?,
            bytes: VecDeque::new(),
            sessions: Vec::new(),
            housekeeper: Housekeeper::new(stored.settings.housekeeping),
            sampled: 0,
            housekeeping: Vec::new(),
        })
    }

    /// What the scalar sensor has sent.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// What the converter has answered.
    pub(super) fn answer(&mut self, frame: [u8; FRAME_BYTES]) {
        self.body.bus_mut().0.push_back(frame);
    }

    /// The core, as it is now.
    pub(super) fn pipeline(&self) -> &Pipeline {
        self.body.pipeline()
    }

    /// The body has started with what its flash holds: whatever was under way is gone.
    pub(super) fn boot(&mut self, stored: &Stored) -> Result<(), SettingsError> {
        (self.body, self.bytes) = (Body::new(stored, Frames::default())?, VecDeque::new());
        self.sessions.push(Vec::new());
        (self.housekeeper, self.sampled) = (Housekeeper::new(stored.settings.housekeeping), 0);
        self.housekeeping.push(Vec::new());
        Ok(())
    }

    /// Do what the body did at this event. [`Event::Boot`] is the caller's.
    pub(super) fn live(&mut self, event: Event) {
        match event {
            Event::ScalarByte(stamp_us) => {
                self.bytes.pop_front().into_iter().for_each(|byte| self.body.scalar_byte(byte, stamp_us));
            }
            Event::Conversion(stamp_us) => self.body.conversion(stamp_us),
            Event::SetUp(stamp_us) => self.body.set_up(stamp_us),
            Event::Poll(stamp_us) => {
                let made = self.body.poll(stamp_us);
                if let Some(session) = self.sessions.last_mut() {
                    session.extend(made);
                }
            }
            Event::Housekeeping(sample) => self.sample(sample),
            Event::Boot => {}
        }
    }

    /// Leak and battery of the next epoch: the body samples them once for each.
    fn sample(&mut self, sample: HousekeepingSample) {
        let made = self.sessions.last().and_then(|session| session.get(self.sampled));
        self.sampled += 1;
        let told = made.zip(self.housekeeper.step(sample));
        if let Some(life) = self.housekeeping.last_mut() {
            life.extend(told.map(|(made, news)| (made.record.epoch.tick, news.housekeeping)));
        }
    }
}

/// The frames that the emulated converter has answered with.
#[derive(Default)]
struct Frames(VecDeque<[u8; FRAME_BYTES]>);

impl ErrorType for Frames {
    type Error = ErrorKind;
}

impl SpiDevice for Frames {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let [Operation::TransferInPlace(bytes)] = operations else { return Err(ErrorKind::Other) };
        bytes.copy_from_slice(&self.0.pop_front().ok_or(ErrorKind::Other)?);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_of_leak_and_battery_is_an_event_without_a_stamp() {
        let sample = |is_wet, battery_counts| Some(Event::Housekeeping(HousekeepingSample { is_wet, battery_counts }));
        assert_eq!(Event::decode([7, 0xb0, 0x04, WET | CONVERTED, 0]), sample(true, Some(1_200)));
        assert_eq!(Event::decode([7, 0, 0, CONVERTED, 0]), sample(false, Some(0)));
        assert_eq!(Event::decode([7, 0, 0, WET, 0]), sample(true, None));
        assert_eq!(Event::decode([6, 0, 0, 0, 0]), None, "events were lost");
    }
}
