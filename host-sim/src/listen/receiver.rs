//! From bytes to messages.

use std::fs::File;
use std::io::Write;
use std::time::Instant;

use towmag::link::{
    FaultCounters, FrameKind, FrameReader, HousekeepingMessage, NavigationMessage, Received, Telemetry,
};

use super::commands::Commands;
use super::csv_table::CsvTable;
use super::heard::{Heard, Told};
use super::notes;
use super::page::Page;
use super::screen::Screen;
use super::ship_time::unix_us;
use crate::error::HostError;

/// Where messages go to.
pub(super) struct Outlets<'a, S: Write, C: Write> {
    pub(super) screen: &'a mut Screen<S>,
    pub(super) table: &'a mut Option<CsvTable<File>>,
    pub(super) commands: &'a mut Option<Commands<C>>,
    pub(super) page: &'a mut Option<Page>,
}

/// Bytes to messages, with what is counted over all of them.
#[derive(Default)]
pub(super) struct Receiver {
    /// Whether the messages come from the body now, and not from a file.
    is_live: bool,
    frames: FrameReader,
    faults: FaultCounters,
    last_tick: Option<u32>,
    heard: Heard,
    /// Where the body is, as it told last.
    navigation: Option<NavigationMessage>,
    /// Leak and battery, as it told last.
    housekeeping: Option<HousekeepingMessage>,
}

/// The body tells every five ticks where it is; silence for longer than this is that of the cable.
const LONGEST_SILENCE_TICKS: u32 = 30;

/// Leak and battery every fifty: two messages may be lost.
const LONGEST_HOUSEKEEPING_SILENCE_TICKS: u32 = 150;

impl Receiver {
    pub(super) fn new(is_live: bool) -> Self {
        Self { is_live, ..Self::default() }
    }

    pub(super) fn take(
        &mut self,
        bytes: &[u8],
        outlets: &mut Outlets<'_, impl Write, impl Write>,
    ) -> Result<(), HostError> {
        for &byte in bytes {
            match self.frames.push(byte) {
                // Nothing, or figures, which are for tests.
                None | Some(Received { kind: FrameKind::Figures, .. }) => {}
                Some(Received { kind: FrameKind::Navigation, body }) => match NavigationMessage::decode(body) {
                    None => self.heard.undecodable += 1,
                    told => self.navigation = told,
                },
                Some(Received { kind: FrameKind::Housekeeping, body }) => match HousekeepingMessage::decode(body) {
                    None => self.heard.undecodable += 1,
                    told => self.housekeeping = told,
                },
                Some(Received { kind: FrameKind::Text, body }) => {
                    let text = String::from_utf8_lossy(body).into_owned();
                    self.text(&text, outlets)?;
                }
                Some(Received { kind: FrameKind::Telemetry, body }) => match Telemetry::decode(body) {
                    None => self.heard.undecodable += 1,
                    Some(message) => self.telemetry(&message, outlets)?,
                },
            }
        }
        if let Some(table) = outlets.table {
            table.flush()?;
        }
        Ok(())
    }

    fn text(&mut self, text: &str, outlets: &mut Outlets<'_, impl Write, impl Write>) -> Result<(), HostError> {
        let is_answer = |commands: &mut Commands<_>| commands.heard(text, Instant::now(), unix_us());
        if outlets.commands.as_mut().is_some_and(is_answer) {
            return Ok(());
        }
        self.heard.lines += 1;
        match (outlets.page.as_ref(), notes::mark_of(text)) {
            (Some(page), Some(mark)) => page.recorded_mark(mark),
            // What was found, or seen, is so again.
            (Some(page), None) if !notes::is_own(text) => page.text(text),
            _ => {}
        }
        Ok(outlets.screen.text(text)?)
    }

    fn telemetry(
        &mut self,
        message: &Telemetry,
        outlets: &mut Outlets<'_, impl Write, impl Write>,
    ) -> Result<(), HostError> {
        if self.count(message.tick) {
            outlets.commands.iter_mut().for_each(Commands::restart);
        }
        let told = self.told_at(message.tick);
        let ship_us = self.is_live.then(unix_us);
        // Before the page: what is kept comes first.
        if let Some(table) = outlets.table {
            table.write(message, &told, ship_us)?;
        }
        if let Some(page) = outlets.page {
            page.telemetry(message, &told, &self.heard(), ship_us);
        }
        Ok(outlets.screen.telemetry(message, &told, &mut self.faults, self.frames.counters().bad)?)
    }

    /// Count the ticks; whether the body has started anew.
    fn count(&mut self, tick: u32) -> bool {
        self.heard.messages += 1;
        if let Some(last) = self.last_tick.replace(tick) {
            match tick.wrapping_sub(last) {
                0 | 0x8000_0000.. => {
                    self.heard.restarts += 1;
                    return true;
                }
                step => self.heard.lost_ticks += u64::from(step - 1),
            }
        }
        false
    }

    /// Where and how the body is, if that is not too long ago; nothing of another run of the body.
    fn told_at(&self, tick: u32) -> Told {
        let age = |told: u32| tick.wrapping_sub(told);
        let navigation = self.navigation.filter(|told| age(told.tick) <= LONGEST_SILENCE_TICKS);
        let housekeeping = self.housekeeping.filter(|told| age(told.tick) <= LONGEST_HOUSEKEEPING_SILENCE_TICKS);
        Told {
            navigation: navigation.map(|told| told.navigation).unwrap_or_default(),
            housekeeping: housekeeping.map(|told| told.housekeeping).unwrap_or_default(),
        }
    }

    pub(super) fn heard(&self) -> Heard {
        Heard { frames: self.frames.counters(), ..self.heard }
    }
}
