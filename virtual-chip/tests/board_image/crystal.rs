//! Crystals that are dead, wrong, or die.

use crate::Scenario;
use crate::bench::{Body, SMALL_FILES, events, fault, prepared, sensors_and};
use towmag::log::{EventKind, ResetCause};
use towmag_virtual_chip::board::{Board, Oscillators};

pub(crate) static GOOD: Scenario = Scenario::new(good);
pub(crate) static DEAD: Scenario = Scenario::new(dead);
pub(crate) static WRONG: Scenario = Scenario::new(wrong);
pub(crate) static DIES: Scenario = Scenario::new(dies);
pub(crate) static NO_LOW_SPEED: Scenario = Scenario::new(no_low_speed);

#[test]
fn a_crystal_of_8_mhz_runs_the_body_at_168() {
    Scenario::force(&GOOD);
}

#[test]
fn without_a_crystal_the_body_runs_at_160_mhz_and_says_so() {
    Scenario::force(&DEAD);
}

#[test]
fn a_crystal_of_another_frequency_is_not_used() {
    Scenario::force(&WRONG);
}

#[test]
fn a_crystal_that_dies_restarts_the_body_on_the_internal_oscillator_until_power_goes() {
    Scenario::force(&DIES);
}

#[test]
fn without_the_oscillator_that_both_are_timed_with_the_crystal_is_not_used() {
    Scenario::force(&NO_LOW_SPEED);
}

fn with(oscillators: Oscillators) -> Body {
    Body::start(Board { oscillators, ..sensors_and(prepared()) }, SMALL_FILES.clone())
}

fn core_mhz(body: &Body) -> f64 {
    body.chip.bus().clocks.unwrap().core_hz / 1e6
}

/// What the log tells as a notice.
fn notices(body: &Body) -> Vec<String> {
    let text = |kind| match kind {
        EventKind::Notice(text) => Some(text.to_string()),
        _ => None,
    };
    events(body.disk()).into_iter().filter_map(text).collect()
}

/// Ten epochs a second and a rate that the ship understands, from whatever oscillator.
fn assert_talks(body: &mut Body, most_baud_error: f64) {
    let error = body.baud_error();
    assert!(error.abs() < most_baud_error, "the rate is off by {error}");
    body.received();
    body.live(2.0);
    assert!((19..=21).contains(&body.received().telemetry.len()));
}

fn good() {
    // The internal oscillator at its limits, and the slow one: they do not matter.
    for (off, low_speed_hz) in [(0.92, 17e3), (1.045, 47e3)] {
        let mut body = with(Oscillators { internal_hz: 16e6 * off, low_speed_hz, ..Oscillators::default() });
        body.live(3.0);
        assert_eq!(core_mhz(&body), 168.0);
        assert_talks(&mut body, 0.002);
        assert_eq!(fault(&body.answer("status"), "crystal failed"), 0);
    }
}

fn dead() {
    let mut body = with(Oscillators { crystal_hz: None, internal_hz: 16.16e6, ..Oscillators::default() });
    body.live(12.0);
    assert_eq!(core_mhz(&body), 161.6);
    assert_talks(&mut body, 0.02);
    assert_eq!(fault(&body.answer("status"), "crystal failed"), 1);
    let notices = notices(&body);
    assert!(notices.iter().any(|text| text.starts_with("the crystal does not start")), "{notices:?}");
}

fn wrong() {
    for crystal_hz in [25e6, 4e6] {
        let mut body = with(Oscillators { crystal_hz: Some(crystal_hz), ..Oscillators::default() });
        body.live(12.0);
        assert_eq!(core_mhz(&body), 160.0);
        assert_talks(&mut body, 0.002);
        assert_eq!(fault(&body.answer("status"), "crystal failed"), 1);
        let notices = notices(&body);
        let khz = |text: &String| text.strip_prefix("the crystal has ")?.split(' ').next()?.parse::<f64>().ok();
        let told_khz = notices.iter().find_map(khz).expect("a notice");
        assert!((told_khz * 1e3 / crystal_hz - 1.0).abs() < 0.002, "{told_khz} kHz");
    }
}

fn dies() {
    let mut body = with(Oscillators::default());
    body.live(10.0);
    body.stop_crystal();
    body.live(10.0);
    assert_eq!((core_mhz(&body), body.chip.resets.len()), (160.0, 1));
    assert_talks(&mut body, 0.002);
    let status = body.answer("status");
    assert_eq!((fault(&status, "crystal failed"), fault(&status, "restarts by fault")), (1, 1), "{status:?}");
    let told = events(body.disk());
    let is_told = |kind: &EventKind| matches!(kind, EventKind::Panic(text) if text.starts_with("the crystal stopped"));
    assert!(told.iter().any(is_told) && told.contains(&EventKind::Reset(ResetCause::Software)), "{told:?}");
    // It comes back, and is trusted again only by a body that had no power.
    body.chip.bus_mut().set_oscillators(Oscillators::default());
    body.answer("reset yes");
    body.live(3.0);
    assert_eq!(core_mhz(&body), 160.0);
    let (board, cells) = body.off();
    let mut body = Body::start(board, cells);
    body.live(3.0);
    assert_eq!(core_mhz(&body), 168.0);
}

fn no_low_speed() {
    let mut body = with(Oscillators { low_speed_hz: 0.0, ..Oscillators::default() });
    body.live(3.0);
    assert_eq!(core_mhz(&body), 160.0);
    assert_eq!(fault(&body.answer("status"), "crystal failed"), 1);
}
