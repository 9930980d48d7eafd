//! `host-sim listen --serve` as a program, a body on a socket for it, and viewers.

use std::io::{BufRead, BufReader, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use serde_json::Value;
use towmag::Status;
use towmag::link::{
    Activity, CompensatedField, FaultSlice, NavigationMessage, Quality, Telemetry, acknowledgement, text_frame,
};
use towmag::navigation::{Navigation, Position};
use towmag::sensors::grid::{FluxMark, ScalarMark};
use tungstenite::{Message, WebSocket};

pub(crate) fn now_ms() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_millis() as u64
}

/// What the body tells at an epoch and a time.
pub(crate) fn told(tick: u32, unix_ms: u64) -> Vec<u8> {
    let compensated = CompensatedField { compensated_pt: 49_000_000 + (tick % 50) as i32, residual_nt: 0.02 };
    let message = Telemetry {
        tick,
        unix_ms: Some(unix_ms),
        time_error_ms: Some(12),
        raw_scalar_pt: Some(50_000_000 + tick as i32),
        compensated: Some(compensated),
        status: Status::Used,
        quality: Quality {
            scalar: ScalarMark::Present,
            flux: FluxMark::Present,
            duplicates: false,
            relocked: false,
            signal: Some(1200),
        },
        activity: Activity { logging: true, calibrating: false, log_failing: false },
        faults: FaultSlice { first: 0, counts: [0; 2] },
    };
    let mut bytes = message.frame().to_vec();
    if tick.is_multiple_of(5) {
        let position = Some(Position { latitude_e7: 543_000_000, longitude_e7: 102_000_000 + tick as i32, fix: 2 });
        let navigation = Navigation { depth_m: Some(12.5), altitude_m: Some(3.25), position, heading: None };
        bytes.extend_from_slice(&NavigationMessage { tick, navigation }.frame());
    }
    bytes
}

/// The program, and what it prints.
pub(crate) struct Listening {
    pub(crate) child: Child,
    lines: Receiver<String>,
    /// The page's address as `host:port`.
    pub(crate) host: String,
}

impl Listening {
    pub(crate) fn begin(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
        command.arg("listen").args(arguments).args(["--serve", "127.0.0.1:0"]);
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::inherit()).spawn().unwrap();
        let (sender, lines) = channel();
        let stdout = BufReader::new(child.stdout.take().unwrap());
        std::thread::spawn(move || stdout.lines().map_while(Result::ok).for_each(|line| _ = sender.send(line)));
        let mut listening = Self { child, lines, host: String::new() };
        let line = listening.line("the page is at http://");
        listening.host = line.trim_start_matches("the page is at http://").trim_end_matches('/').into();
        listening
    }

    /// The next line with this in it.
    pub(crate) fn line(&self, words: &str) -> String {
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_secs(60) {
            match self.lines.recv_timeout(Duration::from_secs(60)) {
                Ok(line) if line.contains(words) => return line,
                Ok(_) => {}
                Err(error) => panic!("{words}: {error}"),
            }
        }
        panic!("nobody said: {words}");
    }

    pub(crate) fn viewer(&self) -> Viewer {
        Viewer::connect(&self.host)
    }
}

impl Drop for Listening {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

pub(crate) struct Viewer(pub(crate) WebSocket<TcpStream>);

impl Viewer {
    /// Connect to `host:port`.
    pub(crate) fn connect(host: &str) -> Self {
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        Self(tungstenite::client(format!("ws://{host}/live"), stream).unwrap().0)
    }

    pub(crate) fn send(&mut self, json: &str) {
        self.0.send(Message::text(json)).unwrap();
    }

    pub(crate) fn next(&mut self, kind: &str) -> Value {
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_secs(30) {
            if let Message::Text(text) = self.0.read().unwrap() {
                let value: Value = serde_json::from_str(&text).unwrap();
                if value["kind"] == kind {
                    return value;
                }
            }
        }
        panic!("no {kind} came");
    }
}

/// The bytes that a body has sent, and the lines that it was sent.
pub(crate) type Exchanged = (Vec<u8>, Vec<String>);

/// A body on a socket that tells so many epochs in all and then hangs up; the bytes that it has sent, and the lines that it
/// was sent, each of which it acknowledges.
pub(crate) fn body(epochs: u32, step: Duration) -> (String, JoinHandle<Exchanged>) {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = server.local_addr().unwrap().to_string();
    let body = std::thread::spawn(move || {
        let (mut stream, _) = server.accept().unwrap();
        let (sender, typed) = channel();
        let commands = BufReader::new(stream.try_clone().unwrap());
        std::thread::spawn(move || commands.lines().map_while(Result::ok).for_each(|line| _ = sender.send(line)));
        let (mut sent, mut lines, begin) = (Vec::new(), Vec::new(), Instant::now());
        for tick in 0..epochs {
            std::thread::sleep((step * tick).saturating_sub(begin.elapsed()));
            // The stamp is that of the bytes on the cable.
            let mut bytes = told(tick, now_ms());
            for line in typed.try_iter() {
                let number = line[1..].split_once(' ').unwrap().0.parse().unwrap();
                bytes.extend_from_slice(&text_frame(&acknowledgement(number)));
                lines.push(line);
            }
            stream.write_all(&bytes).unwrap();
            sent.extend_from_slice(&bytes);
        }
        stream.shutdown(Shutdown::Both).unwrap();
        (sent, lines)
    });
    (port, body)
}
