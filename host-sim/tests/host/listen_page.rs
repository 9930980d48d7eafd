//! `host-sim listen --serve`: a body on a socket, its recording, and viewers.

#[path = "../../../live/tests/common/browser.rs"]
#[allow(dead_code, reason = "written for the page's own tests")]
mod browser;
#[cfg(target_os = "linux")]
mod hostile;
mod measured;
mod parts;
mod rehearsal;

use std::fs;
use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use parts::{Listening, body, now_ms};
use serde_json::Value;
use towmag::link::{FrameKind, FrameReader, text_frame};

/// The recording without what this program has put into it, and that.
fn taken_apart(recorded: &[u8]) -> (Vec<u8>, Vec<String>) {
    let (mut reader, mut notes, mut rest) = (FrameReader::default(), Vec::new(), recorded.to_vec());
    for &byte in recorded {
        if let Some(received) = reader.push(byte).filter(|received| received.kind == FrameKind::Text) {
            notes.push(String::from_utf8(received.body.to_vec()).unwrap());
        }
    }
    notes.retain(|note| note.starts_with("ship: "));
    for note in &notes {
        let frame = text_frame(note);
        let place = rest.windows(frame.len()).position(|bytes| bytes == frame.as_slice()).expect("it is there whole");
        rest.drain(place..place + frame.len());
    }
    assert_eq!(reader.counters().bad, 0);
    (rest, notes)
}

#[test]
fn what_is_shown_and_marked_is_in_the_files_and_is_shown_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let (port, body) = body(60, Duration::from_millis(100));
    let files = ["--record", &path("cable.bin"), "--csv", &path("cable.csv")].map(str::to_string);
    let arguments: Vec<&str> =
        [&port, "--allow-commands"].into_iter().chain(files.iter().map(String::as_str)).collect();
    let listening = Listening::begin(&arguments);
    let mut viewer = listening.viewer();
    assert_eq!(viewer.next("hello")["may_command"], true);
    // The first message comes before the body has told where it is.
    let rows = std::iter::repeat_with(|| viewer.next("epochs")["rows"][0].clone());
    let row = rows.take(20).find(|row| row[3].is_array()).unwrap();
    assert_eq!((row[2][3].as_f64(), row[3][0].as_f64()), (Some(0.02), Some(54.3)));
    let late_s = now_ms() as f64 / 1e3 - row[1].as_f64().unwrap();
    assert!((0.0..3.0).contains(&late_s), "{late_s}");
    let lamps = listening.viewer().next("hello")["lamps"].clone();
    for (name, word) in
        [("sensor", "signal 1200"), ("log", "logging"), ("time", "within 12 ms"), ("ship", "cable.bin, cable.csv")]
    {
        assert_eq!(lamps[name]["word"], word);
    }
    viewer.send(r#"{"want":"mark","time_s":null,"label":"wreck"}"#);
    assert_eq!(viewer.next("mark")["mark"]["label"], "wreck");
    viewer.send(r#"{"want":"command","line":"status"}"#);
    let (sent, typed) = body.join().unwrap();
    assert!(typed.iter().any(|line| line.contains(" status*")), "{typed:?}");
    listening.line("60 messages, 0 lost");
    let (rest, notes) = taken_apart(&fs::read(path("cable.bin")).unwrap());
    assert_eq!(rest, sent, "every byte of the body is there, in its order");
    assert!(notes[0].starts_with("ship: mark 1") && notes[0].ends_with(" wreck"), "{notes:?}");
    let table = fs::read_to_string(path("cable.csv")).unwrap();
    assert_eq!((table.lines().count(), table.matches(&notes[0]).count()), (61, 1));
    drop(listening);
    for name in ["cable.bin", "cable.csv"] {
        shown_again(&path(name), 58..=60, true);
    }
}

/// What was recorded is shown again, and stays until the program is ended.
fn shown_again(file: &str, epochs: RangeInclusive<u32>, is_marked: bool) {
    let listening = Listening::begin(&["--replay", file, "--speed", "50"]);
    let mut viewer = listening.viewer();
    let hello = viewer.next("hello");
    assert_eq!((&hello["is_live"], &hello["may_mark"]), (&Value::Bool(false), &Value::Bool(true)));
    if hello["is_over"] == false {
        viewer.next("end");
    }
    let mut again = listening.viewer();
    let hello = again.next("hello");
    assert_eq!(hello["is_over"], true);
    if is_marked {
        assert_eq!(hello["marks"][0]["label"], "wreck", "{file}");
    }
    again.send(r#"{"want":"history","window_s":120,"since_s":null}"#);
    let history = again.next("history");
    let cells = history["time_s"].as_array().unwrap().len() as u32;
    assert!(epochs.contains(&cells), "{file}: {cells} of {epochs:?}");
    let compensated = history["low"].as_array().unwrap().iter().filter(|cell| cell[1].is_number()).count() as u32;
    assert!(compensated >= epochs.start() / 2, "{file}: {compensated}");
}

#[test]
fn any_recording_is_shown_again_compensated() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sample/survey.csv");
    let text = fs::read_to_string(sample).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let short = folder.path().join("short.csv");
    fs::write(&short, text.lines().take(601).map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    shown_again(short.to_str().unwrap(), 598..=600, false);
}

#[test]
fn what_cannot_be_shown_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("rubbish");
    fs::write(&file, [1, 2, 3, 255].repeat(100)).unwrap();
    for arguments in [
        vec!["listen", "--replay", file.to_str().unwrap()],
        vec!["listen", "--replay", "nowhere.bin"],
        vec!["listen", "--replay", "a", "--speed", "0"],
        vec!["listen", "localhost:1", "--speed", "2"],
        vec!["listen", "localhost:1", "--allow-commands"],
        vec!["listen", "localhost:1", "--serve", "8080"],
        vec!["listen"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_host-sim"))
            .args(&arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(2), "{arguments:?}: {said}");
        assert!(!said.is_empty());
    }
}
