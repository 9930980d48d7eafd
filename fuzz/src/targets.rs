//! What is fuzzed: everything that takes bytes from outside. Each function takes any bytes and panics when a promise is
//! broken. `cargo fuzz` and the tests of the kept corpora call the same functions.

use crc::{CRC_32_ISO_HDLC, Crc};
use embedded_storage::nor_flash::{ErrorType, NorFlashErrorKind, ReadNorFlash};
use towmag::link::{Command, Frame, FrameReader, HousekeepingMessage, Input, LineReader, Telemetry, parse};
use towmag::log::{Record, Records, Scan, Sector, SliceSource, Survey, order};
use towmag::sensors::ads131m04::AdcFrame;
use towmag::sensors::nmea::{DepthIs, NmeaSettings};
use towmag::sensors::scalar::{FORMATS, ScalarSettings};
use towmag::store::{FlashSectors, IMAGE_VERSION, SLOT_LEN, SettingsStore};

/// Every scalar sensor's parser: any bytes; afterwards two good sentences in a row are enough to get a reading.
pub fn scalar(data: &[u8]) {
    for format in FORMATS {
        let settings = ScalarSettings::of(format);
        let mut parser = settings.build().expect("a default");
        let sentence = settings.format.build().expect("a default").encode(50_000_000).expect("short enough");
        for (now_us, &byte) in data.iter().enumerate() {
            if let Some(reading) = parser.push(byte, now_us as u32) {
                assert!(!reading.valid || (1_000_000..=100_000_000).contains(&reading.scalar_pt));
            }
        }
        let twice = sentence.bytes().chain(sentence.bytes());
        let after = twice.filter(|&byte| parser.push(byte, 0).is_some()).count();
        assert!(after >= 1, "{} is deaf after {data:?}", format.name);
    }
}

/// The third UART: any bytes; values are within their ranges, and afterwards one good sentence is enough.
pub fn nmea(data: &[u8]) {
    for depth_is in [DepthIs::Depth, DepthIs::Altitude] {
        let mut parser = NmeaSettings { depth_is, ..NmeaSettings::default() }.build().expect("a default");
        // As they are, and each line with its checksum, which no fuzzer guesses.
        for &byte in data.iter().chain(&sealed_lines(data)) {
            let Some(report) = parser.push(byte, 7) else { continue };
            let told = report.navigation;
            assert!(!told.is_empty());
            assert!(told.depth_m.into_iter().chain(told.altitude_m).all(|metres| metres.abs() <= 12_000.0));
            assert!(told.heading.is_none_or(|heading| (0.0..=360.0).contains(&heading.deg)));
            assert!(told.position.is_none_or(|position| position.latitude_e7.abs() <= 900_000_000));
            assert!(told.position.is_none_or(|position| position.longitude_e7.abs() <= 1_800_000_000));
        }
        let after = b"\r\n$SDDPT,2.4,,*53\r\n".iter().filter(|&&byte| parser.push(byte, 0).is_some()).count();
        assert_eq!(after, 1, "deaf after {data:?}");
    }
}

fn sealed_lines(data: &[u8]) -> Vec<u8> {
    let lines = data.split(|&byte| byte == b'\n' || byte == b'\r').filter(|line| !line.is_empty());
    let seal = |line: &[u8]| {
        let line = line.strip_prefix(b"$").unwrap_or(line);
        let content = line.split(|&byte| byte == b'*').next().unwrap_or_default();
        let sum = content.iter().fold(0, |sum, byte| sum ^ byte);
        [b"$", content, format!("*{sum:02X}\r\n").as_bytes()].concat()
    };
    lines.flat_map(seal).collect()
}

/// The converter's frame: any 18 bytes; what is accepted has the CRC that it says.
pub fn adc_frame(data: &[u8]) {
    let mut bytes = [0; 18];
    let len = data.len().min(bytes.len());
    bytes[..len].copy_from_slice(&data[..len]);
    if let Ok(frame) = AdcFrame::decode(&bytes) {
        assert!(frame.counts.iter().all(|count| (-0x80_0000..=0x7F_FFFF).contains(count)));
        bytes[3] ^= 1;
        assert!(AdcFrame::decode(&bytes).is_err());
    }
}

/// The log's records, sectors and recovery: any bytes as a record, as a sector, as a card.
pub fn log(data: &[u8]) {
    if let Ok((record, len)) = Record::decode(data) {
        let mut again = [0; Record::MAX_LEN];
        let written = record.encode(&mut again).expect("what was read can be written");
        assert_eq!(Record::decode(&again[..written]).map(|(_, len)| len), Ok(written));
        assert!(len <= data.len());
    }
    let mut block = [0; 512];
    let len = data.len().min(block.len());
    block[..len].copy_from_slice(&data[..len]);
    if let Ok(sector) = Sector::parse(&block) {
        sector.records().for_each(drop);
    }
    let mut card = SliceSource(data);
    let mut survey = Survey::default();
    let mut keys: Vec<_> = Scan::new(&mut card).filter_map(|found| survey.count(found)).collect();
    let sectors = order(&mut keys);
    assert!(Records::new(&mut card, &keys[..sectors]).count() <= 2 * data.len() + 2);
}

/// The console: any bytes; afterwards a good line is understood.
pub fn console(data: &[u8]) {
    let mut reader = LineReader::default();
    for &byte in data {
        let _ = reader.push(byte);
    }
    let understood = b"\nstatus\n".iter().filter_map(|&byte| reader.push(byte)).last();
    assert_eq!(understood, Some(Input::Command(Command::Status)), "deaf after {data:?}");
    if let Ok(line) = core::str::from_utf8(data) {
        let _ = parse(line);
    }
}

/// The ship's end of the cable: any bytes, as frames and as the body of a frame.
pub fn telemetry(data: &[u8]) {
    let mut reader = FrameReader::default();
    for &byte in data {
        let _ = reader.push(byte);
    }
    let is_whole = |frame: Frame| {
        let mut reader = FrameReader::default();
        frame.iter().any(|&byte| reader.push(byte).is_some())
    };
    assert!(Telemetry::decode(data).is_none_or(|message| is_whole(message.frame())));
    assert!(HousekeepingMessage::decode(data).is_none_or(|message| is_whole(message.frame())));
}

/// The settings in flash: any contents of the two sectors; what is read from them is valid.
pub fn settings(data: &[u8]) {
    struct Flash([u8; 4 * SLOT_LEN]);
    impl ErrorType for Flash {
        type Error = NorFlashErrorKind;
    }
    impl ReadNorFlash for Flash {
        const READ_SIZE: usize = 1;
        fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
            let start = offset as usize;
            let source = self.0.get(start..start + bytes.len()).ok_or(NorFlashErrorKind::OutOfBounds)?;
            bytes.copy_from_slice(source);
            Ok(())
        }
        fn capacity(&self) -> usize {
            self.0.len()
        }
    }
    let open = |contents: &[u8]| {
        let mut flash = Flash([0xFF; 4 * SLOT_LEN]);
        let len = contents.len().min(flash.0.len());
        flash.0[..len].copy_from_slice(&contents[..len]);
        let sector_len = 2 * SLOT_LEN as u32;
        let region = FlashSectors { sectors: [0, sector_len], sector_len };
        let (_, opened) = SettingsStore::open(&mut flash, region).expect("the region fits");
        if let Some(stored) = opened.stored {
            assert!(stored.settings.validate().is_ok());
        }
    };
    open(data);
    open(&sealed(data));
}

/// An image whose CRC is right and whose content is `data`: no fuzzer guesses a CRC.
fn sealed(data: &[u8]) -> Vec<u8> {
    let content = &data[..data.len().min(SLOT_LEN - 16)];
    let mut image = b"TMST".to_vec();
    image.extend(IMAGE_VERSION.to_le_bytes());
    image.extend((content.len() as u16).to_le_bytes());
    image.extend(1_u32.to_le_bytes());
    image.extend(content);
    let crc = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&image);
    image.extend(crc.to_le_bytes());
    image
}
