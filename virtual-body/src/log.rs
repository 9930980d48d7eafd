//! What the tests log, and how they read it back.

use std::collections::BTreeMap;

use embedded_sdmmc::{Mode, TimeSource, Timestamp, VolumeIdx, VolumeManager};
use towmag::log::{
    BlockBytes, BlockSource, EpochRecord, FileMap, Header, LogFile, Maker, NewFile, Record, Records, Recovered, Scan,
    SectorKey, SectorWriter, SliceSource, Survey, VolumeError, order,
};
use towmag::model::Coefficients;
use towmag::{Compensated, Epoch, Output, Settings, Status};

use super::disk::{Disk, DiskError, Shared};

/// An epoch record that is different for every tick, in every byte that it can be.
pub fn epoch(tick: u32) -> Record {
    let value = |k: u32| f32::from_bits(0x4000_0000 + tick.wrapping_mul(2_654_435_761).rotate_left(k) % 0x0700_0000);
    let epoch =
        Epoch { tick, scalar_pt: Some(50_000_000 + tick as i32), flux_nt: Some([value(1), value(2), value(3)]) };
    let compensated = Compensated {
        interference_nt: value(4),
        compensated_pt: tick as i32,
        band_passed_nt: value(5),
        residual_nt: value(6),
        residual_after_update_nt: value(7),
    };
    let output = Output { tick, status: Status::Used, compensated: Some(compensated) };
    Record::Epoch(EpochRecord { epoch, output, battery_a: Some(value(8)), faults: None })
}

pub fn header(start_tick: u32) -> Record {
    Record::Header(Header {
        firmware_version: "0.1.0-test".try_into().unwrap(),
        build_hash: [0x5A; 32],
        settings: Settings::default(),
        coefficients: Coefficients::ZERO,
        start_tick,
        start_unix_ms: Some(1_780_000_000_000),
    })
}

pub type Writer<'a> = SectorWriter<LogFile<Shared<'a>>>;

/// The newest file with room, or a new one.
pub fn open(disk: &Disk, blocks: u32, nonce: u32) -> Result<FileMap, VolumeError<DiskError>> {
    let card = Shared(disk);
    if let Some(map) = FileMap::open_newest(&card, 0, 0)? {
        return Ok(map);
    }
    let mut maker = Maker::new(&card, NewFile { partition: 0, blocks, nonce })?;
    loop {
        if let Some(ready) = maker.step(&card)? {
            return Ok(ready.map);
        }
    }
}

pub fn writer<'a>(disk: &'a Disk, map: FileMap, session: u32) -> Writer<'a> {
    let mut file = LogFile::new(Shared(disk), map);
    while !file.is_marked() && file.mark().is_ok() {}
    SectorWriter::resume(file, session)
}

/// Everything that recovery makes of a source.
#[derive(Debug, Default)]
pub struct Log {
    pub survey: Survey,
    pub keys: Vec<SectorKey>,
    pub items: Vec<Recovered>,
    /// Every epoch by its tick.
    pub epochs: BTreeMap<u32, Record>,
}

/// What recovery finds in a source, in the order in which it was logged; of one session or several.
pub fn scan<S: BlockSource>(source: &mut S) -> (Survey, Vec<SectorKey>, Vec<Recovered>) {
    let mut survey = Survey::default();
    let mut keys: Vec<_> = Scan::new(source).filter_map(|found| survey.count(found)).collect();
    let sectors = order(&mut keys);
    survey.duplicates = keys.len() - sectors;
    keys.truncate(sectors);
    let items = Records::new(source, &keys).collect();
    (survey, keys, items)
}

/// The same of a source whose sessions go on counting.
pub fn recover<S: BlockSource>(source: &mut S) -> Log {
    let (survey, keys, items) = scan(source);
    let mut epochs = BTreeMap::new();
    for item in &items {
        if let Recovered::Record(record @ Record::Epoch(epoch)) = item {
            assert_eq!(epochs.insert(epoch.epoch.tick, record.clone()), None, "tick {} twice", epoch.epoch.tick);
        }
    }
    Log { survey, keys, items, epochs }
}

/// The library wants to know the time of what it only reads.
#[derive(Clone, Copy, Debug)]
pub struct NoDate;

impl TimeSource for NoDate {
    fn get_timestamp(&self) -> Timestamp {
        Timestamp { year_since_1970: 10, zero_indexed_month: 0, zero_indexed_day: 0, hours: 0, minutes: 0, seconds: 0 }
    }
}

/// From the bare card, without a file system.
pub fn recover_image(disk: &Disk) -> Log {
    recover(&mut InUse { disk, blocks: disk.blocks_in_use() })
}

/// The bare card without the parts that were never written.
struct InUse<'a> {
    disk: &'a Disk,
    blocks: Vec<u32>,
}

impl BlockSource for InUse<'_> {
    type Error = DiskError;

    fn blocks(&self) -> u32 {
        self.blocks.len() as u32
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), DiskError> {
        Shared(self.disk).read(self.blocks[position as usize], block)
    }
}

/// The bytes of a file, as a laptop reads them.
pub fn read_file(disk: &Disk, name: &str) -> Option<Vec<u8>> {
    let manager: VolumeManager<Shared<'_>, NoDate, 1, 1, 1> = VolumeManager::new_with_limits(Shared(disk), NoDate, 1);
    let volume = manager.open_volume(VolumeIdx(0)).ok()?;
    let root = volume.open_root_dir().ok()?;
    let file = root.open_file_in_dir(name, Mode::ReadOnly).ok()?;
    let mut bytes = vec![0; file.length() as usize];
    let mut filled = 0;
    while filled < bytes.len() {
        filled += file.read(&mut bytes[filled..]).ok().filter(|&count| count > 0)?;
    }
    Some(bytes)
}

pub fn recover_file(disk: &Disk, name: &str) -> Option<Log> {
    read_file(disk, name).map(|bytes| recover(&mut SliceSource(&bytes)))
}

impl Log {
    /// Every epoch up to `end` must be there and equal.
    pub fn assert_has(&self, ticks: impl IntoIterator<Item = u32>, context: &str) {
        for tick in ticks {
            let found = self.epochs.get(&tick);
            assert!(found == Some(&epoch(tick)), "{context}: acknowledged tick {tick} is {found:?}");
        }
    }

    /// Whatever is there must be what was written.
    pub fn assert_true(&self, context: &str) {
        for (&tick, record) in &self.epochs {
            assert_eq!(record, &epoch(tick), "{context}: tick {tick}");
        }
        let unreadable = self.items.iter().find(|item| matches!(item, Recovered::Unreadable(_)));
        assert_eq!(unreadable, None, "{context}");
    }
}
