//! The log that the body writes, as a recording: the very epochs that its core saw.

mod blocks;
mod body_state;
mod placement;
mod prior;
mod session_clock;
mod timeline;
mod told;

use std::collections::{HashMap, VecDeque};
use std::path::Path;

use towmag::Epoch;
use towmag::log::{BLOCK_LEN, BlockSource, EpochRecord, Event, EventKind, Record, Sector, SectorKey};

pub use self::blocks::{FileBlocks, survey};
use self::body_state::{BodyState, StateColumn, Track, f32_step};
use self::placement::place;
pub use self::prior::prior_from_log;
use self::session_clock::{SessionClock, Utc};
use self::timeline::{Place, Timeline};
use self::told::{Told, told_in_time};
use crate::recording::error::RecordingError;
use crate::recording::reader::{FieldSink, Format, RecordingReader, start_of};
use crate::recording::row::RecordingRow;
use crate::recording::schema::Schema;
use crate::recording::session_gap::SessionGap;
use towmag_recording::Column;

/// A file or card image that starts with a sector, or with the first block, of a log.
pub(super) const FORMAT: Format = Format {
    is_start: is_log_start,
    open: |path, name| DeviceLogReader::open_named(path, name).map(|reader| Box::new(reader) as _),
};

/// Columns of every device log. What the body answered follows what it saw; behind these is where and how it was, as far as it knew.
const COLUMNS: [&str; 14] = [
    "time_s",
    "scalar_nT",
    "flux_x_nT",
    "flux_y_nT",
    "flux_z_nT",
    "current_battery_A",
    "line",
    "tick",
    "logged_interference_nT",
    "logged_compensated_nT",
    "logged_residual_nT",
    "logged_valid",
    "utc_s",
    "utc_error_s",
];

/// Times are written in milliseconds.
const TIME_STEP_S: f64 = 0.001;
/// The scalar is logged in picotesla.
const SCALAR_STEP_NT: f64 = 0.001;

fn is_log_start(start: &[u8]) -> bool {
    start.starts_with(b"TMLS") || start.starts_with(b"TOWMAGLF")
}

/// Whether a regular file starts as a device log does.
pub fn is_device_log(path: &Path) -> bool {
    is_log_start(&start_of(path))
}

/// A device log that is being read, sector by sector.
#[derive(Debug)]
pub struct DeviceLogReader {
    file: String,
    blocks: FileBlocks,
    sectors: Vec<SectorKey>,
    next_sector: usize,
    /// Epochs of the sector that is being read, and what the body knew beside them.
    records: VecDeque<(EpochRecord, BodyState)>,
    /// The same in the session that is being read.
    track: Track,
    /// The columns behind [`COLUMNS`].
    state_columns: Vec<StateColumn>,
    timeline: Timeline,
    gaps: Vec<SessionGap>,
    /// Of the sessions whose time is known.
    clocks: HashMap<u32, SessionClock>,
    /// Of the session that is being read.
    clock: SessionClock,
    /// The session that is being read, and its label.
    session: Option<u32>,
    label: String,
    schema: Schema,
    /// The latest row as it is in the log.
    latest: Option<(EpochRecord, BodyState)>,
    /// Its time.
    utc: Option<Utc>,
    rows: u64,
}

impl DeviceLogReader {
    /// Open a log, or a card or card image with one on it, and find its intact sectors.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        Self::open_named(path, &path.display().to_string())
    }

    /// The same of a file that messages call `name`.
    fn open_named(path: &Path, name: &str) -> Result<Self, RecordingError> {
        let file = name.to_string();
        let mut blocks = FileBlocks::open(path).map_err(|source| RecordingError::Io { path: file.clone(), source })?;
        let (mut sectors, _) = survey(&mut blocks);
        let told = told_in_time(&mut blocks, &mut sectors);
        let spans = told.spans();
        let placement = place(&spans);
        let Told { clocks, state_columns, .. } = told;
        let names = COLUMNS.into_iter().chain(state_columns.iter().map(|column| column.name()));
        let schema = Schema::new(names).expect("all required columns are there");
        Ok(Self {
            file,
            blocks,
            sectors,
            next_sector: 0,
            records: VecDeque::new(),
            track: Track::default(),
            state_columns,
            timeline: Timeline::new(&spans, &placement),
            gaps: placement.gaps,
            clocks,
            clock: SessionClock::default(),
            session: None,
            label: String::new(),
            schema,
            latest: None,
            utc: None,
            rows: 0,
        })
    }

    /// The intact sectors in the order in which they are read.
    pub fn sectors(&self) -> &[SectorKey] {
        &self.sectors
    }

    /// The epochs of the next sector into the queue; `false` after the last sector.
    fn load(&mut self) -> bool {
        let Some(key) = self.sectors.get(self.next_sector) else { return false };
        self.next_sector += 1;
        let session = key.id.session;
        if self.session.replace(session) != Some(session) {
            self.label = format!("session {session:08x}");
            self.clock = self.clocks.get(&session).cloned().unwrap_or_default();
            self.track = Track::default();
        }
        let mut block = [0; BLOCK_LEN];
        if self.blocks.read(key.position, &mut block).is_err() {
            return true;
        }
        if let Ok(sector) = Sector::parse(&block) {
            for record in sector.records().flatten() {
                match record {
                    Record::Epoch(record) => {
                        let state = self.track.at(record.epoch.tick);
                        self.records.push_back((record, state));
                    }
                    Record::Event(Event { tick, kind }) => match kind {
                        EventKind::Navigation(told) => self.track.tell_navigation(tick, told),
                        EventKind::Housekeeping(told) => self.track.tell_housekeeping(tick, told),
                        _ => {}
                    },
                    Record::Header(_) | Record::Loss(_) => {}
                }
            }
        }
        true
    }

    fn fill(&self, row: &mut RecordingRow, (record, state): &(EpochRecord, BodyState), place: Place) {
        row.clear();
        row.line_number = self.rows;
        row.set(Column::Time, Some(place.time_s));
        row.set(Column::Scalar, scalar_nt(record));
        for (k, axis) in Column::FLUX.into_iter().enumerate() {
            row.set(axis, record.epoch.flux_nt.map(|flux_nt| f64::from(flux_nt[k])));
        }
        row.currents_a.push(record.battery_a.map(f64::from));
        row.line.push_str(&self.label);
        row.set(Column::Utc, self.utc.map(|utc| utc.utc_s));
        for (column, known) in self.state_columns.iter().filter_map(|known| Some((known.column()?, known))) {
            row.set(column, known.value(state));
        }
        row.gap_s = place.gap_s;
        row.is_on_grid = true;
        row.epoch = Epoch { tick: place.tick, ..record.epoch };
    }
}

impl RecordingReader for DeviceLogReader {
    fn file(&self) -> &str {
        &self.file
    }

    fn schema(&self) -> &Schema {
        &self.schema
    }

    fn session_gaps(&self) -> &[SessionGap] {
        &self.gaps
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
                let tick = record.0.epoch.tick;
                let place = self.session.and_then(|session| self.timeline.epoch(session, tick));
                if let Some(place) = place {
                    self.rows += 1;
                    self.utc = self.clock.at(tick);
                    self.fill(row, &record, place);
                    self.latest = Some(record);
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

    /// Time and scalar are logged as whole milliseconds and picotesla. The fluxgate, the current and most of where the body
    /// was are logged in `f32`, which is coarsest where the values are largest.
    fn update_steps(&self, _row: &RecordingRow, steps: &mut [Option<f64>]) {
        let Some((EpochRecord { epoch, battery_a, .. }, state)) = &self.latest else { return };
        let [x, y, z] = epoch.flux_nt.map_or([None; 3], |flux_nt| flux_nt.map(Some));
        let singles = [x, y, z, *battery_a].map(|value| value.map(f32_step));
        let known = self.state_columns.iter().map(|column| column.step(state));
        let without_step = [None; COLUMNS.len() - 6];
        let of_row =
            [Some(TIME_STEP_S), Some(SCALAR_STEP_NT)].into_iter().chain(singles).chain(without_step).chain(known);
        for (step, of_row) in steps.iter_mut().zip(of_row) {
            *step = of_row.map(|of_row| step.map_or(of_row, |step| step.max(of_row))).or(*step);
        }
    }

    fn write_fields(&self, row: &RecordingRow, positions: &[usize], sink: &mut FieldSink<'_>) -> csv::Result<()> {
        let Some((record, state)) = &self.latest else { return Ok(()) };
        let text = |position: usize| match position.checked_sub(COLUMNS.len()) {
            Some(behind) => self.state_columns[behind].text(state),
            None => field(row, record, self.utc, position),
        };
        positions.iter().try_for_each(|&position| sink(text(position).as_bytes()))
    }
}

/// The text of a field, at its position in [`COLUMNS`]; each number in the fewest digits that give the same bits back.
fn field(row: &RecordingRow, record: &EpochRecord, utc: Option<Utc>, position: usize) -> String {
    let double = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    let single = |value: Option<f32>| value.map(|value| value.to_string()).unwrap_or_default();
    let answer = record.output.compensated;
    match position {
        0 => double(row.time_s()),
        1 => double(row.scalar_nt()),
        2..=4 => single(record.epoch.flux_nt.map(|flux_nt| flux_nt[position - 2])),
        5 => single(record.battery_a),
        6 => row.line.clone(),
        7 => record.epoch.tick.to_string(),
        8 => single(answer.map(|answer| answer.interference_nt)),
        9 => double(answer.map(|answer| f64::from(answer.compensated_pt) / 1000.0)),
        10 => single(answer.map(|answer| answer.residual_nt)),
        11 => u8::from(answer.is_some()).to_string(),
        12 => utc.map(|utc| format!("{:.6}", utc.utc_s)).unwrap_or_default(),
        _ => utc.map(|utc| format!("{:.6}", utc.error_s)).unwrap_or_default(),
    }
}

fn scalar_nt(record: &EpochRecord) -> Option<f64> {
    record.epoch.scalar_pt.map(|pt| f64::from(pt) / 1000.0)
}
