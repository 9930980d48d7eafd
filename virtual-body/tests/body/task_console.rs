//! The task of the console: from the bytes of the ship to answers, settings and notices in the log.

use std::rc::Rc;
use towmag::health::Count;
use towmag::link::numbered;
use towmag::log::{EventKind, ResetCause};
use towmag::microcontroller::WATCHDOG;
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::rng::Rng;

fn bench() -> Rc<Bench> {
    let bench = Bench::new();
    store(&bench, |_| ());
    bench
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
    assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
    assert_eq!(body.answer("time set 1790000000"), ["time set"]);
    assert_eq!(body.answer("reset yes"), ["starting anew"]);
    assert!(
        bench.restarts.get() > 0
            && bench.kept_time.get().is_some_and(|time| time.unix_us / 1_000_000 - 1_790_000_000 < 5)
    );
    bench.reset_cause.set(ResetCause::Software);
    let mut body = Body::start(&bench);
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.002"]);
    assert!(body.answer("status")[1].starts_with("time: 17900000"));
}

#[test]
fn a_restart_waits_until_the_ship_has_the_answer() {
    let bench = bench();
    let mut body = Body::start(&bench);
    body.send("reset yes\r");
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
    for line in ["time set 1790000000", "calibrate start", "calibrate stop", "log stop yes", "log start"] {
        body.answer(line);
    }
    let events: Vec<EventKind> = body.events().into_iter().map(|event| event.kind).collect();
    let has = |wanted: fn(&EventKind) -> bool| events.iter().filter(|kind| wanted(kind)).count();
    // At once by the console, and again with the next epoch.
    assert_eq!(has(|kind| matches!(kind, EventKind::Time(_))), 2, "{events:?}");
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
    let notice = EventKind::Notice(lost.try_into().unwrap());
    assert!(body.events().iter().any(|event| event.kind == notice));
}

#[test]
fn a_flash_that_refuses_is_told() {
    let bench = bench();
    let mut body = Body::start(&bench);
    bench.flash_refuses.set(true);
    body.answer("set lambda1 0.002");
    let answer = body.answer("save");
    assert!(answer[0].starts_with("error: not stored, gone with the next start: the flash refuses"), "{answer:?}");
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.002"], "it holds until then");
}

#[test]
fn bytes_that_find_the_inbox_full_are_counted() {
    let mut body = Body::start(&bench());
    body.console_waits = true;
    body.send(&"x".repeat(1200));
    body.live(1);
    assert_eq!(body.health.counts.get(Count::CableOverruns), 1200 - 1023);
}

#[test]
fn what_stands_before_and_after_lost_bytes_is_never_one_line() {
    let mut body = Body::start(&bench());
    body.console_waits = true;
    // The inbox ends within the first command; what is lost ends within the second.
    body.send(&format!("{}\rset lambda1 0.{}\rset lambda2 0.1", "\r".repeat(1010), "0".repeat(200)));
    body.live(1);
    body.console_waits = false;
    body.live(2);
    body.send("23\r");
    body.live(3);
    assert_eq!(body.received().texts, ["error: damaged line dropped: type it again"]);
    assert_eq!(body.answer("get lambda2"), ["lambda2 = 0.025"]);
}

#[test]
fn a_numbered_command_is_acknowledged_and_done_once() {
    let bench = bench();
    let mut body = Body::start(&bench);
    let line = numbered(7, "set lambda1 0.002").unwrap();
    assert_eq!(body.answer(&line), ["#7 ok", "lambda1 = 0.002"]);
    body.answer("set lambda1 0.003");
    assert_eq!(body.answer(&line), ["#7 ok"], "sent again, for the acknowledgement was lost");
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.003"]);
    assert_eq!(body.answer(&numbered(8, "reset").unwrap()), ["#8 ok", "not done: to confirm it, type reset yes"]);
    assert_eq!(bench.restarts.get(), 0);
}

/// Screenfuls of settings pasted while the console is busy, with bytes lost on the way and flipped bits, which the plain
/// form cannot all tell: but no line is ever made of two, and with a CRC nothing is done that nobody sent.
#[test]
fn ten_thousand_pastes() {
    let mut rng = Rng(17);
    let bench = bench();
    let mut body = Body::start(&bench);
    let (mut done, mut spliced, mut unsent) = (0, 0, 0);
    for paste in 0..10_000_u32 {
        let has_crc = paste % 2 == 0;
        // Each value stands for its line, so that a setting tells which line it is from.
        let line = |parameter: &str, value: u64| format!("set {parameter} 0.{value:06}1");
        let sent: Vec<(usize, u64)> = (0..100).map(|k| (k % 2, 100_000 + rng.below(900_000))).collect();
        let names = ["lambda1", "lambda2"];
        let mut bytes = Vec::new();
        for (k, &(which, value)) in sent.iter().enumerate() {
            let text = line(names[which], value);
            let number = (paste.wrapping_mul(100) as u16).wrapping_add(k as u16);
            let text = if has_crc { numbered(number, &text).unwrap().to_string() } else { text };
            bytes.extend(text.bytes().chain([b'\r']).map(Some));
        }
        for _ in 0..rng.below(4) {
            let (from, len) = (rng.below(bytes.len() as u64) as usize, rng.below(60) as usize);
            // What a receiver overruns it tells.
            bytes.splice(from..(from + len).min(bytes.len()), [None]);
        }
        for _ in 0..if has_crc { rng.below(6) } else { 0 } {
            let place = rng.below(bytes.len() as u64) as usize;
            bytes[place] = bytes[place].map(|byte| byte ^ 1 << rng.below(8));
        }
        bytes.extend([Some(b'\r')]);
        // As they come at 115,200 baud, while something holds the console up.
        for burst in bytes.chunks(460) {
            bench.from_ship.borrow_mut().extend(burst);
            body.console_waits = rng.below(3) > 0;
            body.tick();
        }
        body.console_waits = false;
        body.live(3);
        for text in body.received().texts {
            let Some((name, value)) = text.split_once(" = ") else { continue };
            done += 1;
            let was_sent = sent
                .iter()
                .any(|&(which, sent)| names[which] == name && line(name, sent).ends_with(&format!(" {value}")));
            spliced += u32::from(!was_sent && !has_crc);
            unsent += u32::from(!was_sent && has_crc);
        }
    }
    println!("10,000 pastes of 100 lines: {done} settings done, {spliced} spliced (plain), {unsent} nobody sent (CRC)");
    assert!(done > 100_000 && spliced == 0 && unsent == 0, "{done} {spliced} {unsent}");
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
        bench.room.set(1_200);
        body.live(1);
        texts.extend(body.received().texts);
    }
    // Then the body tells of its self-test.
    let self_test = texts.iter().position(|text| text.starts_with("self-test")).unwrap();
    assert!(self_test > 30 && texts[self_test - 1] == "lambda1 = 0.001", "{texts:?}");
    assert_eq!(body.health.counts.get(Count::FramesDropped), 0);
}

#[test]
fn the_time_is_known_after_every_kind_of_reset() {
    let at_s = |body: &mut Body| {
        let status = body.answer("status");
        let (_, time) = status[1].split_once("time: ")?;
        let (unix_s, error_ms) = time.split_once(" s since 1970-01-01 UTC, +- ")?;
        Some((unix_s.parse::<u64>().unwrap(), error_ms.strip_suffix(" ms").unwrap().parse::<u64>().unwrap()))
    };
    for (cause, most_error_ms) in [
        (ResetCause::Software, Some(200)),
        (ResetCause::Watchdog, Some(u64::from(WATCHDOG.longest_ms) / 2 + 200)),
        (ResetCause::Pin, Some(60_200)),
        (ResetCause::PowerOn, None),
        (ResetCause::BrownOut, None),
    ] {
        let bench = bench();
        let mut body = Body::start(&bench);
        body.answer(&format!("time set 1790000000.000000@{}+-5000", bench.now_us.get()));
        body.live(10);
        let (before_s, _) = at_s(&mut body).unwrap();
        drop(body);
        // No farewell: what was kept at the latest epoch is what there is.
        bench.reset_cause.set(cause);
        bench.now_us.set(0);
        let mut body = Body::start(&bench);
        let after = at_s(&mut body);
        assert_eq!(after.is_some(), most_error_ms.is_some(), "{cause:?}: {after:?}");
        if let (Some((after_s, error_ms)), Some(most_ms)) = (after, most_error_ms) {
            assert!(error_ms <= most_ms, "{cause:?}: {error_ms} ms");
            assert!(after_s.abs_diff(before_s + 2) * 1_000 <= error_ms + 1_000, "{cause:?}: {before_s} {after_s}");
        }
    }
}

#[test]
fn pulses_correct_the_time_and_the_telemetry_tells_how_good_it_is() {
    let bench = bench();
    let mut body = Body::start(&bench);
    let zero_us = bench.now_us.get();
    body.answer(&format!("time set 1790000000.030000@{zero_us}+-40000"));
    body.live(2);
    assert!(
        body.received().telemetry.last().unwrap().time_error_ms.is_some_and(|error_ms| (40..50).contains(&error_ms))
    );
    for second in 5..8 {
        bench.second_pulse.set(Some(zero_us + second * 1_000_000));
        body.live(1);
    }
    let last = *body.received().telemetry.last().unwrap();
    assert_eq!(last.time_error_ms, Some(1));
    assert_eq!(body.tasks.context.time_of_day.unwrap().at(zero_us + 8_000_000).unix_us, 1_790_000_008_000_000);
}
