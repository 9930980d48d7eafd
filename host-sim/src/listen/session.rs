//! What is kept and shown of a session, and what people want done in it.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

use towmag_live::{Limits, LiveOptions, Mark, Order};

use super::commands::Commands;
use super::csv_table::CsvTable;
use super::files::{at, create};
use super::notes::{self, Record};
use super::options::{ListenOptions, ShowOptions};
use super::page::Page;
use super::screen::Screen;
use crate::error::HostError;
use crate::message::file_name;

/// How often a page whose recording has ended is looked after.
const REST: Duration = Duration::from_millis(200);

/// What is kept and shown of a session.
pub(super) struct Session {
    record: Option<Record>,
    record_path: Option<PathBuf>,
    pub(super) table: Option<CsvTable<File>>,
    pub(super) page: Option<Page>,
}

impl Session {
    /// Open the files, and the page where one is asked for; the terminal says where that is.
    pub(super) fn begin(
        options: &ListenOptions,
        show: Option<&ShowOptions>,
        is_live: bool,
        screen: &mut Screen<impl Write>,
    ) -> Result<Self, HostError> {
        let record = options.record.as_deref().map(create).transpose()?.map(Record::new);
        let table = options.csv.as_deref().map(|path| CsvTable::new(create(path)?)).transpose()?;
        let kept = [&options.record, &options.csv].into_iter().flatten().map(|path| file_name(path)).collect();
        let title = file_name(options.port.as_ref());
        let page = show.map(|show| open(show, title, kept, is_live, screen)).transpose()?.flatten();
        Ok(Self { record, record_path: options.record.clone(), table, page })
    }

    /// A session of which nothing is kept.
    pub(super) fn of_page(page: Option<Page>) -> Self {
        Self { record: None, record_path: None, table: None, page }
    }

    /// Keep what came.
    pub(super) fn keep(&mut self, bytes: &[u8]) -> Result<(), HostError> {
        let path = self.record_path.as_deref();
        self.record.as_mut().map_or(Ok(()), |record| record.write(bytes)).map_err(|source| at(path, source))
    }

    /// Do what viewers want, and keep what was found.
    pub(super) fn carry_out(
        &mut self,
        commands: Option<&Commands<impl Write>>,
        screen: &mut Screen<impl Write>,
    ) -> Result<(), HostError> {
        let Some(page) = &self.page else { return Ok(()) };
        let (orders, contacts) = (page.orders(), page.contacts());
        for contact in contacts {
            let note = notes::of_contact(&contact);
            screen.text(&note).map_err(|source| at(None, source))?;
            self.note(&note)?;
        }
        for order in orders {
            match order {
                Order::Mark(mark) => self.mark(mark)?,
                Order::Note(text) => _ = self.note(&notes::of_text(&text))?,
                Order::Command(line) => {
                    screen.text(&format!("from the page: {line}")).map_err(|source| at(None, source))?;
                    commands.iter().for_each(|commands| commands.queue(line.clone()));
                }
            }
        }
        Ok(())
    }

    fn mark(&mut self, mark: Mark) -> Result<(), HostError> {
        let is_kept = self.note(&notes::of_mark(&mark))?;
        if let Some(page) = &self.page {
            if is_kept {
                page.mark(mark);
            } else {
                page.text("the mark is not kept, for nothing is: listen with --record or --csv");
            }
        }
        Ok(())
    }

    /// Whether there is a file to keep it in.
    fn note(&mut self, note: &str) -> Result<bool, HostError> {
        if let Some(record) = &mut self.record {
            record.note(note).map_err(|source| at(self.record_path.as_deref(), source))?;
        }
        if let Some(table) = &mut self.table {
            table.note(note);
        }
        Ok(self.record.is_some() || self.table.is_some())
    }

    /// The port has ended.
    pub(super) fn end(&mut self) -> Result<(), HostError> {
        let path = self.record_path.as_deref();
        self.page.iter().for_each(Page::end);
        self.record.as_mut().map_or(Ok(()), Record::finish).map_err(|source| at(path, source))
    }

    /// The page of a recording stays until somebody ends the program.
    pub(super) fn stay(&mut self, screen: &mut Screen<impl Write>) -> Result<(), HostError> {
        if self.page.as_ref().is_none_or(|page| page.links().is_empty()) {
            return Ok(());
        }
        screen.text("that was all; the page stays until Ctrl-C").map_err(|source| at(None, source))?;
        loop {
            self.carry_out(None::<&Commands<Vec<u8>>>, screen)?;
            std::thread::sleep(REST);
        }
    }
}

/// Open a page, if one is asked for; the terminal says where it is.
pub(super) fn open(
    show: &ShowOptions,
    title: String,
    kept: Vec<String>,
    is_live: bool,
    screen: &mut Screen<impl Write>,
) -> Result<Option<Page>, HostError> {
    if !show.is_any() {
        return Ok(None);
    }
    let ShowOptions { serve, allow_commands, lowest_altitude_m, udp } = show.clone();
    let limits = Limits::default();
    let options = LiveOptions { address: serve, title, allow_commands, is_live, lowest_altitude_m, udp, limits };
    let page = Page::serve(options, kept)?;
    for link in page.links() {
        screen.text(&format!("the page is at {link}")).map_err(|source| at(None, source))?;
    }
    Ok(Some(page))
}
