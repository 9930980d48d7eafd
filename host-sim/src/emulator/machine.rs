//! QEMU with the firmware in it: its process, its UARTs, and the bridge.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use tempfile::TempDir;
use towmag::sensors::ads131m04::FRAME_BYTES;
use towmag::setup::Setup;

use super::EmulatorError;
use super::twin::Event;

/// Where `cargo fw-emu` puts the image.
pub const DEFAULT_IMAGE: &str = "target/emulation/thumbv7em-none-eabihf/release/firmware";

/// The emulator.
const QEMU: &str = "qemu-system-arm";

/// Where the firmware looks for its set-up: the last but one sector of the flash.
const SETUP_ADDRESS: u32 = 0x080C_0000;

/// QEMU starts in a fraction of a second.
const START_LIMIT: Duration = Duration::from_secs(20);

/// One SPI transaction of the body.
pub(super) struct Request {
    pub(super) frame: [u8; FRAME_BYTES],
    /// Data-ready edges since the body's start.
    pub(super) conversions: u32,
    pub(super) events: Vec<Event>,
}

/// The running emulator.
pub(super) struct Machine {
    child: Child,
    requests: io::BufReader<ChildStdout>,
    answers: ChildStdin,
    scalar: UnixStream,
    telemetry: Option<JoinHandle<io::Result<Vec<u8>>>>,
    scalar_bytes: u32,
    folder: TempDir,
}

impl Machine {
    /// Start the firmware of `image` with this set-up and an empty card.
    pub(super) fn start(image: &Path, setup: &Setup) -> Result<Self, EmulatorError> {
        let image = image.canonicalize().map_err(|_| EmulatorError::NoImage { path: image.display().to_string() })?;
        let folder = TempDir::new().map_err(EmulatorError::io("temporary folder"))?;
        let (bytes, len) = setup.encode(1).ok_or_else(|| EmulatorError::Broken("the set-up has no place".into()))?;
        std::fs::write(folder.path().join("setup.bin"), &bytes[..len]).map_err(EmulatorError::io("set-up"))?;
        super::card::format(&folder.path().join("card.img"), setup.log_blocks).map_err(EmulatorError::io("card"))?;
        let listen = |name: &str| UnixListener::bind(folder.path().join(name)).map_err(EmulatorError::io("socket"));
        let (scalar, cable) = (listen("scalar")?, listen("cable")?);
        let mut child = spawn(&image, folder.path())?;
        let accept = |listener| accept(listener, &mut child, folder.path());
        let (scalar, cable) = accept_both(accept, scalar, cable)?;
        let (Some(answers), Some(requests)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(EmulatorError::Broken("the emulator has no standard input".into()));
        };
        let telemetry = Some(thread::spawn(move || read_all(cable)));
        let requests = io::BufReader::new(requests);
        Ok(Self { child, requests, answers, scalar, telemetry, scalar_bytes: 0, folder })
    }

    /// The next transaction; `None` when the emulator has ended.
    pub(super) fn request(&mut self) -> Result<Option<Request>, EmulatorError> {
        let mut len = [0; 2];
        match self.requests.read_exact(&mut len) {
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(None),
            read => read.map_err(EmulatorError::io("request"))?,
        }
        let mut body = vec![0; u16::from_le_bytes(len).into()];
        self.requests.read_exact(&mut body).map_err(EmulatorError::io("request"))?;
        let broken = || EmulatorError::Broken("the firmware speaks another bridge protocol: build it again".into());
        let (&frame, rest) = body.split_first_chunk::<FRAME_BYTES>().ok_or_else(broken)?;
        let (&conversions, events) = rest.split_first_chunk::<4>().ok_or_else(broken)?;
        let events = events.as_chunks::<5>().0.iter().map(|event| Event::decode(*event));
        let events = events.collect::<Option<Vec<_>>>();
        let events = events.ok_or_else(|| EmulatorError::Broken("the body has lost events".into()))?;
        if events.contains(&Event::Boot) {
            self.scalar_bytes = 0; // so has the body's count
        }
        Ok(Some(Request { frame, conversions: u32::from_le_bytes(conversions), events }))
    }

    /// Send what the scalar sensor sends at this conversion, then the converter's answer.
    pub(super) fn answer(
        &mut self,
        frame: &[u8; FRAME_BYTES],
        sentence: &[u8],
        command: u8,
    ) -> Result<(), EmulatorError> {
        if !sentence.is_empty() {
            self.scalar.write_all(sentence).map_err(EmulatorError::io("scalar sensor"))?;
            self.scalar_bytes = self.scalar_bytes.wrapping_add(sentence.len() as u32);
        }
        let mut answer = frame.to_vec();
        answer.extend_from_slice(&self.scalar_bytes.to_le_bytes());
        answer.extend_from_slice(&[command, 0]);
        self.answers.write_all(&answer).map_err(EmulatorError::io("answer"))
    }

    /// After the last answer: everything that came down the cable, and the card. The folder lives with the machine.
    pub(super) fn finish(&mut self) -> Result<(Vec<u8>, PathBuf), EmulatorError> {
        self.child.wait().map_err(EmulatorError::io("emulator"))?;
        let telemetry = self.telemetry.take().map(JoinHandle::join);
        let Some(Ok(telemetry)) = telemetry else {
            return Err(EmulatorError::Broken("the cable cannot be read".into()));
        };
        Ok((telemetry.map_err(EmulatorError::io("cable"))?, self.folder.path().join("card.img")))
    }

    /// What the emulator itself had to say.
    pub(super) fn complaint(&self) -> String {
        complaint(self.folder.path())
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        // Both fail when it has ended already, which is as good.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

fn spawn(image: &Path, folder: &Path) -> Result<Child, EmulatorError> {
    let log = File::create(folder.join("qemu.log")).map_err(EmulatorError::io("log"))?;
    let mut command = Command::new(QEMU);
    command.current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(log);
    command.args(["-machine", "netduinoplus2", "-icount", "shift=0,sleep=off", "-display", "none", "-monitor", "none"]);
    command.args(["-serial", "unix:scalar", "-serial", "unix:cable"]);
    command.args(["-semihosting-config", "enable=on,target=native"]);
    command.args(["-device", &format!("loader,file=setup.bin,addr={SETUP_ADDRESS:#x},force-raw=on"), "-kernel"]);
    command.arg(image).spawn().map_err(|source| match source.kind() {
        ErrorKind::NotFound => EmulatorError::NoQemu { program: QEMU.into() },
        _ => EmulatorError::Io { what: "emulator", source },
    })
}

fn accept_both(
    mut accept: impl FnMut(UnixListener) -> Result<UnixStream, EmulatorError>,
    first: UnixListener,
    second: UnixListener,
) -> Result<(UnixStream, UnixStream), EmulatorError> {
    Ok((accept(first)?, accept(second)?))
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

fn read_all(mut cable: UnixStream) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match cable.read_to_end(&mut bytes) {
        // How the emulator's end of the socket ends is of no interest.
        Err(error) if error.kind() != ErrorKind::ConnectionReset => Err(error),
        _ => Ok(bytes),
    }
}

fn complaint(folder: &Path) -> String {
    let text = std::fs::read_to_string(folder.join("qemu.log")).unwrap_or_default();
    let last = text.lines().last().unwrap_or("it says nothing");
    crate::message::on_one_line(last)
}
