//! What the events of a log tell of the whole of it, before its epochs are read.

use std::collections::HashMap;

use towmag::log::{BLOCK_LEN, BlockSource, Event, EventKind, Record, Sector, SectorKey};

use super::blocks::FileBlocks;
use super::body_state::{BodyState, StateColumn};
use super::session_clock::SessionClock;

/// What the events tell.
#[derive(Default)]
pub(super) struct Told {
    /// The clocks of the sessions whose time was known.
    pub(super) clocks: HashMap<u32, SessionClock>,
    /// Of where and how the body was, what it knew at any time.
    pub(super) state_columns: Vec<StateColumn>,
}

/// Go through all events.
pub(super) fn told_by_events(blocks: &mut FileBlocks, sectors: &[SectorKey]) -> Told {
    let mut told = Told::default();
    let mut block = [0; BLOCK_LEN];
    for key in sectors {
        let read = blocks.read(key.position, &mut block).is_ok();
        let Some(sector) = Sector::parse(&block).ok().filter(|_| read) else { continue };
        for record in sector.records().flatten() {
            if let Record::Event(event) = record {
                told.hear(key.id.session, &event);
            }
        }
    }
    let Told { clocks, state_columns } = told;
    let ordered = StateColumn::ALL.into_iter().filter(|column| state_columns.contains(column));
    Told { clocks, state_columns: ordered.collect() }
}

impl Told {
    fn hear(&mut self, session: u32, event: &Event) {
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
}
