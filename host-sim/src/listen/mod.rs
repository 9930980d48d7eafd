//! `host-sim listen`: the tow cable's telemetry live, recorded and as a table; commands the other way.

mod baud;
mod commands;
mod csv_table;
mod heard;
mod port;
mod receiver;
mod screen;
mod ship_time;

pub use heard::Heard;
pub use screen::Screen;

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::error::HostError;
use baud::is_pause;
use commands::Commands;
use csv_table::CsvTable;
use port::{Kind, Port};
use receiver::Receiver;
use ship_time::{ShipTime, unix_us};

/// What to listen to, and what to keep of it.
#[derive(Clone, Debug)]
pub struct ListenOptions {
    /// A serial port, the address `host:port` of a TCP server, or a recording.
    pub port: String,
    /// Baud rate of a serial port, `None` for that at which the body is found to talk; of no meaning to others.
    pub baud: Option<u32>,
    /// File for every byte as it comes; must not exist yet.
    pub record: Option<PathBuf>,
    /// File for the telemetry as a table; must not exist yet.
    pub csv: Option<PathBuf>,
}

/// Listen until the port ends; a serial port never does. Lines of `commands` go to the body.
pub fn listen(
    options: &ListenOptions,
    commands: impl BufRead + Send + 'static,
    screen: &mut Screen<impl Write>,
) -> Result<Heard, HostError> {
    let tell = |text: &str| _ = screen.text(text);
    let Port { mut reader, writer, kind, baud } = Port::open(&options.port, options.baud, tell)?;
    let mut record = options.record.as_deref().map(create).transpose()?;
    let mut table = options.csv.as_deref().map(|path| CsvTable::new(create(path)?)).transpose()?;
    let mut commands = writer.map(|writer| Commands::new(commands, writer, first_number(), ShipTime::new(baud)));
    let mut receiver = Receiver::new(kind == Kind::Live);
    let mut bytes = [0; 4096];
    loop {
        if let Some(told) = commands.as_mut().and_then(|commands| commands.poll(Instant::now(), unix_us())) {
            screen.text(&told).map_err(|source| at(None, source))?;
        }
        let count = match reader.read(&mut bytes) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if is_pause(&error) => continue,
            Err(source) => return Err(HostError::Port { port: options.port.clone(), source }),
        };
        if let Some(record) = &mut record {
            record.write_all(&bytes[..count]).map_err(|source| at(options.record.as_deref(), source))?;
        }
        receiver.take(&bytes[..count], screen, &mut table, &mut commands).map_err(|error| match error {
            HostError::Page(source) => at(None, source),
            other => other,
        })?;
    }
    let heard = receiver.heard();
    screen.end(&heard).map_err(|source| at(None, source))?;
    if kind == Kind::File && heard.frames.good == 0 {
        return Err(HostError::NotEnough(format!(
            "{}: holds no whole frame: is it a recording of the tow cable?",
            options.port
        )));
    }
    Ok(heard)
}

/// An error of writing, with the file's name.
fn at(path: Option<&Path>, source: io::Error) -> HostError {
    HostError::Port { port: path.unwrap_or(Path::new("output")).display().to_string(), source }
}

/// A new file, written through as the bytes come: what was heard cannot be heard again, and Ctrl-C is how this ends.
fn create(path: &Path) -> Result<File, HostError> {
    OpenOptions::new().write(true).create_new(true).open(path).map_err(|source| match source.kind() {
        ErrorKind::AlreadyExists => HostError::Usage(format!(
            "{}: exists: a recording is never written over, name another file",
            path.display()
        )),
        ErrorKind::NotFound => HostError::Usage(format!("{}: its folder does not exist", path.display())),
        _ => HostError::Port { port: path.display().to_string(), source },
    })
}

/// A number that the last session's commands hardly had.
fn first_number() -> u16 {
    (unix_us() / 1_000) as u16
}
