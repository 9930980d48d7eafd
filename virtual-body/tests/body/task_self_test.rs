//! The self-test, through the console and at the start.

use std::rc::Rc;

use towmag::hardware::SensorPort;
use towmag::log::{Event, EventKind, ResetCause};
use towmag::microcontroller::{ClockCheck, ClockFault};
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;

/// A board with a good crystal and a card.
fn bench() -> Rc<Bench> {
    let bench = Bench::new();
    store(&bench, |_| ());
    bench.card.replace(Some(fat16(8_000)));
    bench.clock.set(ClockCheck { fault: None, crystal_khz: 8_010, low_speed_hz: 31_800 });
    bench
}

/// All texts of so many seconds.
fn texts(body: &mut Body, seconds: u32) -> Vec<String> {
    (0..seconds)
        .flat_map(|_| {
            body.live(1);
            body.received().texts
        })
        .collect()
}

/// What `selftest` answers, after its first line.
fn self_test(body: &mut Body) -> Vec<String> {
    assert_eq!(body.answer("selftest"), ["self-test: 3 s"]);
    texts(body, 3)
}

#[test]
fn the_start_tells_what_failed_and_logs_it() {
    let mut body = Body::start(&bench());
    let told = texts(&mut body, 15);
    // No converter is plugged into this board.
    assert_eq!(told[0], "self-test: failed: converter, fluxgate");
    assert_eq!(
        told[1..],
        ["FAIL converter: the bus failed", "FAIL fluxgate: no conversion: look at DRDY and at its clock"]
    );
    let events = body.events();
    let is_it = |event: &Event| matches!(&event.kind, EventKind::Notice(text) if text.as_str() == told[0]);
    assert!(events.iter().any(is_it), "{events:?}");
}

#[test]
fn on_command_every_part_is_told() {
    let bench = bench();
    bench.reset_cause.set(ResetCause::Watchdog);
    bench.restarts_by_fault.set(2);
    let mut body = Body::start(&bench);
    texts(&mut body, 15);
    let told = self_test(&mut body);
    let starts = [
        "self-test: failed: converter, fluxgate, restarts",
        "ok   crystal: 8010 kHz by the internal oscillator (+-8 %); slow oscillator 31800 Hz",
        "FAIL converter: the bus failed",
        "FAIL fluxgate: no conversion",
        "ok   scalar sensor: reads",
        "ok   card: 4 MB, ",
        "ok   settings: intact",
        "FAIL restarts: 2 by fault or watchdog since power came; last start by the watchdog",
        "wire test: nothing came back",
    ];
    assert_eq!(told.len(), starts.len(), "{told:?}");
    for (line, start) in told.iter().zip(starts) {
        assert!(line.starts_with(start), "{line}");
    }
}

#[test]
fn a_card_that_is_gone_is_missed_unless_the_log_is_off() {
    let bench = bench();
    let mut body = Body::start(&bench);
    texts(&mut body, 15);
    bench.card.take();
    texts(&mut body, 3);
    assert!(self_test(&mut body).contains(&"FAIL card: none, or it does not answer, or has no room for a log".into()));
    body.answer("log stop yes");
    assert!(self_test(&mut body).contains(&"ok   card: the log is off".into()));
}

#[test]
fn a_sensor_that_is_silent_and_settings_that_have_gone_are_told() {
    let bench = bench();
    bench.clock.set(ClockCheck { fault: Some(ClockFault::DoesNotStart), ..ClockCheck::default() });
    let mut body = Body::start(&bench);
    texts(&mut body, 15);
    bench.flash.borrow_mut().iter_mut().for_each(|byte| *byte &= 0xF7);
    body.scalar_sentence = "";
    let told = self_test(&mut body);
    assert_eq!(told[0], "self-test: failed: crystal, converter, fluxgate, scalar sensor, settings");
    assert!(told[4].starts_with("FAIL scalar sensor: silent"), "{told:?}");
    assert!(told[6].starts_with("FAIL settings: the flash reads otherwise"), "{told:?}");
}

#[test]
fn a_wire_in_place_of_a_sensor_brings_the_bytes_back() {
    let bench = bench();
    let mut body = Body::start(&bench);
    texts(&mut body, 15);
    for (wired, told) in [
        (SensorPort::Scalar, "8 of 8 bytes came back on scalar, 0 on nmea"),
        (SensorPort::Nmea, "0 of 8 bytes came back on scalar, 8 on nmea"),
    ] {
        bench.wire.set(Some(wired));
        body.scalar_sentence = "";
        assert_eq!(self_test(&mut body).last().unwrap(), &format!("wire test: {told}"));
        body.live(2);
    }
}
