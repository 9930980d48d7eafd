//! Leak and battery: from contact and divider to lights, log and cable.

use towmag::housekeeping::{Housekeeping, HousekeepingSample};
use towmag::lights::Lights;
use towmag::log::{Event, EventKind};
use towmag::store::Stored;
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;

/// Both fitted, and a battery of 12 V.
fn body(change: impl FnOnce(&mut Stored)) -> Body {
    let bench = Bench::new();
    bench.card.replace(Some(fat16(8000)));
    store(&bench, |stored| {
        stored.settings.housekeeping.battery_v_per_count = 0.01;
        stored.settings.housekeeping.battery_low_v = 11.0;
        stored.settings.housekeeping.is_leak_fitted = true;
        change(stored);
    });
    let mut body = Body::start(&bench);
    set(&body, false, 1_200);
    // The self-test of the start is over.
    body.live(15);
    body.received();
    body
}

fn set(body: &Body, is_wet: bool, counts: u16) {
    body.bench.housekeeping.set(HousekeepingSample { is_wet, battery_counts: Some(counts) });
}

/// How often the red light comes on in so many calls of `assemble`, 25 a second, without a reading of the scalar sensor.
fn flashes(body: &mut Body, calls: u32) -> u32 {
    let (mut flashes, mut was_on) = (0, true);
    for _ in 0..calls {
        body.bench.now_us.set(body.bench.now_us.get().wrapping_add(40_000));
        body.tick();
        let Lights { red, .. } = body.bench.lights.get();
        flashes += u32::from(red && !was_on);
        was_on = red;
    }
    flashes
}

/// What the log tells of leak and battery, and the notices.
fn logged(body: &mut Body) -> (Vec<(u32, Housekeeping)>, Vec<String>) {
    let (mut told, mut notices) = (Vec::new(), Vec::new());
    for Event { tick, kind } in body.events() {
        match kind {
            EventKind::Housekeeping(housekeeping) => told.push((tick, housekeeping)),
            EventKind::Notice(text) if !text.starts_with("self-test") => notices.push(text.to_string()),
            _ => {}
        }
    }
    (told, notices)
}

#[test]
fn a_leak_is_shown_told_logged_and_cleared() {
    let mut body = body(|_| ());
    // Drops that run over the contact: never wet for a second.
    for _ in 0..10 {
        set(&body, true, 1_200);
        flashes(&mut body, 20);
        set(&body, false, 1_200);
        flashes(&mut body, 5);
    }
    assert!(body.received().texts.is_empty());
    set(&body, true, 1_200);
    body.live(2);
    let received = body.received();
    assert_eq!(received.texts, ["LEAK: water at the contact"], "at once");
    assert!(received.housekeeping.iter().any(|message| message.housekeeping.has_leak == Some(true)));
    assert_eq!(flashes(&mut body, 250), 20, "two a second, though both sensors are missing");
    body.live(180);
    let lasting: Vec<_> = (1..=3).map(|minutes| format!("LEAK: water at the contact for {minutes} min")).collect();
    assert_eq!(body.received().texts, lasting);
    assert!(body.answer("status").contains(&"battery: 12.00 V, leak contact: WET".into()));
    set(&body, false, 1_200);
    body.live(2);
    assert_eq!(body.received().texts, ["leak over: the contact is dry"]);
    let (told, notices) = logged(&mut body);
    assert_eq!(notices, ["LEAK: water at the contact", "leak over: the contact is dry"]);
    let changes: Vec<_> = told.windows(2).filter(|pair| pair[0].1.has_leak != pair[1].1.has_leak).collect();
    assert_eq!(changes.len(), 2);
    assert!(told.windows(2).all(|pair| pair[1].0 - pair[0].0 <= 10), "once a second at least");
    assert!(told.len() < 245, "and hardly more: {}", told.len());
}

#[test]
fn a_low_battery_is_told_once_and_when_it_is_well_again() {
    let mut body = body(|_| ());
    for counts in [1_101, 1_090, 1_099, 1_101, 1_080, 1_154, 1_170, 1_110] {
        set(&body, false, counts);
        body.live(3);
    }
    let received = body.received();
    let [low, well] = &received.texts[..] else { panic!("{:?}", received.texts) };
    // The second in which the voltage changes is of both voltages.
    assert!(low.starts_with("BATTERY LOW: 10.9") && well.starts_with("battery no longer low: 11."), "{low}, {well}");
    assert!((4..=6).contains(&received.housekeeping.len()), "every 5 s: {}", received.housekeeping.len());
    let (told, notices) = logged(&mut body);
    assert_eq!(notices, received.texts);
    assert!(told.iter().any(|(_, told)| *told == Housekeeping { battery_v: Some(11.54), has_leak: Some(false) }));
}

#[test]
fn an_alarm_waits_for_a_cable_that_is_busy() {
    let mut body = body(|_| ());
    body.bench.room.set(0);
    // Until the queue is full.
    body.live(10);
    set(&body, true, 1_200);
    body.live(5);
    set(&body, false, 1_000);
    body.live(5);
    body.bench.room.set(usize::MAX);
    body.live(2);
    let texts = body.received().texts;
    // Of the leak the latest.
    assert_eq!(texts, ["leak over: the contact is dry", "BATTERY LOW: 10.00 V"]);
    let (_, notices) = logged(&mut body);
    assert_eq!(notices.len(), 3, "all of them: {notices:?}");
}

#[test]
fn what_is_not_fitted_costs_nothing_and_is_nowhere() {
    let mut body = body(|stored| stored.settings.housekeeping = Default::default());
    set(&body, true, 0);
    body.live(20);
    let received = body.received();
    assert!(received.housekeeping.is_empty() && received.texts.is_empty());
    assert!(body.answer("status").contains(&"battery: not measured, leak contact: not fitted".into()));
    assert_eq!(logged(&mut body), (Vec::new(), Vec::new()));
}

#[test]
fn the_settings_are_made_by_name_and_hold_from_the_next_start() {
    let mut body = body(|stored| stored.settings.housekeeping = Default::default());
    for (line, answer) in [
        ("set battery_v_per_count 0.00886", "battery_v_per_count = 0.00886"),
        ("set battery_v_per_count 2", "error: battery_v_per_count is 2: choose 0 to 0.1"),
        ("set battery_low_v 10.5", "battery_low_v = 10.5"),
        ("set leak_fitted on", "leak_fitted = on"),
        ("save", "saved: holds from the next start, log at once"),
    ] {
        assert_eq!(body.answer(line), [answer]);
    }
    let mut next = Body::start(&body.bench);
    set(&next, true, 1_000);
    next.live(5);
    let told = next.received().housekeeping.last().unwrap().housekeeping;
    assert_eq!(told, Housekeeping { battery_v: Some(8.86), has_leak: Some(true) });
}
