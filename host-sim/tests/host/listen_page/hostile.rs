//! Viewers that mean no good while a body is recorded: the file has every byte, and memory is bounded.

use std::fs;
use std::io::Write;
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use tungstenite::Message;

use super::measured::memory_kb;
use super::parts::{Listening, Viewer, now_ms, told};

/// Requests and frames that are none.
const MALFORMED: usize = 10_000;
/// Every so many of them is sent by a viewer that was greeted.
const GREETED_IN: usize = 10;
/// At the same time, from threads of their own.
const THREADS: usize = 4;
/// Connections at once that ask nothing.
const IDLE: usize = 1_000;
/// Viewers that ask for much and read nothing.
const SLOW: usize = 5;
/// What all of them may take of memory: 1,300 kB were measured, and 10 kB for each idle one would be too much.
const MOST_MORE_KB: u64 = 10_000;

/// A body that tells fifty times a second until it is to stop; what it has sent.
fn body(is_over: &Arc<AtomicBool>) -> (String, JoinHandle<Vec<u8>>) {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let (port, is_over) = (server.local_addr().unwrap().to_string(), Arc::clone(is_over));
    let body = std::thread::spawn(move || {
        let (mut stream, _) = server.accept().unwrap();
        let mut sent = Vec::new();
        for tick in 0.. {
            let bytes = told(tick, now_ms());
            stream.write_all(&bytes).unwrap();
            sent.extend_from_slice(&bytes);
            if is_over.load(Ordering::Relaxed) {
                break;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        stream.shutdown(Shutdown::Both).unwrap();
        sent
    });
    (port, body)
}

/// A viewer, if there is a place for it.
fn viewer(host: &str) -> Option<Viewer> {
    let stream = TcpStream::connect(host).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    Some(Viewer(tungstenite::client(format!("ws://{host}/live"), stream).ok()?.0))
}

/// Bytes that follow no rule, the same each time (Numerical Recipes' generator).
fn noise(seed: usize, count: usize) -> Vec<u8> {
    let mut state = seed as u32;
    let next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    std::iter::repeat_with(next).take(count).collect()
}

/// One request that is none; the connection may be closed before all is said.
fn request(host: &str, number: usize) {
    let Ok(mut stream) = TcpStream::connect(host) else { return };
    let bytes = match number % 4 {
        0 => noise(number, number % 3_000),
        1 => [b"GET / HTTP/1.1\r\n".to_vec(), noise(number, 300)].concat(),
        2 => format!("GET /{} HTTP/1.1\r\nHost: {host}\r\n\r\n", "a".repeat(number % 20_000)).into_bytes(),
        _ => format!(
            "GET /live HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nSec-WebSocket-Version: {number}\r\n\r\n"
        )
        .into_bytes(),
    };
    _ = stream.write_all(&bytes);
}

/// One frame that is none, if there is a place for who sends it.
fn frame(host: &str, number: usize) -> bool {
    let Some(mut viewer) = viewer(host) else { return false };
    _ = match number / GREETED_IN % 3 {
        0 => viewer.0.send(Message::text(r#"{"want":"history","window_s":-1e308,"since_s":1e308}"#)),
        1 => viewer.0.send(Message::binary(noise(number, 2_000))),
        // Past the WebSocket, straight into the socket.
        _ => viewer.0.get_mut().write_all(&noise(number, 4_000)).map_err(tungstenite::Error::from),
    };
    true
}

/// All that is malformed, from several threads; how many frames were sent by one who was greeted.
fn malformed(host: &str) -> usize {
    let greeted = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for thread in 0..THREADS {
            let greeted = &greeted;
            scope.spawn(move || {
                for number in (thread..MALFORMED).step_by(THREADS) {
                    match number % GREETED_IN {
                        0 => _ = greeted.fetch_add(frame(host, number).into(), Ordering::Relaxed),
                        _ => request(host, number),
                    }
                }
            });
        }
    });
    greeted.into_inner()
}

#[test]
fn a_hostile_crowd_takes_nothing_from_the_recording() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("cable.bin");
    let is_over = Arc::new(AtomicBool::new(false));
    let (port, body) = body(&is_over);
    let listening = Listening::begin(&[&port, "--record", record.to_str().unwrap()]);
    let (host, pid) = (listening.host.clone(), listening.child.id());
    listening.viewer().next("epochs");
    let before_kb = memory_kb(pid, "VmRSS:");
    let mut slow: Vec<Viewer> = (0..SLOW).map(|_| listening.viewer()).collect();
    for viewer in &mut slow {
        (0..20).for_each(|_| viewer.send(r#"{"want":"history","window_s":43200,"since_s":null}"#));
    }
    let begin = Instant::now();
    let greeted = malformed(&host);
    let idle: Vec<TcpStream> = (0..IDLE).filter_map(|_| TcpStream::connect(&host).ok()).collect();
    std::thread::sleep(Duration::from_secs(1));
    let most_kb = memory_kb(pid, "VmHWM:");
    println!(
        "{:.1} s, {greeted} greeted, {} idle, {} kB more",
        begin.elapsed().as_secs_f64(),
        idle.len(),
        most_kb - before_kb
    );
    assert!(greeted >= MALFORMED / GREETED_IN / 10, "{greeted} frames were sent by one who was greeted");
    assert!(
        idle.len() == IDLE && most_kb < before_kb + MOST_MORE_KB,
        "{} idle, {before_kb} to {most_kb} kB",
        idle.len()
    );
    drop((idle, slow));
    let served = std::iter::repeat_with(|| std::thread::sleep(Duration::from_millis(50))).take(400);
    let mut back = served.filter_map(|()| viewer(&host)).next().expect("who behaves is served again");
    back.next("epochs");
    is_over.store(true, Ordering::Relaxed);
    let sent = body.join().unwrap();
    listening.line(" messages, 0 lost");
    assert!(fs::read(&record).unwrap() == sent, "every byte of the body is there, in its order, and nothing else");
}
