//! What is listened to: a serial port, a TCP server, or a file.

use std::fs::{File, FileType};
use std::io::{self, Cursor, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

use towmag::store::CABLE_BAUD;

use super::baud;
use crate::error::HostError;

/// How long one look at a silent port takes.
const PATIENCE: Duration = Duration::from_millis(200);

/// What kind of port it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A recording: it ends, and nobody takes commands.
    File,
    /// Something that is alive.
    Live,
}

/// An open port.
pub(super) struct Port {
    pub(super) reader: Box<dyn Read>,
    pub(super) writer: Option<Box<dyn Write + Send>>,
    pub(super) kind: Kind,
    /// Of a serial port.
    pub(super) baud: Option<u32>,
}

impl Port {
    /// Open whatever `name` is, a serial port at the body's own baud rate where none is given; `tell` hears of it.
    pub(super) fn open(name: &str, baud: Option<u32>, tell: impl FnMut(&str)) -> Result<Self, HostError> {
        let opened = match Path::new(name).metadata() {
            Ok(metadata) if metadata.is_dir() => return Err(HostError::Usage(format!("{name}: is a folder"))),
            Ok(metadata) if is_device(metadata.file_type()) => serial(name, baud, tell),
            Ok(_) => {
                File::open(name).map(|file| Self { reader: Box::new(file), writer: None, kind: Kind::File, baud: None })
            }
            Err(_) if is_address(name) => tcp(name),
            Err(_) if cfg!(windows) => serial(name, baud, tell),
            Err(_) => {
                return Err(HostError::Usage(format!(
                    "{name}: no such serial port or file, and no address such as localhost:4000"
                )));
            }
        };
        opened.map_err(|source| HostError::Port { port: name.into(), source })
    }
}

fn serial(name: &str, baud: Option<u32>, mut tell: impl FnMut(&str)) -> io::Result<Port> {
    let mut port = serialport::new(name, baud.unwrap_or(CABLE_BAUD)).timeout(PATIENCE).open()?;
    let writer = Some(Box::new(port.try_clone()?) as Box<dyn Write + Send>);
    if baud.is_some() {
        return Ok(Port { writer, reader: Box::new(port), kind: Kind::Live, baud });
    }
    let in_vain = "nothing that makes sense at any baud rate yet: is the body on, and the cable the right way round?";
    let (found, heard) = baud::find_patiently(&mut port, || tell(in_vain))?;
    tell(&format!("the body talks at {found} baud"));
    Ok(Port { writer, reader: Box::new(Cursor::new(heard).chain(port)), kind: Kind::Live, baud: Some(found) })
}

fn tcp(name: &str) -> io::Result<Port> {
    let stream = TcpStream::connect(name)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    // A command is a few bytes that somebody waits for.
    stream.set_nodelay(true)?;
    Ok(Port { writer: Some(Box::new(stream.try_clone()?)), reader: Box::new(stream), kind: Kind::Live, baud: None })
}

fn is_address(name: &str) -> bool {
    name.rsplit_once(':').is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
}

#[cfg(unix)]
fn is_device(file_type: FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_char_device(&file_type)
}

#[cfg(not(unix))]
fn is_device(_: FileType) -> bool {
    false
}
