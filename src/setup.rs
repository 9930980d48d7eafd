//! What a body runs with, as one block of bytes that an internal flash page holds.
//!
//! `"TMSU", format u8, 0 u8, length u16, generation u32, content, crc u32`, little-endian. The content is a log header
//! (settings and coefficients, see [`logbook`](crate::logbook)), then scalar sensor, grid, fluxgate and log size.

use crate::Settings;
use crate::compensation::Coefficients;
use crate::logbook::{Header, Record, truncated};
use crate::sensors::fluxgate::FluxgateSettings;
use crate::sensors::grid::GridSettings;
use crate::sensors::scalar::{ScalarFormat, ScalarSettings};
use crc::{CRC_32_ISO_HDLC, Crc};

/// Longest block, bytes.
pub const SETUP_LEN: usize = 512;

const MAGIC: [u8; 4] = *b"TMSU";
const FORMAT: u8 = 1;
const HEAD_LEN: usize = 12;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// All settings of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The core's.
    pub settings: Settings,
    /// Where the core starts from.
    pub coefficients: Coefficients,
    /// The scalar sensor's.
    pub scalar: ScalarSettings,
    /// Timing of both sensors.
    pub grid: GridSettings,
    /// Calibration of the fluxgate.
    pub fluxgate: FluxgateSettings,
    /// Size of a new log file, blocks of 512 bytes: 86,400 hold a day.
    pub log_blocks: u32,
}

impl Default for Setup {
    /// A body that nobody has set up: no coefficients, a QTFM Gen-1, a log of three days.
    fn default() -> Self {
        Self {
            settings: Settings::default(),
            coefficients: Coefficients::ZERO,
            scalar: ScalarSettings::QTFM_GEN1,
            grid: GridSettings::default(),
            fluxgate: FluxgateSettings::default(),
            log_blocks: 3 * 86_400,
        }
    }
}

impl Setup {
    /// The block and its length. The newer of two copies is the one with the higher `generation`. `None` when a
    /// setting has no place in the format.
    pub fn encode(&self, generation: u32) -> Option<([u8; SETUP_LEN], usize)> {
        let mut bytes = [0; SETUP_LEN];
        let mut put = Put { bytes: &mut bytes, at: HEAD_LEN };
        let header = Record::Header(self.header(""));
        put.at += header.encode(put.bytes.get_mut(put.at..)?)?;
        put.scalar(&self.scalar)?;
        put.grid(&self.grid)?;
        put.fluxgate(&self.fluxgate)?;
        put.u32(self.log_blocks)?;
        let end = put.at;
        let length = u16::try_from(end - HEAD_LEN).ok()?;
        let mut head = Put { bytes: &mut bytes, at: 0 };
        head.all(&MAGIC)?;
        head.all(&[FORMAT, 0])?;
        head.all(&length.to_le_bytes())?;
        head.u32(generation)?;
        let crc = CRC.checksum(bytes.get(..end)?);
        bytes.get_mut(end..end + 4)?.copy_from_slice(&crc.to_le_bytes());
        Some((bytes, end + 4))
    }

    /// The set-up and its generation; `None` when the bytes hold none that is whole.
    pub fn decode(bytes: &[u8]) -> Option<(Self, u32)> {
        let mut take = Take(bytes);
        if take.array()? != MAGIC || take.array()? != [FORMAT, 0] {
            return None;
        }
        let end = HEAD_LEN + usize::from(u16::from_le_bytes(take.array()?));
        let generation = take.u32()?;
        let crc = bytes.get(end..)?.first_chunk()?;
        if CRC.checksum(bytes.get(..end)?) != u32::from_le_bytes(*crc) {
            return None;
        }
        let mut take = Take(bytes.get(HEAD_LEN..end)?);
        let (Record::Header(header), used) = Record::decode(take.0).ok()? else { return None };
        take.0 = take.0.get(used..)?;
        let setup = Self {
            settings: header.settings,
            coefficients: header.coefficients,
            scalar: take.scalar()?,
            grid: take.grid()?,
            fluxgate: take.fluxgate()?,
            log_blocks: take.u32()?,
        };
        Some((setup, generation))
    }

    /// The newer of two copies that is whole.
    pub fn newest(copies: [&[u8]; 2]) -> Option<Self> {
        let [first, second] = copies.map(Self::decode);
        match (first, second) {
            // Generations wrap; the newer one is at most half a turn ahead.
            (Some((a, a_generation)), Some((b, b_generation))) => {
                Some(if (b_generation.wrapping_sub(a_generation) as i32) > 0 { b } else { a })
            }
            (one, other) => one.or(other).map(|(setup, _)| setup),
        }
    }

    /// The log header of a session that runs with this.
    pub fn header(&self, firmware_version: &str) -> Header {
        Header {
            firmware_version: truncated(firmware_version),
            build_hash: [0; 32],
            settings: self.settings,
            coefficients: self.coefficients,
            start_tick: 0,
            start_unix_ms: None,
        }
    }
}

struct Put<'a> {
    bytes: &'a mut [u8; SETUP_LEN],
    at: usize,
}

impl Put<'_> {
    fn all(&mut self, bytes: &[u8]) -> Option<()> {
        self.bytes.get_mut(self.at..self.at + bytes.len())?.copy_from_slice(bytes);
        self.at += bytes.len();
        Some(())
    }

    fn u32(&mut self, value: u32) -> Option<()> {
        self.all(&value.to_le_bytes())
    }

    fn f64s(&mut self, values: &[f64]) -> Option<()> {
        values.iter().try_for_each(|value| self.all(&value.to_le_bytes()))
    }

    fn scalar(&mut self, scalar: &ScalarSettings) -> Option<()> {
        let (code, counts_per_nt) = match scalar.format {
            ScalarFormat::G882 => (0, 0.0),
            ScalarFormat::QtfmGen1 { counts_per_nt } => (1, counts_per_nt),
            ScalarFormat::QtfmGen2(settings) if Some(settings) == recorded_gen2() => (2, 0.0),
            ScalarFormat::QtfmGen2(_) => return None,
        };
        self.all(&[code])?;
        self.f64s(&[counts_per_nt, scalar.lowest_nt, scalar.highest_nt])?;
        self.u32(scalar.weakest_signal)?;
        self.u32(scalar.strongest_signal)
    }

    fn grid(&mut self, grid: &GridSettings) -> Option<()> {
        let GridSettings { scalar_delay_us, flux_delay_us, latency_us, tolerance_us, conversions_per_epoch } = *grid;
        [scalar_delay_us, flux_delay_us, latency_us, tolerance_us].into_iter().try_for_each(|us| self.u32(us))?;
        self.all(&[conversions_per_epoch])
    }

    fn fluxgate(&mut self, fluxgate: &FluxgateSettings) -> Option<()> {
        self.f64s(&fluxgate.nt_per_count)?;
        self.f64s(&fluxgate.bias_nt)?;
        self.f64s(fluxgate.body_from_sensor.as_flattened())?;
        self.f64s(&[fluxgate.ampere_per_count, fluxgate.current_bias_a])
    }
}

struct Take<'a>(&'a [u8]);

impl Take<'_> {
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (array, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*array)
    }

    fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    fn f64s<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.f64()?;
        }
        Some(values)
    }

    fn scalar(&mut self) -> Option<ScalarSettings> {
        let [code] = self.array()?;
        let [counts_per_nt, lowest_nt, highest_nt] = self.f64s()?;
        let format = match code {
            0 => ScalarFormat::G882,
            1 => ScalarFormat::QtfmGen1 { counts_per_nt },
            2 => ScalarSettings::QTFM_GEN2.format,
            _ => return None,
        };
        let (weakest_signal, strongest_signal) = (self.u32()?, self.u32()?);
        Some(ScalarSettings { format, lowest_nt, highest_nt, weakest_signal, strongest_signal })
    }

    fn grid(&mut self) -> Option<GridSettings> {
        Some(GridSettings {
            scalar_delay_us: self.u32()?,
            flux_delay_us: self.u32()?,
            latency_us: self.u32()?,
            tolerance_us: self.u32()?,
            conversions_per_epoch: self.array().map(|[conversions]| conversions)?,
        })
    }

    fn fluxgate(&mut self) -> Option<FluxgateSettings> {
        Some(FluxgateSettings {
            nt_per_count: self.f64s()?,
            bias_nt: self.f64s()?,
            body_from_sensor: [self.f64s()?, self.f64s()?, self.f64s()?],
            ampere_per_count: self.f64()?,
            current_bias_a: self.f64()?,
        })
    }
}

fn recorded_gen2() -> Option<crate::sensors::scalar::QtfmGen2Settings> {
    match ScalarSettings::QTFM_GEN2.format {
        ScalarFormat::QtfmGen2(settings) => Some(settings),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for scalar in [ScalarSettings::G882, ScalarSettings::QTFM_GEN1, ScalarSettings::QTFM_GEN2] {
            let setup = Setup { scalar, log_blocks: 77, ..Setup::default() };
            let (bytes, len) = setup.encode(5).unwrap();
            assert_eq!(Setup::decode(&bytes[..len]), Some((setup, 5)));
        }
    }

    #[test]
    fn a_damaged_copy_falls_back_to_the_other() {
        let (old, _) = Setup { log_blocks: 1, ..Setup::default() }.encode(u32::MAX).unwrap();
        let (mut new, _) = Setup { log_blocks: 2, ..Setup::default() }.encode(0).unwrap();
        let blocks = |copies: [&[u8]; 2]| Setup::newest(copies).map(|setup| setup.log_blocks);
        assert_eq!(blocks([&old, &new]), Some(2));
        assert_eq!(blocks([&new, &old]), Some(2));
        new[100] ^= 1;
        assert_eq!(blocks([&old, &new]), Some(1));
        assert_eq!(blocks([&[0xFF; 512], &[]]), None);
    }
}
