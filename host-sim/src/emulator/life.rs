//! QEMU from its start to its end: one life of the body.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::error::EmulatorError;
use super::onlooker::Onlooker;

/// The emulator.
const QEMU: &str = "qemu-system-arm";

/// QEMU starts in a fraction of a second.
const START_LIMIT: Duration = Duration::from_secs(20);

/// A body that asks for nothing this long hangs: the longest it ever takes is to fill a new log file.
const SILENCE_LIMIT: Duration = Duration::from_secs(60);

/// A running emulator.
pub(super) struct Life {
    child: Child,
    requests: Receiver<io::Result<Vec<u8>>>,
    answers: ChildStdin,
    scalar: UnixStream,
    nmea: UnixStream,
    console: UnixStream,
    cable: Option<JoinHandle<io::Result<Vec<u8>>>>,
}

impl Life {
    /// Start the firmware of `image` with the files of `folder`.
    pub(super) fn begin(image: &Path, folder: &Path, onlooker: Option<Onlooker>) -> Result<Self, EmulatorError> {
        let (scalar, cable, nmea) = (listen(folder, "scalar")?, listen(folder, "cable")?, listen(folder, "nmea")?);
        let mut child = spawn(image, folder)?;
        let scalar = accept(scalar, &mut child, folder)?;
        let console = accept(cable, &mut child, folder)?;
        let nmea = accept(nmea, &mut child, folder)?;
        let (Some(answers), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(EmulatorError::Broken("the emulator has no standard input".into()));
        };
        let reader = console.try_clone().map_err(EmulatorError::io("cable"))?;
        let cable = Some(thread::spawn(move || read_all(reader, onlooker.as_ref())));
        let (sender, requests) = channel();
        thread::spawn(move || read_requests(stdout, &sender));
        Ok(Self { child, requests, answers, scalar, nmea, console, cable })
    }

    /// The next request of the body, without its length; `None` when the emulator has ended.
    pub(super) fn request(&mut self) -> Result<Option<Vec<u8>>, EmulatorError> {
        match self.requests.recv_timeout(SILENCE_LIMIT) {
            Ok(request) => request.map(Some).map_err(EmulatorError::io("request")),
            Err(RecvTimeoutError::Disconnected) => Ok(None),
            Err(RecvTimeoutError::Timeout) => Err(EmulatorError::Broken(format!(
                "the body has asked for nothing for {} s: it hangs",
                SILENCE_LIMIT.as_secs()
            ))),
        }
    }

    pub(super) fn answer(&mut self, answer: &[u8]) -> Result<(), EmulatorError> {
        self.answers.write_all(answer).map_err(EmulatorError::io("answer"))
    }

    /// To the UART of the scalar sensor.
    pub(super) fn send_scalar(&mut self, bytes: &[u8]) -> Result<(), EmulatorError> {
        self.scalar.write_all(bytes).map_err(EmulatorError::io("scalar sensor"))
    }

    /// To the UART of the depth sensor.
    pub(super) fn send_nmea(&mut self, bytes: &[u8]) -> Result<(), EmulatorError> {
        self.nmea.write_all(bytes).map_err(EmulatorError::io("depth sensor"))
    }

    /// Down the cable.
    pub(super) fn send_console(&mut self, bytes: &[u8]) -> Result<(), EmulatorError> {
        self.console.write_all(bytes).map_err(EmulatorError::io("cable"))
    }

    /// Cut the power.
    pub(super) fn kill(&mut self) {
        // Fails when it has ended already, which is as good.
        _ = self.child.kill();
    }

    /// After the end: whether the firmware itself has ended it, and all that came up the cable.
    pub(super) fn end(&mut self) -> Result<(bool, Vec<u8>), EmulatorError> {
        let status = self.child.wait().map_err(EmulatorError::io("emulator"))?;
        let Some(Ok(cable)) = self.cable.take().map(JoinHandle::join) else {
            return Err(EmulatorError::Broken("the cable cannot be read".into()));
        };
        Ok((status.success(), cable.map_err(EmulatorError::io("cable"))?))
    }
}

impl Drop for Life {
    fn drop(&mut self) {
        self.kill();
        _ = self.child.wait();
    }
}

fn listen(folder: &Path, name: &str) -> Result<UnixListener, EmulatorError> {
    let path = folder.join(name);
    // That of the life before.
    _ = std::fs::remove_file(&path);
    UnixListener::bind(path).map_err(EmulatorError::io("socket"))
}

fn spawn(image: &Path, folder: &Path) -> Result<Child, EmulatorError> {
    let log = File::create(folder.join("qemu.log")).map_err(EmulatorError::io("log"))?;
    let mut command = Command::new(QEMU);
    command.current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(log);
    command.args(["-machine", "netduinoplus2", "-icount", "shift=0,sleep=off", "-display", "none", "-monitor", "none"]);
    command.args(["-serial", "unix:scalar", "-serial", "unix:cable", "-serial", "unix:nmea"]);
    command.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
    command.arg(image).spawn().map_err(|source| match source.kind() {
        ErrorKind::NotFound => EmulatorError::NoQemu { program: QEMU.into() },
        _ => EmulatorError::Io { what: "emulator", source },
    })
}

/// Wait for the emulator to connect, but not for one that has ended.
fn accept(listener: UnixListener, child: &mut Child, folder: &Path) -> Result<UnixStream, EmulatorError> {
    listener.set_nonblocking(true).map_err(EmulatorError::io("socket"))?;
    let begin = Instant::now();
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false).map_err(EmulatorError::io("socket"))?;
                return Ok(stream);
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(source) => return Err(EmulatorError::Io { what: "socket", source }),
        }
        let ended = child.try_wait().map_err(EmulatorError::io("emulator"))?.is_some();
        if ended || begin.elapsed() > START_LIMIT {
            _ = child.kill();
            return Err(EmulatorError::Broken(format!("{QEMU} does not start: {}", complaint(folder))));
        }
        thread::sleep(Duration::from_millis(5));
    }
}

/// Give on requests until the emulator ends.
fn read_requests(stdout: ChildStdout, requests: &Sender<io::Result<Vec<u8>>>) {
    let mut stdout = io::BufReader::new(stdout);
    loop {
        let request = match read_request(&mut stdout) {
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return,
            request => request,
        };
        let failed = request.is_err();
        if requests.send(request).is_err() || failed {
            return;
        }
    }
}

fn read_request(stdout: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut len = [0; 2];
    stdout.read_exact(&mut len)?;
    let mut request = vec![0; u16::from_le_bytes(len).into()];
    stdout.read_exact(&mut request)?;
    Ok(request)
}

fn read_all(mut cable: UnixStream, onlooker: Option<&Onlooker>) -> io::Result<Vec<u8>> {
    let (mut bytes, mut some) = (Vec::new(), [0; 4096]);
    loop {
        match cable.read(&mut some) {
            Ok(0) => return Ok(bytes),
            Ok(count) => {
                onlooker.iter().for_each(|onlooker| onlooker.see(&some[..count]));
                bytes.extend_from_slice(&some[..count]);
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            // How the emulator's end of the socket ends is of no interest.
            Err(error) if error.kind() == ErrorKind::ConnectionReset => return Ok(bytes),
            Err(error) => return Err(error),
        }
    }
}

/// What the emulator itself had to say.
pub(super) fn complaint(folder: &Path) -> String {
    let text = std::fs::read_to_string(folder.join("qemu.log")).unwrap_or_default();
    let last = text.lines().last().unwrap_or("it says nothing");
    crate::message::on_one_line(last)
}
