//! What the whole of a log tells, before its epochs are read.

use std::collections::HashMap;
use std::ops::Range;

use towmag::log::{BLOCK_LEN, BlockSource, Event, EventKind, Record, Sector, SectorKey};

use super::blocks::FileBlocks;
use super::body_state::{BodyState, StateColumn};
use super::placement::Span;
use super::session_clock::{SessionClock, Utc};

/// What the whole tells.
#[derive(Default)]
pub(super) struct Told {
    /// The clocks of the sessions whose time was known.
    pub(super) clocks: HashMap<u32, SessionClock>,
    /// Of where and how the body was, what it knew at any time.
    pub(super) state_columns: Vec<StateColumn>,
    /// The sectors of each session, in their order.
    stretches: Vec<Stretch>,
}

/// Sectors in a row of one session.
#[derive(Clone)]
struct Stretch {
    session: u32,
    /// The file that it begins in.
    file_number: u16,
    sectors: Range<usize>,
    /// Of its first epoch and of its last.
    ticks: Option<[u32; 2]>,
}

/// Go through all records, and bring the sectors into the order of time.
pub(super) fn told_in_time(blocks: &mut FileBlocks, sectors: &mut Vec<SectorKey>) -> Told {
    let mut told = told_by(blocks, sectors);
    told.order(sectors);
    told
}

fn told_by(blocks: &mut FileBlocks, sectors: &[SectorKey]) -> Told {
    let mut told = Told::default();
    let mut block = [0; BLOCK_LEN];
    for (place, key) in sectors.iter().enumerate() {
        told.begin(place, key);
        let read = blocks.read(key.position, &mut block).is_ok();
        let Some(sector) = Sector::parse(&block).ok().filter(|_| read) else { continue };
        sector.records().flatten().for_each(|record| told.hear(key.id.session, &record));
    }
    told.clocks.values_mut().for_each(SessionClock::settle);
    let known = std::mem::take(&mut told.state_columns);
    told.state_columns = StateColumn::ALL.into_iter().filter(|column| known.contains(column)).collect();
    told
}

impl Told {
    fn begin(&mut self, place: usize, key: &SectorKey) {
        match self.stretches.last_mut() {
            Some(stretch) if stretch.session == key.id.session => stretch.sectors.end = place + 1,
            _ => self.stretches.push(Stretch {
                session: key.id.session,
                file_number: key.id.file_number,
                sectors: place..place + 1,
                ticks: None,
            }),
        }
    }

    fn hear(&mut self, session: u32, record: &Record) {
        match record {
            Record::Epoch(record) => self.epoch(record.epoch.tick),
            Record::Event(event) => self.event(session, event),
            Record::Header(header) => {
                if let Some(unix_ms) = header.start_unix_ms {
                    let kind = EventKind::TimeSet { unix_ms };
                    self.event(session, &Event { tick: header.start_tick, kind });
                }
            }
            Record::Loss(_) => {}
        }
    }

    fn epoch(&mut self, tick: u32) {
        let Some(Stretch { ticks, .. }) = self.stretches.last_mut() else { return };
        let [first, last] = ticks.get_or_insert([tick; 2]);
        // One that goes back is no row.
        if tick.wrapping_sub(*last) <= u32::MAX / 2 && tick.wrapping_sub(*first) <= u32::MAX / 2 {
            *last = tick;
        }
    }

    fn event(&mut self, session: u32, event: &Event) {
        match &event.kind {
            EventKind::Time(_) | EventKind::TimeSet { .. } => {
                self.clocks.entry(session).or_default().hear(event.tick, &event.kind);
            }
            EventKind::Navigation(navigation) => self.knows(&(*navigation).into()),
            EventKind::Housekeeping(housekeeping) => self.knows(&(*housekeeping).into()),
            _ => {}
        }
    }

    fn knows(&mut self, state: &BodyState) {
        for column in StateColumn::ALL {
            if column.value(state).is_some() && !self.state_columns.contains(&column) {
                self.state_columns.push(column);
            }
        }
    }

    /// Bring the sectors of several files into the order of the time of day, as far as it is known: what is left of a log that
    /// was deleted has higher numbers than the files after it. Within a file the order is that of writing.
    fn order(&mut self, sectors: &mut Vec<SectorKey>) {
        let mut files: Vec<(f64, Vec<Stretch>)> = Vec::new();
        for file in self.stretches.chunk_by(|before, after| before.file_number == after.file_number) {
            let began_s = file.iter().find_map(|stretch| Some(self.times(stretch)?[0].utc_s));
            let after_s = files.last().map_or(f64::NEG_INFINITY, |(began_s, _)| *began_s);
            files.push((began_s.unwrap_or(after_s), file.to_vec()));
        }
        files.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        self.stretches = files.into_iter().flat_map(|(_, file)| file).collect();
        let ordered = self.stretches.iter().flat_map(|stretch| sectors[stretch.sectors.clone()].to_vec());
        *sectors = ordered.collect();
    }

    fn times(&self, stretch: &Stretch) -> Option<[Utc; 2]> {
        let (clock, [first, last]) = (self.clocks.get(&stretch.session)?, stretch.ticks?);
        Some([clock.at(first)?, clock.at(last)?])
    }

    /// The sessions that have epochs.
    pub(super) fn spans(&self) -> Vec<Span> {
        let span = |stretch: &Stretch| {
            Some(Span { session: stretch.session, ticks: stretch.ticks?, times: self.times(stretch) })
        };
        self.stretches.iter().filter_map(span).collect()
    }
}
