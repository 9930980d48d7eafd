//! The task of the console: from the bytes of the ship to answers, settings and notices in the log.

use std::rc::Rc;
use towmag::health::Count;
use towmag::log::{Event, EventKind, Record, Recovered};
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::log::recover_file;

fn bench() -> Rc<Bench> {
    let bench = Bench::new();
    store(&bench, |_| ());
    bench
}

/// The events of the log, after its last sector has been written.
fn logged(body: &mut Body) -> Vec<EventKind> {
    body.health.ask_for_restart();
    body.live(1);
    let log = recover_file(body.bench.card.borrow().as_ref().unwrap(), "TOWMAG01.BIN").unwrap();
    let kind = |item: &Recovered| match item {
        Recovered::Record(Record::Event(Event { kind, .. })) => Some(kind.clone()),
        _ => None,
    };
    log.items.iter().filter_map(kind).collect()
}

#[test]
fn a_line_is_answered() {
    let mut body = Body::start(&bench());
    body.live(1);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.001"]);
    assert_eq!(body.answer("frobnicate"), ["error: no command \"frobnicate\": type help"]);
    let status = body.answer("status");
    assert!(status[0].starts_with("towmag 0.1.0-test, tick "), "{status:?}");
    assert_eq!(
        status[1..5],
        ["time: not set, type time set seconds", "log: no card", "settings: intact", "calibration: none",]
    );
    assert!(status[5..].iter().any(|line| line.starts_with("fault: card errors ")), "{status:?}");
}

#[test]
fn what_is_set_outlives_a_restart() {
    let bench = bench();
    let mut body = Body::start(&bench);
    assert_eq!(body.answer("set lambda1 0.002"), ["lambda1 = 0.002"]);
    assert_eq!(body.answer("time set 1790000000"), ["time set"]);
    assert_eq!(body.answer("reset"), ["starting anew"]);
    assert!(bench.restarts.get() > 0 && bench.time_left.get().is_some_and(|ms| ms / 1_000 - 1_790_000_000 < 5));
    let mut body = Body::start(&bench);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.002"]);
    assert!(body.answer("status")[1].starts_with("time: 17900000"));
}

#[test]
fn a_restart_waits_until_the_ship_has_the_answer() {
    let bench = bench();
    let mut body = Body::start(&bench);
    body.send("reset\r");
    bench.room.set(0);
    body.live(2);
    assert_eq!(bench.restarts.get(), 0, "the answer is still on its way");
    bench.room.set(usize::MAX);
    body.live(1);
    assert!(bench.restarts.get() > 0 && body.received().texts == ["starting anew"]);
}

#[test]
fn what_the_operator_does_is_in_the_log() {
    let bench = bench();
    bench.card.replace(Some(fat16(8000)));
    let mut body = Body::start(&bench);
    body.live(1);
    for line in ["time set 1790000000", "calibrate start", "calibrate stop", "log stop", "log start"] {
        body.answer(line);
    }
    let events = logged(&mut body);
    let has = |wanted: fn(&EventKind) -> bool| events.iter().filter(|kind| wanted(kind)).count();
    // At once by the console, and again with the next epoch.
    assert_eq!(has(|kind| matches!(kind, EventKind::TimeSet { .. })), 2, "{events:?}");
    assert_eq!(has(|kind| matches!(kind, EventKind::CalibrationFailed { .. })), 1, "{events:?}");
    assert_eq!(has(|kind| matches!(kind, EventKind::LogStop)), 1, "{events:?}");
    assert_eq!(has(|kind| matches!(kind, EventKind::LogStart)), 1, "{events:?}");
    assert_eq!(body.health.counts.get(Count::RecordsLost), 0);
}

#[test]
fn settings_that_are_lost_are_told_on_the_cable_and_in_the_log() {
    let bench = bench();
    bench.card.replace(Some(fat16(8000)));
    bench.flash.borrow_mut()[100] ^= 1;
    let mut body = Body::start(&bench);
    body.live(1);
    let lost = "settings: no intact copy in the flash, defaults hold and the calibration is gone";
    assert_eq!(body.received().texts, [lost]);
    assert!(logged(&mut body).contains(&EventKind::Notice(lost.try_into().unwrap())));
}

#[test]
fn a_flash_that_refuses_is_told() {
    let bench = bench();
    let mut body = Body::start(&bench);
    bench.flash_refuses.set(true);
    let answer = body.answer("set lambda1 0.002");
    assert!(answer[0].starts_with("error: not stored, gone with the next start: the flash refuses"), "{answer:?}");
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.002"], "it holds until then");
}

#[test]
fn bytes_that_find_the_inbox_full_are_counted() {
    let mut body = Body::start(&bench());
    body.console_waits = true;
    body.send(&"x".repeat(400));
    body.live(1);
    assert_eq!(body.health.counts.get(Count::CableOverruns), 400 - 255);
}

#[test]
fn a_receive_error_costs_the_line_that_it_falls_into_alone() {
    let bench = bench();
    let mut body = Body::start(&bench);
    body.send("get lam");
    bench.from_ship.borrow_mut().push_back(None);
    body.send("bda1\r");
    body.live(1);
    assert_eq!(body.received().texts, ["error: damaged line dropped: type it again"]);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.001"]);
    assert_eq!(
        (body.health.counts.get(Count::CableOverruns), body.health.counts.get(Count::ConsoleLinesDropped)),
        (1, 1)
    );
}

#[test]
fn a_long_answer_waits_for_room_and_nothing_is_dropped() {
    let bench = bench();
    let mut body = Body::start(&bench);
    body.send("get\rget lambda1\r");
    bench.room.set(0);
    let mut texts = Vec::new();
    for _ in 0..20 {
        bench.room.set(800);
        body.live(1);
        texts.extend(body.received().texts);
    }
    assert!(texts.len() > 30 && texts.last().unwrap() == "lambda1 = 0.001", "{texts:?}");
    assert_eq!(body.health.counts.get(Count::FramesDropped), 0);
}
