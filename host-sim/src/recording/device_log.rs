//! The log that the body writes, as a recording: the very epochs that its core saw.

use std::collections::{HashMap, VecDeque};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use csv::ByteRecord;
use towmag::Epoch;
use towmag::estimate::Prior;
use towmag::log::{
    BLOCK_LEN, BlockBytes, BlockSource, EpochRecord, Event, EventKind, InformationParts, Record, Records, Recovered,
    Scan, Sector, SectorKey, Survey, order,
};

use super::columns::Columns;
use super::error::RecordingError;
use super::row::RecordingRow;
use super::rows::Rows;

/// Columns of a device log. What the body answered follows what it saw.
const COLUMNS: &str = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,current_battery_A,line,tick,\
                       logged_interference_nT,logged_compensated_nT,logged_residual_nT,logged_valid";

/// Ticks a second.
const RATE_HZ: f64 = 10.0;

/// Where nothing tells how long the body was off between two sessions: seconds, more than any filter remembers.
const UNKNOWN_PAUSE_S: f64 = 1000.0;

/// A file or card image as blocks.
#[derive(Debug)]
pub struct FileBlocks {
    file: File,
    blocks: u32,
}

impl FileBlocks {
    /// Open a file. A last block that is cut off is padded with zeros, so that its CRC tells.
    pub fn open(path: &Path) -> std::io::Result<Self> {
        let mut file = File::open(path)?;
        let len = file.seek(SeekFrom::End(0))?;
        Ok(Self { file, blocks: u32::try_from(len.div_ceil(BLOCK_LEN as u64)).unwrap_or(u32::MAX) })
    }
}

impl BlockSource for FileBlocks {
    type Error = std::io::Error;

    fn blocks(&self) -> u32 {
        self.blocks
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> std::io::Result<()> {
        block.fill(0);
        self.file.seek(SeekFrom::Start(u64::from(position) * BLOCK_LEN as u64))?;
        let mut filled = 0;
        while filled < block.len() {
            match self.file.read(&mut block[filled..])? {
                0 => break,
                read => filled += read,
            }
        }
        Ok(())
    }
}

/// The intact sectors of a source in the order of writing, and what else there is.
pub fn survey(source: &mut impl BlockSource) -> (Vec<SectorKey>, Survey) {
    let mut survey = Survey::default();
    let mut keys: Vec<_> = Scan::new(source).filter_map(|found| survey.count(found)).collect();
    let sectors = order(&mut keys);
    survey.duplicates = keys.len() - sectors;
    keys.truncate(sectors);
    (keys, survey)
}

/// Puts the ticks of several sessions on one time axis.
#[derive(Debug, Default)]
struct Timeline {
    session: Option<u32>,
    /// Of each session whose clock was set, the last that its events say: tick and milliseconds since 1970-01-01 UTC.
    told: HashMap<u32, (u32, u64)>,
    /// Tick and time of the latest epoch or header of this session.
    latest: Option<(u32, f64)>,
    /// Time of the last epoch of any session, s.
    last_s: Option<f64>,
    tick: u32,
}

impl Timeline {
    fn session(&mut self, session: u32) {
        if self.session.replace(session) != Some(session) {
            self.latest = None;
        }
    }

    /// Where the clock was set before the session or in it, its time goes by that, also before it was set.
    fn header(&mut self, start_tick: u32, start_unix_ms: Option<u64>) {
        let told = self.session.and_then(|session| self.told.get(&session)).copied();
        let known = told.or(start_unix_ms.map(|unix_ms| (start_tick, unix_ms)));
        if let (None, Some((tick, unix_ms))) = (self.latest, known) {
            let time_s = unix_ms as f64 / 1000.0 - f64::from(tick.saturating_sub(start_tick)) / RATE_HZ;
            self.latest = Some((start_tick, self.last_s.map_or(time_s, |last_s| time_s.max(last_s + 1.0))));
        }
    }

    /// Time of an epoch, seconds since the one before when that is a gap, and its tick on the one axis; `None` for an
    /// epoch that does not come after the one before.
    fn epoch(&mut self, tick: u32) -> Option<(f64, Option<f64>, u32)> {
        let (from, from_s) = self.latest.unwrap_or((tick, self.last_s.map_or(0.0, |s| s + UNKNOWN_PAUSE_S)));
        let ahead = tick.wrapping_sub(from);
        if ahead > u32::MAX / 2 {
            return None;
        }
        let time_s = ((from_s + f64::from(ahead) / RATE_HZ) * 1000.0).round() / 1000.0;
        let step_s = self.last_s.map(|last_s| time_s - last_s);
        if step_s.is_some_and(|step_s| step_s <= 0.0) {
            return None;
        }
        let gap_s = step_s.filter(|&step_s| step_s > 1.5 / RATE_HZ);
        self.tick = self.tick.wrapping_add(step_s.map_or(0, |step_s| (step_s * RATE_HZ).round().max(1.0) as u32));
        (self.latest, self.last_s) = (Some((tick, time_s)), Some(time_s));
        Some((time_s, gap_s, self.tick))
    }
}

/// A device log that is being read, sector by sector.
#[derive(Debug)]
pub struct DeviceLog {
    file: String,
    source: FileBlocks,
    sectors: Vec<SectorKey>,
    next_sector: usize,
    records: VecDeque<EpochRecord>,
    timeline: Timeline,
    header: ByteRecord,
    columns: Columns,
    rows: u64,
}

impl DeviceLog {
    /// Open a log, or a card or card image with one on it, and find its intact sectors.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        let io = |source| RecordingError::Io { path: file.clone(), source };
        let mut source = FileBlocks::open(path).map_err(io)?;
        let (sectors, _) = survey(&mut source);
        let header: ByteRecord = COLUMNS.split(',').map(str::as_bytes).collect();
        let columns = Columns::find(&header).expect("all required columns are there");
        let timeline = Timeline { told: times_told(&mut source, &sectors), ..Timeline::default() };
        let records = VecDeque::new();
        Ok(Self { file, source, sectors, next_sector: 0, records, timeline, header, columns, rows: 0 })
    }

    /// The epochs of the next sector into the queue; `false` after the last sector.
    fn load(&mut self) -> bool {
        let Some(key) = self.sectors.get(self.next_sector) else { return false };
        self.next_sector += 1;
        self.timeline.session(key.id.session);
        let mut block = [0; BLOCK_LEN];
        if self.source.read(key.position, &mut block).is_err() {
            return true;
        }
        if let Ok(sector) = Sector::parse(&block) {
            for record in sector.records().flatten() {
                match record {
                    Record::Header(header) => self.timeline.header(header.start_tick, header.start_unix_ms),
                    Record::Epoch(epoch) => self.records.push_back(epoch),
                    Record::Event(_) | Record::Loss(_) => {}
                }
            }
        }
        true
    }

    fn fill(&self, row: &mut RecordingRow, record: &EpochRecord, (time_s, gap_s, tick): (f64, Option<f64>, u32)) {
        let scalar_nt = record.epoch.scalar_pt.map(|pt| f64::from(pt) / 1000.0);
        *row = RecordingRow {
            fields: self.fields(record, time_s, scalar_nt),
            line_number: self.rows,
            time_s: Some(time_s),
            scalar_nt,
            flux_nt: record.epoch.flux_nt.map(|flux_nt| flux_nt.map(f64::from)),
            scalar_valid: scalar_nt.is_some(),
            currents_a: vec![record.battery_a.map(f64::from)],
            gap_s,
            epoch: Epoch { tick, ..record.epoch },
            ..RecordingRow::default()
        };
    }

    fn fields(&self, record: &EpochRecord, time_s: f64, scalar_nt: Option<f64>) -> ByteRecord {
        let some = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        let single = |value: Option<f32>| value.map(|value| value.to_string()).unwrap_or_default();
        let axis = |axis: usize| single(record.epoch.flux_nt.map(|flux_nt| flux_nt[axis]));
        let answer = record.output.compensated;
        let fields = [
            time_s.to_string(),
            some(scalar_nt),
            axis(0),
            axis(1),
            axis(2),
            single(record.battery_a),
            format!("session {:08x}", self.timeline.session.unwrap_or(0)),
            record.epoch.tick.to_string(),
            single(answer.map(|answer| answer.interference_nt)),
            some(answer.map(|answer| f64::from(answer.compensated_pt) / 1000.0)),
            single(answer.map(|answer| answer.residual_nt)),
            u8::from(answer.is_some()).to_string(),
        ];
        fields.iter().map(String::as_bytes).collect()
    }
}

/// What the first session of a log started from, as far as the log tells it; `None` for what holds no header.
pub fn prior_told(path: &Path) -> std::io::Result<Option<Prior>> {
    let mut source = FileBlocks::open(path)?;
    let (keys, _) = survey(&mut source);
    let (mut coefficients, mut parts) = (None, InformationParts::default());
    for item in Records::new(&mut source, &keys) {
        match item {
            Recovered::Record(Record::Header(header)) if coefficients.is_none() => {
                coefficients = Some(header.coefficients);
            }
            Recovered::Record(Record::Event(Event { kind: EventKind::Information(part), .. })) => parts.add(&part),
            Recovered::Record(Record::Epoch(_)) => break,
            _ => {}
        }
    }
    Ok(coefficients.map(|coefficients| Prior { coefficients, information: parts.information() }))
}

/// The last time of day that the events of each session tell.
fn times_told(source: &mut FileBlocks, sectors: &[SectorKey]) -> HashMap<u32, (u32, u64)> {
    let mut told = HashMap::new();
    let mut block = [0; BLOCK_LEN];
    for key in sectors {
        let read = source.read(key.position, &mut block).is_ok();
        let Some(sector) = Sector::parse(&block).ok().filter(|_| read) else { continue };
        for record in sector.records().flatten() {
            if let Record::Event(Event { tick, kind: EventKind::TimeSet { unix_ms } }) = record {
                told.insert(key.id.session, (tick, unix_ms));
            }
        }
    }
    told
}

impl Rows for DeviceLog {
    fn file(&self) -> &str {
        &self.file
    }

    fn header(&self) -> &ByteRecord {
        &self.header
    }

    fn columns(&self) -> &Columns {
        &self.columns
    }

    fn bytes_read(&self) -> u64 {
        (self.next_sector * BLOCK_LEN) as u64
    }

    fn byte_len(&self) -> Option<u64> {
        Some((self.sectors.len() * BLOCK_LEN) as u64)
    }

    fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        loop {
            if let Some(record) = self.records.pop_front() {
                if let Some(place) = self.timeline.epoch(record.epoch.tick) {
                    self.rows += 1;
                    self.fill(row, &record, place);
                    return Ok(true);
                }
            } else if !self.load() {
                break;
            }
        }
        if self.rows > 0 {
            return Ok(false);
        }
        let what = "holds no epoch of a device log".to_string();
        Err(RecordingError::Bad { file: self.file.clone(), line: 1, column: None, what })
    }
}
