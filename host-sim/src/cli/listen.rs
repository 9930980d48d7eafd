//! `host-sim listen` at the terminal, and the page that others have, too.

use std::io::{BufReader, IsTerminal};
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;
use host_sim::error::HostError;
use host_sim::listen::{ListenOptions, ReplayOptions, Screen, ShowOptions, listen_and_show, replay};

/// The page.
#[derive(Args)]
pub(crate) struct ShowArgs {
    /// Serve a page with a strip chart, lamps, alarms, marks and contacts. On 127.0.0.1 only this machine reaches it; on
    /// another address others look with the token that is printed, and do nothing else.
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1, default_missing_value = "127.0.0.1:8080")]
    serve: Option<SocketAddr>,
    /// Send each epoch as a datagram of JSON with the body's own time stamp: PlotJuggler's UDP server reads it.
    #[arg(long, value_name = "HOST:PORT")]
    udp: Option<String>,
    /// Height above the bottom below which there is an alarm, m.
    #[arg(long, value_name = "M", default_value_t = 2.0)]
    lowest_altitude: f64,
}

impl ShowArgs {
    pub(crate) fn options(self, allow_commands: bool) -> ShowOptions {
        let Self { serve, udp, lowest_altitude: lowest_altitude_m } = self;
        ShowOptions { serve, allow_commands, lowest_altitude_m, udp }
    }
}

/// What `listen` is told.
#[derive(Args)]
pub(crate) struct ListenArgs {
    /// A serial port such as /dev/ttyUSB0, an address such as localhost:4000, or a recording.
    #[arg(value_name = "PORT", required_unless_present = "replay")]
    port: Option<String>,
    /// Baud rate of the serial port, the body's cable_baud. Without it every usual rate is tried until the body is heard.
    #[arg(long, value_name = "BAUD", conflicts_with = "replay")]
    baud: Option<u32>,
    /// New file for every byte as it comes.
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    record: Option<PathBuf>,
    /// New file for the telemetry as a table, one row per epoch.
    #[arg(long, value_name = "FILE.csv", conflicts_with = "replay")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    show: ShowArgs,
    /// With --serve: viewers on this machine may send commands to the body.
    #[arg(long, requires = "serve", conflicts_with = "replay")]
    allow_commands: bool,
    /// Show again what was recorded: with --record or --csv, by the body, or any recording.
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
    replay: Option<PathBuf>,
    /// With --replay: so many times as fast as it was.
    #[arg(long, value_name = "N", default_value_t = 1.0, conflicts_with = "port", value_parser = speed)]
    speed: f64,
    /// With --replay: what `calibrate` wrote, to compensate a recording with that was not.
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
    coefficients: Option<PathBuf>,
}

/// How fast a recording may be shown: a day in a quarter of a minute, or a second in ten.
pub(crate) fn speed(text: &str) -> Result<f64, String> {
    let speed: f64 = text.parse().map_err(|_| "a number, such as 10".to_string())?;
    if (0.1..=10_000.0).contains(&speed) { Ok(speed) } else { Err("0.1 to 10000".into()) }
}

impl ListenArgs {
    pub(crate) fn run(self) -> Result<(), HostError> {
        let stdout = std::io::stdout();
        let mut screen = Screen::new(&stdout, stdout.is_terminal());
        let Self { port, baud, record, csv, show, allow_commands, replay: file, speed, coefficients } = self;
        let show = show.options(allow_commands);
        if let Some(file) = file {
            return replay(&ReplayOptions { file, speed, coefficients }, &show, &mut screen);
        }
        let options = ListenOptions { port: port.unwrap_or_default(), baud, record, csv };
        let commands = BufReader::new(std::io::stdin());
        listen_and_show(&options, Some(&show), None, commands, &mut screen).map(drop)
    }
}
