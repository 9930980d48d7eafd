//! Viewers that mean no good, or that cannot follow: the others are served, memory is bounded, and the feed never waits.
#![cfg(not(target_os = "none"))]

mod common;

use std::io::Write;
use std::net::TcpStream;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use common::demo::{host, now_s, sample, server};
use common::raw::{Viewer, answer, get};
use towmag_live::{Limits, Server, Update};
use tungstenite::Message;

/// A little noise that is the same each time (a linear congruential generator, Numerical Recipes).
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.0 >> 8
    }

    fn bytes(&mut self, most: u32) -> Vec<u8> {
        let count = self.next() % most;
        (0..count).map(|_| self.next() as u8).collect()
    }
}

/// Resident memory of this process, kB; 0 where the system does not tell.
fn memory_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
    line.split_whitespace().nth(1).and_then(|kb| kb.parse().ok()).unwrap_or(0)
}

/// One test at a time: some measure the memory of this process, and all load it.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A viewer that behaves is still greeted and told what is new, once the server has found that the others are gone.
fn still_serves(server: &Server, tick: u32) {
    let own = host(server);
    until(|| Viewer::connect(&own, "/live", &[]).is_ok());
    let (mut viewer, _) = Viewer::greeted(&own);
    server.feed().send(Update::Sample(sample(now_s(), tick)));
    viewer.next("epochs");
    assert_eq!(server.feed().lost(), 0);
}

#[test]
fn only_what_is_embedded_is_found() {
    let _alone = alone();
    let server = server(|_| {});
    for path in [
        "/../Cargo.toml",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/live/../../etc/passwd",
        "//etc/passwd",
        "/index.html",
        "/page.js",
        "/.%00/",
        "/live/",
        "/?token=%ff%00",
        "/%",
        "/live%2f",
    ] {
        let answer = get(&host(&server), path);
        assert!(!answer.contains("root:") && !answer.contains("[package]"), "{path}");
        let status = answer.split(' ').nth(1).unwrap_or("closed");
        assert!(["200", "400", "403", "404", "closed"].contains(&status), "{path}: {answer}");
        assert!(status != "200" || path.starts_with("/?"), "{path}");
    }
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "BREW"] {
        let answer = answer(
            &host(&server),
            format!("{method} / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", host(&server)).as_bytes(),
        );
        assert!(!answer.starts_with("HTTP/1.1 2"), "{method}: {answer}");
    }
    still_serves(&server, 1);
}

#[test]
fn pages_of_others_are_kept_out() {
    let _alone = alone();
    let server = server(|_| {});
    let own = host(&server);
    let request = |host: &str, more: &str| format!("GET / HTTP/1.1\r\nHost: {host}\r\n{more}Connection: close\r\n\r\n");
    for (name, more, status) in [
        (own.as_str(), "", "200"),
        ("localhost", "", "200"),
        ("evil.example", "", "403"),
        (own.as_str(), "Origin: http://evil.example\r\n", "403"),
        (own.as_str(), "Host: evil.example\r\n", "403"),
    ] {
        let answer = answer(&own, request(name, more).as_bytes());
        assert!(answer.starts_with(&format!("HTTP/1.1 {status}")), "{name} {more}: {answer}");
    }
    assert!(Viewer::connect(&own, "/live", &[("origin", &format!("http://{own}"))]).is_ok());
    for origin in ["http://evil.example", "null", "https://127.0.0.1", "file://"] {
        let refused = Viewer::connect(&own, "/live", &[("origin", origin)]);
        assert!(matches!(refused, Err(tungstenite::Error::Http(answer)) if answer.status() == 403), "{origin}");
    }
}

#[test]
fn rubbish_stops_nothing() {
    let _alone = alone();
    let server = server(|_| {});
    let (own, mut noise) = (host(&server), Noise(7));
    for round in 0..1_000 {
        let mut stream = TcpStream::connect(&own).unwrap();
        let bytes = match round % 4 {
            0 => noise.bytes(3_000),
            1 => [b"GET / HTTP/1.1\r\n".to_vec(), noise.bytes(300)].concat(),
            2 => format!("GET /{} HTTP/1.1\r\nHost: {own}\r\nX: {}\r\n\r\n", "a".repeat(noise.next() as usize % 20_000), "b".repeat(noise.next() as usize % 20_000)).into_bytes(),
            _ => format!("GET /live HTTP/1.1\r\nHost: {own}\r\nUpgrade: websocket\r\nConnection: upgrade\r\nSec-WebSocket-Version: {}\r\n\r\n", noise.next()).into_bytes(),
        };
        // It may be closed before all is said.
        _ = stream.write_all(&bytes);
    }
    still_serves(&server, 1);
}

#[test]
fn rubbish_of_a_greeted_viewer_stops_nothing() {
    let _alone = alone();
    let server = server(|options| options.allow_commands = true);
    let (own, mut noise, mut dismissed) = (host(&server), Noise(9), 0);
    let texts = [
        "{",
        "null",
        r#"{"want":"history"}"#,
        r#"{"want":"history","window_s":-1e308,"since_s":1e308}"#,
        r#"{"want":"mark","time_s":1e999,"label":""}"#,
        r#"{"want":"acknowledge","alarm":"\u0000"}"#,
        r#"{"want":"command","line":"a","line":"b"}"#,
    ];
    for round in 0..400_usize {
        let (mut viewer, _) = Viewer::greeted(&own);
        let sent = match round % 4 {
            0 => viewer.0.send(Message::text(texts[round / 4 % texts.len()])),
            1 => viewer.0.send(Message::binary(noise.bytes(2_000))),
            2 => viewer.0.send(Message::text("x".repeat(2_000 + noise.next() as usize % 100_000))),
            // Past the WebSocket, straight into the socket.
            _ => viewer.0.get_mut().write_all(&noise.bytes(4_000)).map_err(tungstenite::Error::from),
        };
        if sent.is_ok() && round % 4 == 1 {
            let end = std::iter::repeat_with(|| viewer.0.read())
                .find(|read| !matches!(read, Ok(Message::Text(_) | Message::Ping(_))));
            dismissed += usize::from(matches!(end, Some(Ok(Message::Close(Some(_))))));
        }
    }
    assert_eq!(dismissed, 100, "each is told why");
    still_serves(&server, 1);
}

#[test]
fn too_many_wishes_end_the_visit() {
    let _alone = alone();
    let server = server(|_| {});
    let (mut viewer, _) = Viewer::greeted(&host(&server));
    for _ in 0..200 {
        _ = viewer.0.send(Message::text(r#"{"want":"history","window_s":43200,"since_s":null}"#));
    }
    let read: Vec<_> = std::iter::from_fn(|| viewer.0.read().ok()).collect();
    let answers = read.iter().filter(|message| message.to_text().is_ok_and(|text| text.contains("history"))).count();
    assert!((20..80).contains(&answers), "{answers}");
    // It is told why, unless what it has sent beyond that has already cut the connection.
    let told = read.iter().find_map(|message| if let Message::Close(frame) = message { frame.clone() } else { None });
    assert!(told.is_none_or(|frame| frame.reason == "too many wishes"));
    still_serves(&server, 1);
}

/// Wait until it is so.
fn until(mut is_so: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < Duration::from_secs(10), "it never was so");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Connections that are open: those that the server has closed read as ended.
fn open(streams: &mut [TcpStream]) -> usize {
    streams
        .iter_mut()
        .filter(|stream| {
            stream.set_nonblocking(true).unwrap();
            !matches!(stream.peek(&mut [0]), Ok(0))
                && !matches!(stream.peek(&mut [0]), Err(error) if error.kind() == std::io::ErrorKind::ConnectionReset)
        })
        .count()
}

#[test]
fn a_thousand_connections_are_too_many_and_those_that_ask_nothing_go() {
    let _alone = alone();
    let limits = Limits { request: Duration::from_millis(1_000), ..Limits::default() };
    let server = server(|options| options.limits = limits);
    let before_kb = memory_kb();
    let mut streams: Vec<TcpStream> = (0..1_000).map(|_| TcpStream::connect(host(&server)).unwrap()).collect();
    // Some say a little, and then nothing.
    streams.iter_mut().step_by(3).for_each(|stream| _ = stream.write_all(b"GET / HTTP/1.1\r\nHost: "));
    until(|| (1..=limits.local).contains(&open(&mut streams)));
    assert!(memory_kb() < before_kb + 20_000, "{} kB", memory_kb() - before_kb);
    until(|| open(&mut streams) == 0);
    still_serves(&server, 1);
}

/// A feed at a hundred times the speed, for so many seconds. The longest time that a send took.
fn fast_feed(server: &Server, start_s: f64, seconds: u32) -> Duration {
    let (feed, begin, mut longest) = (server.feed(), Instant::now(), Duration::ZERO);
    for tick in 0..1_000 * seconds {
        let sending = Instant::now();
        feed.send(Update::Sample(sample(start_s, tick)));
        if tick % 10 == 0 {
            // Each is a message of its own.
            feed.send(Update::Text(format!("line {tick} of an answer")));
        }
        longest = longest.max(sending.elapsed());
        let due = Duration::from_micros(u64::from(tick) * 1_000);
        if let Some(rest) = due.checked_sub(begin.elapsed()).filter(|rest| *rest > Duration::from_millis(5)) {
            std::thread::sleep(rest);
        }
    }
    longest
}

#[test]
fn a_viewer_that_does_not_read_loses_messages_is_told_and_disturbs_nobody() {
    let _alone = alone();
    let limits = Limits { patience: Duration::from_secs(60), ..Limits::default() };
    let server = server(|options| options.limits = limits);
    let own = host(&server);
    let mut slow: Vec<Viewer> = (0..10).map(|_| Viewer::greeted(&own).0).collect();
    // Each asks for much and takes nothing: its socket is full, and stays so.
    let before_kb = memory_kb();
    let start_s = now_s();
    fast_feed(&server, start_s, 1);
    for viewer in &mut slow {
        (0..25).for_each(|_| viewer.send(r#"{"want":"history","window_s":600,"since_s":null}"#));
    }
    let (mut quick, _) = Viewer::greeted(&own);
    let quick = std::thread::spawn(move || {
        let mut rows = 0;
        while rows < 5_500 {
            rows += quick.next("epochs")["rows"].as_array().unwrap().len();
        }
        rows
    });
    let longest = fast_feed(&server, start_s + 200.0, 6);
    assert_eq!(server.feed().lost(), 0);
    assert!(longest < Duration::from_millis(100), "{longest:?}: the feed waits for nobody");
    assert!(quick.join().unwrap() >= 5_500, "who follows loses nothing");
    println!("{} kB more with ten viewers that do not read", memory_kb().saturating_sub(before_kb));
    assert!(memory_kb() < before_kb + 30_000, "{} kB", memory_kb() - before_kb);
    let told = slow[0].next("lost");
    assert!(told["messages"].as_u64().unwrap() > 0);
    slow[0].next("epochs");
}

#[test]
fn who_takes_nothing_for_long_is_gone() {
    let _alone = alone();
    let limits = Limits { local: 1, patience: Duration::from_millis(300), ..Limits::default() };
    let server = server(|options| options.limits = limits);
    let own = host(&server);
    // It never answers a ping, for it never reads.
    let (_silent, _) = Viewer::greeted(&own);
    assert!(Viewer::connect(&own, "/live", &[]).is_err(), "there is one place only");
    std::thread::sleep(Duration::from_millis(1_500));
    still_serves(&server, 1);
}
