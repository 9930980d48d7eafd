//! `host-sim listen` on files and TCP: what is shown, what is kept, and that no garbage stops it.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Shutdown, TcpListener};
use std::path::Path;
use std::time::Duration;

use host_sim::error::HostError;
use host_sim::listen::{Heard, ListenOptions, Screen, listen};
use towmag::housekeeping::Housekeeping;
use towmag::link::{
    Activity, CompensatedField, FaultSlice, HousekeepingMessage, NavigationMessage, Quality, Telemetry,
    acknowledgement, text_frame,
};
use towmag::navigation::{Heading, Navigation, Position};
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag::store::CABLE_BAUD;
use towmag::{Rejection, Status};

fn message(tick: u32) -> Telemetry {
    let rejected = tick.is_multiple_of(7);
    Telemetry {
        tick,
        unix_ms: (!tick.is_multiple_of(5)).then(|| 1_767_225_600_000 + 100 * u64::from(tick)),
        time_error_ms: Some(12),
        raw_scalar_pt: Some(50_000_000 + tick as i32),
        compensated: (!rejected).then_some(CompensatedField { compensated_pt: 49_999_999, residual_nt: -0.25 }),
        status: if rejected { Status::Rejected(Rejection::FluxMissing) } else { Status::Used },
        quality: Quality {
            scalar: ScalarMark::Present,
            flux: if rejected { FluxMark::Missing } else { FluxMark::Present },
            duplicates: false,
            relocked: false,
            signal: Some(1200),
        },
        activity: Activity { logging: true, calibrating: false, log_failing: false },
        faults: FaultSlice { first: 0, counts: [0, if tick >= 20 { 3 } else { 0 }] },
    }
}

/// 30 messages, number 10 lost, garbage between all of them, one answer.
fn wire() -> Vec<u8> {
    let mut wire = Vec::new();
    for tick in (1..=30).filter(|&tick| tick != 10) {
        wire.extend_from_slice(&[0xff, tick as u8, 0, 0x80, 7]);
        wire.extend_from_slice(&message(tick).frame());
    }
    wire.extend_from_slice(&text_frame("lambda2 = \x1b[2J0.1"));
    wire
}

fn options(port: &str, folder: &Path) -> ListenOptions {
    let (record, csv) = (Some(folder.join("cable.bin")), Some(folder.join("telemetry.csv")));
    ListenOptions { port: port.into(), baud: Some(CABLE_BAUD), record, csv }
}

fn heard(options: &ListenOptions, is_terminal: bool) -> Result<(Heard, String), HostError> {
    let mut shown = Vec::new();
    let heard = listen(options, std::io::empty(), &mut Screen::new(&mut shown, is_terminal))?;
    Ok((heard, String::from_utf8(shown).unwrap()))
}

#[test]
fn a_recording_is_shown_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bin");
    fs::write(&input, wire()).unwrap();
    let options = options(input.to_str().unwrap(), folder.path());
    let (heard, shown) = heard(&options, false).unwrap();
    assert_eq!((heard.messages, heard.lost_ticks, heard.restarts, heard.lines), (29, 1, 0, 1));
    assert_eq!((heard.frames.bad, heard.frames.bad_bytes), (58, 116));
    assert_eq!(fs::read(folder.path().join("cable.bin")).unwrap(), wire());
    let lines: Vec<_> = shown.lines().collect();
    // One a second: ticks 1, 11, 20 and 30; the fault as it comes; the answer without its control characters; the sum.
    assert_eq!(lines.len(), 7, "{shown}");
    assert!(
        lines[0].contains("tick 1 raw 50000.001 nT, compensated 49999.999 nT, residual -0.250 nT, used"),
        "{shown}"
    );
    assert_eq!(lines[2], "fault: scalar cut lines 3 (+3)");
    assert_eq!(lines[5], "lambda2 = \\u{1b}[2J0.1");
    assert!(lines[6].starts_with("29 messages, 1 lost, 0 restarts, 1 lines of text; bad frames: 58 of 116 bytes"));
    let csv = fs::read_to_string(folder.path().join("telemetry.csv")).unwrap();
    let rows: Vec<_> = csv.lines().collect();
    assert_eq!(rows.len(), 30);
    assert!(
        rows[0].starts_with("tick,time_s,time_error_s,ship_time_s,scalar_nT,compensated_nT,residual_nT,valid,status")
    );
    assert_eq!(
        rows[1],
        "1,1767225600.100,0.012,,50000.001,49999.999,-0.25,1,used,present,present,1200,0,0,1,0,0,0,0 0,,,,,,,,,,"
    );
    assert_eq!(
        rows[7],
        "7,1767225600.700,0.012,,50000.007,,,0,fluxgate missing,present,no fluxgate,1200,0,0,1,0,0,0,0 0,,,,,,,,,,"
    );
}

#[test]
fn depth_and_altitude_are_shown_and_kept_until_they_are_too_old() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bin");
    let mut wire = Vec::new();
    for tick in 1..=60 {
        wire.extend_from_slice(&message(tick).frame());
        if tick == 11 {
            let position = Some(Position { latitude_e7: -337_654_321, longitude_e7: 1_512_345_678, fix: 2 });
            let heading = Some(Heading { deg: 94.5, is_magnetic: true });
            let navigation = Navigation { depth_m: Some(12.5), altitude_m: Some(3.25), position, heading };
            wire.extend_from_slice(&NavigationMessage { tick, navigation }.frame());
        }
    }
    fs::write(&input, wire).unwrap();
    let (heard, shown) = heard(&options(input.to_str().unwrap(), folder.path()), false).unwrap();
    assert_eq!((heard.messages, heard.undecodable, heard.frames.unknown), (60, 0, 0));
    let lines: Vec<_> = shown.lines().filter(|line| line.contains(" tick ")).collect();
    let has_depth = |line: &&&str| line.contains(", depth 12.50 m, altitude 3.25 m");
    assert_eq!((lines.len(), lines.iter().filter(has_depth).count()), (7, 3), "{shown}");
    let csv = fs::read_to_string(folder.path().join("telemetry.csv")).unwrap();
    let rows: Vec<_> = csv.lines().collect();
    let known = ",12.5,3.25,-33.7654321,151.2345678,2,,94.5,,,";
    assert!(
        rows[0]
            .contains(",depth_m,altitude_m,latitude_deg,longitude_deg,position_fix,heading_deg,heading_magnetic_deg,")
    );
    let known: Vec<usize> = (1..=60).filter(|&row| rows[row].ends_with(known)).collect();
    assert_eq!((known.first(), known.last(), known.len()), (Some(&12), Some(&41), 30));
}

#[test]
fn leak_and_battery_are_shown_and_kept_until_they_are_too_old() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bin");
    let mut wire = Vec::new();
    for tick in 1..=180 {
        wire.extend_from_slice(&message(tick).frame());
        if tick == 11 {
            let housekeeping = Housekeeping { battery_v: Some(11.75), has_leak: Some(true) };
            wire.extend_from_slice(&HousekeepingMessage { tick, housekeeping }.frame());
        }
    }
    fs::write(&input, wire).unwrap();
    let (heard, shown) = heard(&options(input.to_str().unwrap(), folder.path()), false).unwrap();
    assert_eq!((heard.messages, heard.undecodable, heard.frames.unknown), (180, 0, 0));
    let lines: Vec<_> = shown.lines().filter(|line| line.contains(" tick ")).collect();
    let is_told = |line: &&&str| line.contains(", battery 11.75 V") && line.contains(", LEAK");
    assert_eq!((lines.len(), lines.iter().filter(is_told).count()), (19, 15), "{shown}");
    let csv = fs::read_to_string(folder.path().join("telemetry.csv")).unwrap();
    let rows: Vec<_> = csv.lines().collect();
    assert!(rows[0].ends_with(",battery_V,leak,notes"));
    let known: Vec<usize> = (1..=180).filter(|&row| rows[row].ends_with(",11.75,1,")).collect();
    assert_eq!((known.first(), known.last(), known.len()), (Some(&12), Some(&161), 150));
    assert!(rows[170].ends_with(",,,"));
}

#[test]
fn a_terminal_has_one_line_that_is_refreshed() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bin");
    fs::write(&input, wire()).unwrap();
    let options =
        ListenOptions { port: input.to_str().unwrap().into(), baud: Some(CABLE_BAUD), record: None, csv: None };
    let (_, shown) = heard(&options, true).unwrap();
    assert_eq!(shown.matches("\x1b[K").count(), 29 + 2);
    assert_eq!(shown.matches('\n').count(), 4, "{shown}");
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bin");
    fs::write(&input, [1, 2, 3, 0].repeat(10_000)).unwrap();
    let own = options(input.to_str().unwrap(), folder.path());
    let error = heard(&own, false).unwrap_err();
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(error.to_string().ends_with("holds no whole frame: is it a recording of the tow cable?"));
    // The files are there now, and are not written over.
    let error = heard(&own, false).unwrap_err();
    assert!(error.to_string().contains("never written over") && error.exit_code() == 2, "{error}");
    for port in ["nowhere", folder.path().to_str().unwrap()] {
        let options = ListenOptions { port: port.into(), baud: Some(CABLE_BAUD), record: None, csv: None };
        assert_eq!(heard(&options, false).unwrap_err().exit_code(), 2);
    }
    let options = ListenOptions { port: "localhost:1".into(), baud: Some(CABLE_BAUD), record: None, csv: None };
    assert_eq!(heard(&options, false).unwrap_err().exit_code(), 1);
}

#[test]
fn commands_go_to_the_body() {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = server.local_addr().unwrap().to_string();
    let body = std::thread::spawn(move || {
        let (mut stream, _) = server.accept().unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream.write_all(&wire()).unwrap();
        let mut lines = BufReader::new(stream.try_clone().unwrap()).lines();
        // Each is acknowledged, or it comes again. What is asked for the clock's sake has no part in this.
        let mut commands = Vec::new();
        while commands.len() < 2 {
            let line = lines.next().unwrap().unwrap();
            let (number, command) = line[1..].split_once(' ').unwrap();
            stream.write_all(&text_frame(&acknowledgement(number.parse().unwrap()))).unwrap();
            let command = command.split_once('*').unwrap().0;
            if !command.starts_with("time ") {
                commands.push(command.to_string());
            }
        }
        // Silent for longer than one look takes, then an answer in pieces.
        std::thread::sleep(Duration::from_millis(500));
        for byte in text_frame("settings: intact") {
            stream.write_all(&[byte]).unwrap();
        }
        // The end, but for what is still asked.
        stream.shutdown(Shutdown::Write).unwrap();
        lines.for_each(drop);
        commands
    });
    let options = ListenOptions { port, baud: Some(CABLE_BAUD), record: None, csv: None };
    let mut shown = Vec::new();
    let commands = BufReader::new(&b"status\nget lambda2\n"[..]);
    let heard = listen(&options, commands, &mut Screen::new(&mut shown, false)).unwrap();
    assert_eq!(body.join().unwrap(), ["status", "get lambda2"]);
    assert_eq!((heard.messages, heard.lines), (29, 2));
    assert!(String::from_utf8(shown).unwrap().contains("\nsettings: intact\n"));
}

/// A pseudo terminal stands in for a serial port.
#[test]
#[cfg(target_os = "linux")]
fn a_serial_port() {
    use serialport::{SerialPort, TTYPort};
    let (mut body, ship) = TTYPort::pair().unwrap();
    let name = ship.name().unwrap();
    let options = ListenOptions { port: name, baud: Some(CABLE_BAUD), record: None, csv: None };
    drop(ship);
    let listening = std::thread::spawn(move || {
        let mut shown = Vec::new();
        let result = listen(&options, BufReader::new(&b"status\n"[..]), &mut Screen::new(&mut shown, false));
        (result, String::from_utf8(shown).unwrap())
    });
    body.set_timeout(Duration::from_secs(20)).unwrap();
    let (mut command, mut asked) = (Vec::new(), false);
    // Until the other end is open, reading fails.
    for _ in 0..2000 {
        let mut byte = [0];
        match body.read(&mut byte) {
            Ok(count) => command.extend_from_slice(&byte[..count]),
            Err(_) => std::thread::sleep(Duration::from_millis(10)),
        }
        if command.ends_with(b"\n") {
            let line = String::from_utf8(std::mem::take(&mut command)).unwrap();
            let number = line[1..].split_once(' ').unwrap().0.parse().unwrap();
            body.write_all(&text_frame(&acknowledgement(number))).unwrap();
            asked = line.contains(" status*");
        }
        if asked {
            break;
        }
    }
    assert!(asked);
    body.write_all(&wire()).unwrap();
    std::thread::sleep(Duration::from_millis(500));
    drop(body);
    let (result, shown) = listening.join().unwrap();
    // The cable was pulled: the work failed, but all that came was shown.
    assert!(result.is_err_and(|error| error.exit_code() == 1), "{shown}");
    assert!(shown.contains("tick 30 "), "{shown}");
}
