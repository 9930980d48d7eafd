//! Settings and coefficients in a flash that can lose its power at any byte.

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use towmag::estimate::Information;
use towmag::model::{Coefficients, TERMS};
use towmag::sensors::nmea::DepthIs;
use towmag::sensors::scalar;
use towmag::store::{
    BodySettings, CABLE_BAUD, Condition, FlashSectors, LONGEST_NAME, Parameter, SLOT_LEN, SetError, SettingsStore,
    StoreError, Stored,
};

const SECTOR_LEN: usize = 4 * SLOT_LEN;
const REGION: FlashSectors =
    FlashSectors { sectors: [SECTOR_LEN as u32, 3 * SECTOR_LEN as u32], sector_len: SECTOR_LEN as u32 };
const CAPACITY: usize = 4 * SECTOR_LEN;

/// Bytes that an erasure gets through between two possible cuts.
const ERASE_STEP: usize = 64;

#[derive(Clone, Copy, Debug, PartialEq)]
enum MockError {
    /// The power is gone.
    Off,
    /// A word of the flash is worn.
    Worn,
}

impl NorFlashError for MockError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

/// A NOR flash: writing only clears bits, erasing sets those of a sector, and either can be cut anywhere. It panics
/// when it is used as a real one must not be.
#[derive(Clone)]
struct MockFlash<const WRITE: usize> {
    bytes: Vec<u8>,
    /// Steps until the power goes: bytes written, or pieces erased.
    power: Option<u64>,
    steps: u64,
    erasures: u32,
    /// What a cut leaves in the word or piece that it falls into.
    random: ChaCha8Rng,
    /// Offsets that keep none of their bits.
    worn: Vec<usize>,
    reports_wear: bool,
}

impl<const WRITE: usize> MockFlash<WRITE> {
    fn new() -> Self {
        let random = ChaCha8Rng::seed_from_u64(1);
        let bytes = vec![0xff; CAPACITY];
        Self { bytes, power: None, steps: 0, erasures: 0, random, worn: Vec::new(), reports_wear: false }
    }

    /// One step; false when the power goes during it.
    fn step(&mut self) -> bool {
        self.steps += 1;
        match &mut self.power {
            Some(0) => false,
            Some(left) => {
                *left -= 1;
                true
            }
            None => true,
        }
    }

    fn is_off(&self) -> bool {
        self.power == Some(0)
    }

    fn in_region(offset: usize) -> bool {
        REGION.sectors.iter().any(|&start| (start as usize..start as usize + SECTOR_LEN).contains(&offset))
    }
}

impl<const WRITE: usize> ErrorType for MockFlash<WRITE> {
    type Error = MockError;
}

impl<const WRITE: usize> ReadNorFlash for MockFlash<WRITE> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), MockError> {
        if self.is_off() {
            return Err(MockError::Off);
        }
        let start = offset as usize;
        bytes.copy_from_slice(&self.bytes[start..start + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl<const WRITE: usize> NorFlash for MockFlash<WRITE> {
    const WRITE_SIZE: usize = WRITE;
    const ERASE_SIZE: usize = SECTOR_LEN;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), MockError> {
        let (from, to) = (from as usize, to as usize);
        assert!(from.is_multiple_of(SECTOR_LEN) && to.is_multiple_of(SECTOR_LEN) && from < to, "whole sectors");
        assert!(to <= CAPACITY && Self::in_region(from), "no other sector");
        self.erasures += 1;
        for start in (from..to).step_by(ERASE_STEP) {
            if self.is_off() {
                return Err(MockError::Off);
            }
            let whole = self.step();
            for byte in &mut self.bytes[start..start + ERASE_STEP] {
                // Cut short, some of the bits are set and others not yet.
                *byte |= if whole { 0xff } else { self.random.next_u32() as u8 };
            }
            if !whole {
                self.power = Some(0);
                return Err(MockError::Off);
            }
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), MockError> {
        let offset = offset as usize;
        assert!(offset.is_multiple_of(WRITE) && bytes.len().is_multiple_of(WRITE), "whole words");
        assert!(Self::in_region(offset) && Self::in_region(offset + bytes.len() - 1), "not beyond the region");
        assert!(self.bytes[offset..offset + bytes.len()].iter().all(|&byte| byte == 0xff), "nothing written twice");
        for (word, start) in bytes.chunks(WRITE).zip((offset..).step_by(WRITE)) {
            if self.is_off() {
                return Err(MockError::Off);
            }
            let whole = self.step();
            for (place, &byte) in (start..).zip(word) {
                self.bytes[place] &= if whole { byte } else { byte | self.random.next_u32() as u8 };
                if self.worn.contains(&place) {
                    self.bytes[place] = 0xff;
                    if self.reports_wear {
                        return Err(MockError::Worn);
                    }
                }
            }
            if !whole {
                self.power = Some(0);
                return Err(MockError::Off);
            }
        }
        Ok(())
    }
}

/// Different settings for every number, of every format.
fn version(number: u32) -> Stored {
    let mut stored = Stored::default();
    let format = ["g882", "qtfm-gen1", "qtfm-gen2", "qtfm-gen2-counts"][number as usize % 4];
    Parameter::named("scalar_format").unwrap().set(&mut stored.settings, format).unwrap();
    stored.settings.fluxgate.bias_nt[1] = f64::from(number) + 0.1;
    stored.settings.log = number.is_multiple_of(2);
    if number > 0 {
        stored.settings.nmea.baud = 9_600 + number;
        stored.settings.nmea.depth_is = DepthIs::Depth;
        stored.settings.nmea.surface_dbar = 10.1;
        stored.settings.housekeeping.battery_v_per_count = 0.008_86;
        stored.settings.housekeeping.is_leak_fitted = true;
        stored.settings.channels.altitude_bias_m = -f64::from(number);
    }
    let mut theta = [0.0; TERMS];
    for (i, value) in theta.iter_mut().enumerate() {
        *value = number as f32 * 1.25 + i as f32 / 3.0;
    }
    stored.coefficients = Coefficients::from_basis(theta).unwrap();
    let triangle = core::array::from_fn(|i| (number as f32 + i as f32) / 7.0);
    stored.information = Information::new(stored.coefficients, triangle, 0.25).filter(|_| !number.is_multiple_of(3));
    let triangle = core::array::from_fn(|i| (number as f32 + i as f32) / 11.0);
    stored.level = Information::new(stored.coefficients, triangle, 0.125).filter(|_| number % 3 == 1);
    stored
}

#[test]
fn what_is_stored_is_found_again() {
    let mut flash = MockFlash::<1>::new();
    let (mut store, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
    assert_eq!((opened.stored, opened.condition), (None, Condition::Fresh));
    for number in 0..40 {
        store.save(&mut flash, &version(number)).unwrap();
        if number % 3 == 0 {
            let opened;
            (store, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
            assert_eq!((opened.stored, opened.condition), (Some(version(number)), Condition::Intact), "{number}");
        }
    }
    assert_eq!(flash.erasures, 10, "once per sector of four slots");
}

/// Save after save with the power going at step `cut`, again at `again` steps after each restart: what is found is the last
/// that was stored or the one that was being stored.
fn sweep<const WRITE: usize>(mut flash: MockFlash<WRITE>, first: u32, cut: u64, again: &[u64]) -> Vec<Condition> {
    let mut conditions = Vec::new();
    let mut acknowledged = (first > 0).then(|| version(first - 1));
    let mut number = first;
    for &cut in [cut].iter().chain(again) {
        flash.power = None;
        let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
        flash.power = Some(cut);
        let attempted = loop {
            match store.save(&mut flash, &version(number)) {
                Ok(()) => acknowledged = Some(version(number)),
                Err(StoreError::Flash(MockError::Off)) => break version(number),
                Err(error) => panic!("{error}"),
            }
            number += 1;
        };
        number += 1;
        flash.power = None;
        let (_, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
        let is_new = opened.stored == Some(attempted);
        assert!(is_new || opened.stored == acknowledged, "cut {cut}: {:?}", opened.condition);
        if is_new || acknowledged.is_some() {
            assert!(matches!(opened.condition, Condition::Intact | Condition::FellBack), "{:?}", opened.condition);
        }
        if is_new {
            assert_eq!(opened.condition, Condition::Intact);
        }
        acknowledged = opened.stored;
        conditions.push(opened.condition);
    }
    conditions
}

/// A flash after some saves, so that cuts meet blank slots, the last slot and an erasure.
fn used<const WRITE: usize>(saves: u32) -> MockFlash<WRITE> {
    let mut flash = MockFlash::new();
    let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
    for number in 0..saves {
        store.save(&mut flash, &version(number)).unwrap();
    }
    flash
}

#[test]
fn power_cut_at_every_step() {
    let mut fell_back = 0;
    for saves in [0, 1, 3, 4, 7, 8] {
        let flash = used::<1>(saves);
        // Two saves: with or without an erasure between.
        for cut in 0..(2 * SLOT_LEN + 2 * SECTOR_LEN / ERASE_STEP) as u64 {
            let conditions = sweep(flash.clone(), saves, cut, &[]);
            fell_back += conditions.iter().filter(|&&condition| condition == Condition::FellBack).count();
        }
    }
    assert!(fell_back > 2000, "{fell_back}");
}

#[test]
fn power_cut_at_every_word() {
    for saves in [0, 3, 4] {
        let flash = used::<8>(saves);
        for cut in 0..(2 * SLOT_LEN / 8 + 2 * SECTOR_LEN / ERASE_STEP) as u64 {
            sweep(flash.clone(), saves, cut, &[cut / 2, 3, cut]);
        }
    }
}

/// A cut that leaves anything of a new image behind does not go unnoticed.
#[test]
fn a_torn_write_says_so() {
    let flash = used::<1>(2);
    for cut in 1..330 {
        assert_eq!(sweep(flash.clone(), 2, cut, &[]), [Condition::FellBack], "{cut}");
    }
}

#[test]
fn a_torn_erasure_says_so_when_it_shows() {
    let flash = used::<1>(4);
    for cut in 2..(SECTOR_LEN / ERASE_STEP) as u64 {
        // The other sector was blank before: nothing of the erasure can show. After eight saves it was not.
        assert_eq!(sweep(flash.clone(), 4, cut, &[]), [Condition::Intact]);
    }
    let flash = used::<1>(8);
    // Up to the last piece that holds any of the last image; then all is blank.
    for cut in 0..((3 * SLOT_LEN + 300) / ERASE_STEP) as u64 {
        let conditions = sweep(flash.clone(), 8, cut, &[]);
        assert!(conditions == [Condition::FellBack] || cut == 0, "{cut}: {conditions:?}");
    }
}

#[test]
fn a_torn_write_is_forgotten_after_the_next() {
    let mut flash = used::<1>(1);
    let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
    flash.power = Some(100);
    assert_eq!(store.save(&mut flash, &version(1)), Err(StoreError::Flash(MockError::Off)));
    flash.power = None;
    let (mut store, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
    assert_eq!((opened.stored, opened.condition), (Some(version(0)), Condition::FellBack));
    store.save(&mut flash, &version(2)).unwrap();
    let (_, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
    assert_eq!((opened.stored, opened.condition), (Some(version(2)), Condition::Intact));
}

#[test]
fn a_worn_slot_is_stepped_over() {
    for reports_wear in [false, true] {
        let mut flash = used::<1>(1);
        flash.reports_wear = reports_wear;
        flash.worn = vec![REGION.sectors[0] as usize + SLOT_LEN + 20, REGION.sectors[0] as usize + 2 * SLOT_LEN];
        let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
        store.save(&mut flash, &version(5)).unwrap();
        let (_, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
        assert_eq!((opened.stored, opened.condition), (Some(version(5)), Condition::Intact));
    }
}

#[test]
fn a_worn_flash_keeps_what_it_has() {
    let mut flash = used::<1>(2);
    flash.worn = (REGION.sectors[0] as usize + 2 * SLOT_LEN..CAPACITY).collect();
    for _ in 0..5 {
        let (mut store, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
        assert_eq!(opened.stored, Some(version(1)));
        for number in 5..20 {
            assert_eq!(store.save(&mut flash, &version(number)), Err(StoreError::NotStored));
        }
    }
}

#[test]
fn settings_that_are_not_valid_are_not_stored() {
    let mut flash = used::<1>(1);
    let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
    let mut wrong = version(3);
    wrong.settings.estimator.forgetting = f64::NAN;
    assert!(matches!(store.save(&mut flash, &wrong), Err(StoreError::Settings(_))));
    wrong = version(3);
    wrong.settings.estimator.band_pass.sample_rate_hz = 20.0;
    assert!(matches!(store.save(&mut flash, &wrong), Err(StoreError::Settings(_))));
    assert_eq!(SettingsStore::open(&mut flash, REGION).unwrap().1.stored, Some(version(0)));
}

#[test]
fn an_image_of_another_firmware_is_kept_and_told() {
    let mut flash = used::<1>(1);
    // The same image with another version and a higher sequence number, its CRC made anew.
    let start = REGION.sectors[0] as usize;
    let mut other = flash.bytes[start..start + SLOT_LEN].to_vec();
    let len = 12 + usize::from(u16::from_le_bytes([other[6], other[7]]));
    other[4] += 1;
    other[8] = 77;
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&other[..len]);
    other[len..len + 4].copy_from_slice(&crc.to_le_bytes());
    flash.bytes[start + SLOT_LEN..start + 2 * SLOT_LEN].copy_from_slice(&other);
    let (mut store, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
    assert_eq!((opened.stored, opened.condition), (Some(version(0)), Condition::OtherVersion));
    store.save(&mut flash, &version(9)).unwrap();
    let opened = SettingsStore::open(&mut flash, REGION).unwrap().1;
    assert_eq!((opened.stored, opened.condition), (Some(version(9)), Condition::Intact));
}

/// Bytes of the baud rate of the cable, which version 2 lacks, of third UART and channels, which came with version 4, of leak
/// and battery, which came with version 5, and of a level that is not there, which came with version 6.
const CABLE_BAUD_LEN: usize = 4;
const NMEA_LEN: usize = 4 + 1 + 8 + 4 * 8;
const HOUSEKEEPING_LEN: usize = 8 + 8 + 1;
const LEVEL_LEN: usize = 1;

#[test]
fn images_of_earlier_versions_are_read() {
    for (version_number, from, lacks) in [
        (2, 0, CABLE_BAUD_LEN + NMEA_LEN + HOUSEKEEPING_LEN),
        (3, CABLE_BAUD_LEN, NMEA_LEN + HOUSEKEEPING_LEN),
        (4, CABLE_BAUD_LEN + NMEA_LEN, HOUSEKEEPING_LEN),
        (5, CABLE_BAUD_LEN + NMEA_LEN + HOUSEKEEPING_LEN, 0),
    ] {
        let mut flash = used::<1>(1);
        let start = REGION.sectors[0] as usize;
        let slot = flash.bytes[start..start + SLOT_LEN].to_vec();
        let payload_len = usize::from(u16::from_le_bytes([slot[6], slot[7]]));
        let baud = CABLE_BAUD.to_le_bytes();
        let place = from + slot.windows(4).position(|bytes| bytes == baud).unwrap();
        let mut old = [&slot[..place], &slot[place + lacks..12 + payload_len - LEVEL_LEN]].concat();
        old[4] = version_number;
        old[6..8].copy_from_slice(&((payload_len - lacks - LEVEL_LEN) as u16).to_le_bytes());
        old.extend_from_slice(&crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&old).to_le_bytes());
        old.resize(SLOT_LEN, 0xff);
        flash.bytes[start..start + SLOT_LEN].copy_from_slice(&old);
        let (_, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
        assert_eq!((opened.stored, opened.condition), (Some(version(0)), Condition::Intact), "{version_number}");
    }
}

/// Version 6 holds a level in columns that are no longer used: its coefficients would be wrong in others.
#[test]
fn a_level_of_version_6_is_left_aside() {
    let mut flash = MockFlash::<1>::new();
    let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
    let level = Information::new(Coefficients::ZERO, [0.5; TERMS * (TERMS + 1) / 2], 0.3);
    let with_level = Stored { level, ..version(3) };
    store.save(&mut flash, &with_level).unwrap();
    assert_eq!(SettingsStore::open(&mut flash, REGION).unwrap().1.stored, Some(with_level));
    let start = REGION.sectors[0] as usize;
    let slot = &mut flash.bytes[start..start + SLOT_LEN];
    let len = 12 + usize::from(u16::from_le_bytes([slot[6], slot[7]]));
    slot[4] = 6;
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&slot[..len]);
    slot[len..len + 4].copy_from_slice(&crc.to_le_bytes());
    let (_, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
    assert_eq!((opened.stored, opened.condition), (Some(Stored { level: None, ..version(3) }), Condition::Intact));
}

#[test]
fn regions_that_do_not_fit_are_refused() {
    let len = SECTOR_LEN as u32;
    for (sectors, sector_len) in [
        ([0, 0], len),
        ([0, len / 2], len),
        ([0, CAPACITY as u32], len),
        ([0, u32::MAX], len),
        ([0, len], 0),
        ([0, len], 100),
        ([0, len], u32::MAX),
    ] {
        let opened = SettingsStore::open(&mut MockFlash::<1>::new(), FlashSectors { sectors, sector_len });
        assert_eq!(opened.unwrap_err(), StoreError::Region, "{sectors:?} {sector_len}");
    }
}

proptest! {
    #[test]
    fn several_cuts(saves in 0_u32..9, cut in 0_u64..2500, again in proptest::collection::vec(0_u64..1500, 1..6), seed: u64) {
        let mut flash = used::<1>(saves);
        flash.random = ChaCha8Rng::seed_from_u64(seed);
        sweep(flash, saves, cut, &again);
    }

    /// Whatever the flash holds: no panic, and the next save holds.
    #[test]
    fn arbitrary_contents(
        saves in 0_u32..9,
        damage in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>(), 1_usize..700), 0..30),
        seed: u64,
        all_random: bool,
    ) {
        let mut flash = used::<1>(saves);
        if all_random {
            ChaCha8Rng::seed_from_u64(seed).fill_bytes(&mut flash.bytes);
        }
        for (place, byte, len) in damage {
            let place = place.index(CAPACITY);
            let end = (place + len).min(CAPACITY);
            flash.bytes[place..end].fill(byte);
        }
        let (mut store, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
        if let Some(stored) = opened.stored {
            prop_assert!((0..saves).any(|number| stored == version(number)));
        }
        store.save(&mut flash, &version(99)).unwrap();
        let opened = SettingsStore::open(&mut flash, REGION).unwrap().1;
        prop_assert_eq!(opened.stored, Some(version(99)));
        // In the last slot of its sector, damage in the other one looks like an erasure that was cut.
        prop_assert!(matches!(opened.condition, Condition::Intact | Condition::FellBack));
    }

    /// A payload with an intact CRC around any bytes at all.
    #[test]
    fn arbitrary_payloads(payload in proptest::collection::vec(any::<u8>(), 0..=496), seed: u64, version: bool, valid_start: bool) {
        let mut flash = used::<1>(1);
        let start = REGION.sectors[0] as usize;
        let mut image = flash.bytes[start..start + 12].to_vec();
        if !version {
            image[4] = seed as u8;
        }
        image[6..8].copy_from_slice(&(payload.len() as u16).to_le_bytes());
        image[8..12].copy_from_slice(&((seed >> 8) as u32).to_le_bytes());
        let own = flash.bytes[start + 12..start + 12 + payload.len()].to_vec();
        image.extend_from_slice(&payload);
        if valid_start {
            let half = payload.len() / 2;
            image[12..12 + half].copy_from_slice(&own[..half]);
        }
        let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&image);
        image.extend_from_slice(&crc.to_le_bytes());
        flash.bytes[start..start + image.len()].copy_from_slice(&image);
        let (_, opened) = SettingsStore::open(&mut flash, REGION).unwrap();
        prop_assert!(opened.stored.is_none_or(|stored| stored.settings.validate().is_ok()));
    }

    #[test]
    fn any_text_as_a_value(name in any::<proptest::sample::Index>(), text in "\\PC{0,32}|[0-9eE.+-]{1,20}") {
        let parameters: Vec<_> = Parameter::all().collect();
        let mut settings = BodySettings::default();
        if parameters[name.index(parameters.len())].set(&mut settings, &text).is_err() {
            prop_assert_eq!(settings, BodySettings::default());
        }
        prop_assert!(settings.validate().is_ok());
    }

    #[test]
    fn numbers_come_back_to_the_bit(value in -1e3_f64..1e3, scale in -320_i32..0) {
        let value = value * 10_f64.powi(scale);
        let parameter = Parameter::named("current_bias_a").unwrap();
        let mut settings = BodySettings::default();
        settings.fluxgate.current_bias_a = value;
        let text = parameter.get(&settings).unwrap();
        parameter.set(&mut settings, &text).unwrap();
        prop_assert_eq!(settings.fluxgate.current_bias_a.to_bits(), value.to_bits());
    }
}

#[test]
fn every_parameter_can_be_read_and_set_to_what_it_is() {
    for number in 0..4 {
        let stored = version(number);
        let mut with_value = 0;
        for parameter in Parameter::all() {
            let mut settings = stored.settings;
            assert_eq!(Parameter::named(parameter.name()), Some(parameter));
            assert!(parameter.name().len() <= LONGEST_NAME);
            match parameter.get(&settings) {
                // A format brings its own limits: it alone sets more than itself.
                Some(value) => {
                    parameter.set(&mut settings, &value).unwrap();
                    assert_eq!(settings, stored.settings, "{}", parameter.name());
                    with_value += 1;
                }
                None => assert_eq!(parameter.set(&mut settings, "1"), Err(SetError::NotInFormat)),
            }
        }
        // All but those that other formats have of their own.
        let of_formats = scalar::parameters().count();
        assert_eq!(with_value, Parameter::all().count() - of_formats + [0, 1, 4, 4][number as usize]);
    }
}

/// Bytes of the image of these settings, from the scalar sensor's tag on.
fn scalar_bytes(settings: BodySettings) -> Vec<u8> {
    const TAG: usize = 12 + 58;
    let mut flash = MockFlash::<1>::new();
    let (mut store, _) = SettingsStore::open(&mut flash, REGION).unwrap();
    store.save(&mut flash, &Stored { settings, ..Stored::default() }).unwrap();
    flash.bytes[REGION.sectors[0] as usize + TAG..][..16].to_vec()
}

/// Settings that lie in a body's flash are read by every later firmware.
#[test]
fn formats_lie_in_the_flash_as_ever() {
    let counts = 6009.342147_f64.to_le_bytes();
    let lowest = 1_000.0_f64.to_le_bytes();
    for (name, own) in [
        ("g882", vec![0]),
        ("qtfm-gen1", [&[1], &counts[..]].concat()),
        ("qtfm-gen2", vec![2, 3, b'_', b'*', 1]),
        ("qtfm-gen2-counts", [&[3], &counts[..], b"_*\x01"].concat()),
        ("seaspy", vec![4, 6]),
    ] {
        let mut settings = BodySettings::default();
        Parameter::named("scalar_format").unwrap().set(&mut settings, name).unwrap();
        let expected = [own, lowest.to_vec()].concat();
        let expected = &expected[..expected.len().min(16)];
        assert_eq!(&scalar_bytes(settings)[..expected.len()], expected, "{name}");
    }
    let tags: std::collections::BTreeSet<u8> = scalar::FORMATS.iter().map(|format| format.tag).collect();
    assert_eq!(tags.len(), scalar::FORMATS.len());
}

#[test]
fn settings_are_refused_with_a_reason() {
    let mut settings = BodySettings::default();
    let mut set = |name: &str, value: &str| {
        Parameter::named(name).unwrap().set(&mut settings, value).map_err(|error| error.to_string())
    };
    assert_eq!(set("forgetting", "0.5").unwrap_err(), "forgetting is 0.5: choose above 0.9, at most 1");
    assert_eq!(set("forgetting", "abc").unwrap_err(), "choose a number");
    assert_eq!(set("method", "best").unwrap_err(), "choose none, fixed, rls, saddle-point or adaptive");
    assert_eq!(set("gen2_decimals", "3").unwrap_err(), "the chosen scalar_format does not have it");
    let names: Vec<_> = scalar::FORMATS.iter().map(|format| format.name).collect();
    let (last, others) = names.split_last().unwrap();
    let expected = format!("choose {} or {last}", others.join(", "));
    assert_eq!(set("scalar_format", "compass").unwrap_err(), expected);
    assert!(set("band_low_hz", "2").is_err() && set("scalar_lowest_nt", "99999").is_ok());
    assert!(set("scalar_highest_nt", "50000").is_err(), "below the lowest");
}
