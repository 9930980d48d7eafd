//! The emulated body over all its lives: its card, its flash, and what comes up its cable.

use std::path::{Path, PathBuf};

use towmag::housekeeping::HousekeepingSample;
use towmag::sensors::ads131m04::FRAME_BYTES;
use towmag::store::Stored;

use super::error::EmulatorError;
use super::life::{Life, complaint};
use super::onlooker::Onlooker;
use super::twin::{CONVERTED, Event, WET};
use crate::output::AsideFolder;

/// Where `cargo fw-emu` puts the image.
pub const DEFAULT_IMAGE: &str = "target/emulation/thumbv7em-none-eabihf/firmware/firmware";

/// Frame of the last request before the body starts anew.
const FAREWELL: [u8; FRAME_BYTES] = [0xff; FRAME_BYTES];

/// Starts in a row without a request, after which there is no use in another.
const VAIN_STARTS: u32 = 3;

fn flag(is_set: bool, flag: u8) -> u8 {
    if is_set { flag } else { 0 }
}

/// One SPI transaction of the body.
pub(super) struct Request {
    pub(super) frame: [u8; FRAME_BYTES],
    /// Data-ready edges since the body's start.
    pub(super) conversions: u32,
    pub(super) events: Vec<Event>,
}

impl Request {
    fn decode(bytes: &[u8]) -> Result<Self, EmulatorError> {
        let broken = || EmulatorError::Broken("the firmware speaks another bridge protocol: build it again".into());
        let (&frame, rest) = bytes.split_first_chunk::<FRAME_BYTES>().ok_or_else(broken)?;
        let (&conversions, events) = rest.split_first_chunk::<4>().ok_or_else(broken)?;
        let events = events.as_chunks::<5>().0.iter().map(|event| Event::decode(*event));
        let events = events.collect::<Option<Vec<_>>>();
        let events = events.ok_or_else(|| EmulatorError::Broken("the body has lost events".into()))?;
        Ok(Self { frame, conversions: u32::from_le_bytes(conversions), events })
    }

    /// Whether this only tells what has happened, and the body starts anew: nobody waits for an answer.
    pub(super) fn is_farewell(&self) -> bool {
        self.frame == FAREWELL
    }
}

/// The emulated body.
pub(super) struct Machine {
    image: PathBuf,
    folder: AsideFolder,
    onlooker: Option<Onlooker>,
    life: Life,
    /// Sent by the sensors with UARTs in this life.
    sensor_bytes: u32,
    power_was_cut: bool,
    vain_starts: u32,
    /// What came up the cable in the lives before this.
    cables: Vec<Vec<u8>>,
}

impl Machine {
    /// Start the firmware of `image` with these settings and an empty card.
    pub(super) fn start(
        image: &Path,
        stored: &Stored,
        card_blocks: u32,
        onlooker: Option<Onlooker>,
    ) -> Result<Self, EmulatorError> {
        let image = image.canonicalize().map_err(|_| EmulatorError::NoImage { path: image.display().to_string() })?;
        let folder = AsideFolder::new().map_err(EmulatorError::io("temporary folder"))?;
        super::flash::write(&folder.path().join("flash.img"), stored).map_err(EmulatorError::io("flash"))?;
        super::card::format(&folder.path().join("card.img"), card_blocks).map_err(EmulatorError::io("card"))?;
        let life = Life::begin(&image, folder.path(), onlooker.clone())?;
        let (sensor_bytes, power_was_cut, vain_starts, cables) = (0, false, 0, Vec::new());
        Ok(Self { image, folder, onlooker, life, sensor_bytes, power_was_cut, vain_starts, cables })
    }

    /// The next transaction; `None` at the end of a life.
    pub(super) fn request(&mut self) -> Result<Option<Request>, EmulatorError> {
        let Some(bytes) = self.life.request()? else { return Ok(None) };
        self.vain_starts = 0;
        Request::decode(&bytes).map(Some)
    }

    /// Send what the scalar sensor and the depth sensor send at this conversion, then the converter's answer, and leak and
    /// battery with it.
    pub(super) fn answer(
        &mut self,
        frame: &[u8; FRAME_BYTES],
        sentence: &[u8],
        nmea: &[u8],
        housekeeping: HousekeepingSample,
        command: u8,
    ) -> Result<(), EmulatorError> {
        if !sentence.is_empty() {
            self.life.send_scalar(sentence)?;
        }
        if !nmea.is_empty() {
            self.life.send_nmea(nmea)?;
        }
        self.sensor_bytes = self.sensor_bytes.wrapping_add((sentence.len() + nmea.len()) as u32);
        let mut answer = frame.to_vec();
        answer.extend_from_slice(&self.sensor_bytes.to_le_bytes());
        answer.push(command);
        answer.push(flag(housekeeping.is_wet, WET) | flag(housekeeping.battery_counts.is_some(), CONVERTED));
        answer.extend_from_slice(&housekeeping.battery_counts.unwrap_or(0).to_le_bytes());
        self.life.answer(&answer)
    }

    /// Type a line on the ship.
    pub(super) fn type_line(&mut self, line: &str) -> Result<(), EmulatorError> {
        self.life.send_console(format!("{line}\r\n").as_bytes())
    }

    /// Instead of an answer.
    pub(super) fn cut_power(&mut self) {
        self.power_was_cut = true;
        self.life.kill();
    }

    /// After the end of a life that was not the last: begin the next.
    pub(super) fn revive(&mut self) -> Result<(), EmulatorError> {
        self.end_life()?;
        self.vain_starts += 1;
        if self.vain_starts > VAIN_STARTS {
            return Err(EmulatorError::Broken("the body starts again and again".into()));
        }
        if std::mem::take(&mut self.power_was_cut) {
            // Gone with the power; it is not there either when no reset came before.
            _ = std::fs::remove_file(self.folder.path().join("retained.bin"));
        }
        self.sensor_bytes = 0;
        self.life = Life::begin(&self.image, self.folder.path(), self.onlooker.clone())?;
        Ok(())
    }

    fn end_life(&mut self) -> Result<(), EmulatorError> {
        let (ended_itself, cable) = self.life.end()?;
        self.cables.push(cable);
        if ended_itself || self.power_was_cut {
            return Ok(());
        }
        Err(EmulatorError::Broken(format!("the emulator has ended: {}", complaint(self.folder.path()))))
    }

    /// What the body's flash holds now.
    pub(super) fn stored(&self) -> Result<Stored, EmulatorError> {
        super::flash::read(&self.folder.path().join("flash.img")).map_err(EmulatorError::io("flash"))
    }

    /// After the last answer: everything that came up the cable, life by life, and the card, whose folder lives with
    /// the machine.
    pub(super) fn finish(&mut self) -> Result<(Vec<Vec<u8>>, PathBuf), EmulatorError> {
        self.end_life()?;
        Ok((std::mem::take(&mut self.cables), self.folder.path().join("card.img")))
    }
}
