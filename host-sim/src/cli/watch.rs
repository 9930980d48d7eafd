//! An emulation that people look on.

use std::io::IsTerminal;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::thread::JoinHandle;

use clap::Args;
use host_sim::emulator::Onlooker;
use host_sim::error::HostError;
use host_sim::listen::{Screen, watch};

use super::listen::{ShowArgs, speed};

/// How an emulation is shown.
#[derive(Args)]
pub(crate) struct WatchArgs {
    #[command(flatten)]
    show: ShowArgs,
    /// With --serve or --udp: so many times as fast as the recording was.
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = speed)]
    speed: f64,
}

/// Those who look on.
pub(crate) struct Watching(JoinHandle<Result<(), HostError>>);

impl WatchArgs {
    /// Begin to show the body of this recording, if that is asked for.
    pub(crate) fn begin(self, recording: &Path) -> Result<(Option<Onlooker>, Option<Watching>), HostError> {
        let name = recording.file_name().unwrap_or_default().to_string_lossy();
        let (show, title) = (self.show.options(false), format!("emulated {name}"));
        if !show.is_any() {
            return Ok((None, None));
        }
        let (own, other) = UnixStream::pair()?;
        // Standard output is for the result.
        let watching = std::thread::spawn(move || {
            let stderr = std::io::stderr();
            let is_terminal = stderr.is_terminal();
            watch(other, &title, &show, &mut Screen::new(stderr, is_terminal))
        });
        Ok((Some(Onlooker::new(own, self.speed)), Some(Watching(watching))))
    }
}

impl Watching {
    /// Until people have seen enough.
    pub(crate) fn end(self) -> Result<(), HostError> {
        self.0.join().unwrap_or(Ok(()))
    }
}
