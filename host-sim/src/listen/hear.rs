//! Listening, from the port's first byte to its last.

use std::io::{BufRead, Read, Write};
use std::time::Instant;

use super::baud::is_pause;
use super::commands::Commands;
use super::files::at;
use super::heard::Heard;
use super::options::{ListenOptions, ShowOptions};
use super::port::{Kind, Port};
use super::receiver::{Outlets, Receiver};
use super::screen::Screen;
use super::session::Session;
use super::ship_time::{ShipTime, unix_us};
use crate::error::HostError;
use crate::pace::Pace;

/// Listen until the port ends; a serial port never does. Lines of `commands` go to the body.
pub fn listen(
    options: &ListenOptions,
    commands: impl BufRead + Send + 'static,
    screen: &mut Screen<impl Write>,
) -> Result<Heard, HostError> {
    listen_and_show(options, None, None, commands, screen)
}

/// The same, and a page beside it. A recording is shown at `speed` times its own, or as fast as can be.
pub fn listen_and_show(
    options: &ListenOptions,
    show: Option<&ShowOptions>,
    speed: Option<f64>,
    commands: impl BufRead + Send + 'static,
    screen: &mut Screen<impl Write>,
) -> Result<Heard, HostError> {
    let port = Port::open(&options.port, options.baud, |text| _ = screen.text(text))?;
    let Port { reader, writer, kind, baud } = port;
    let mut session = Session::begin(options, show, kind == Kind::Live, screen)?;
    let mut commands = writer.map(|writer| Commands::new(commands, writer, first_number(), ShipTime::new(baud)));
    let heard = hear((reader, kind), speed, &options.port, &mut session, &mut commands, screen)?;
    if kind == Kind::File && heard.frames.good == 0 {
        return Err(HostError::NotEnough(format!(
            "{}: holds no whole frame: is it a recording of the tow cable?",
            options.port
        )));
    }
    if kind == Kind::File {
        session.stay(screen)?;
    }
    Ok(heard)
}

/// Show what comes from an emulated body, called `name`: its time is not the ship's, but its silence is an alarm.
#[cfg(unix)]
pub fn watch(
    reader: impl Read + 'static,
    name: &str,
    show: &ShowOptions,
    screen: &mut Screen<impl Write>,
) -> Result<(), HostError> {
    let options = ListenOptions { port: name.into(), baud: None, record: None, csv: None };
    let mut session = Session::begin(&options, Some(show), true, screen)?;
    let mut nobody = None::<Commands<Vec<u8>>>;
    hear((Box::new(reader), Kind::File), None, name, &mut session, &mut nobody, screen)?;
    session.stay(screen)
}

fn hear(
    (mut reader, kind): (Box<dyn Read>, Kind),
    speed: Option<f64>,
    name: &str,
    session: &mut Session,
    commands: &mut Option<Commands<impl Write>>,
    screen: &mut Screen<impl Write>,
) -> Result<Heard, HostError> {
    let mut receiver = Receiver::new(kind == Kind::Live);
    let mut pace = speed.map(Pace::new);
    let mut bytes = [0; 4096];
    // Of a recording that is shown at its own speed, about one message at a time.
    let most = if pace.is_some() { 64 } else { bytes.len() };
    loop {
        if let Some(told) = commands.as_mut().and_then(|commands| commands.poll(Instant::now(), unix_us())) {
            screen.text(&told).map_err(|source| at(None, source))?;
            session.page.iter().for_each(|page| page.text(&told));
        }
        session.carry_out(commands.as_ref(), screen)?;
        let count = match reader.read(&mut bytes[..most]) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if is_pause(&error) => continue,
            Err(source) => return Err(HostError::Port { port: name.into(), source }),
        };
        session.keep(&bytes[..count])?;
        let mut outlets = Outlets { screen, table: &mut session.table, commands, page: &mut session.page };
        receiver.take(&bytes[..count], &mut outlets).map_err(|error| match error {
            HostError::Page(source) => at(None, source),
            other => other,
        })?;
        if let Some(pace) = &mut pace {
            pace.wait(receiver.heard().ticks());
        }
    }
    let heard = receiver.heard();
    session.end()?;
    screen.end(&heard).map_err(|source| at(None, source))?;
    Ok(heard)
}

/// A number that the last session's commands hardly had.
fn first_number() -> u16 {
    (unix_us() / 1_000) as u16
}
