//! What is not there, or goes while the body runs.

use crate::Scenario;
use crate::bench::{Body, SMALL_FILES, epochs, fault, prepared, sensors, sensors_and};
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag_virtual_chip::board::Board;

pub(crate) static NO_CARD: Scenario = Scenario::new(no_card);
pub(crate) static NO_CONVERTER: Scenario = Scenario::new(no_converter);
pub(crate) static NOTHING: Scenario = Scenario::new(nothing);
pub(crate) static CARD_LATER: Scenario = Scenario::new(card_later);
pub(crate) static BAD_WIRES: Scenario = Scenario::new(bad_wires);

/// Longer than the watchdog ever waits.
const LONG_S: f64 = 20.0;

#[test]
fn without_a_card_the_field_goes_up_the_cable() {
    Scenario::force(&NO_CARD);
}

#[test]
fn without_a_converter_the_scalar_goes_on() {
    Scenario::force(&NO_CONVERTER);
}

#[test]
fn with_nothing_at_all_the_body_says_so() {
    Scenario::force(&NOTHING);
}

#[test]
fn a_card_that_comes_later_or_is_changed_is_logged_on() {
    Scenario::force(&CARD_LATER);
}

#[test]
fn a_damaged_frame_and_a_lost_set_up_of_the_converter_are_counted_and_mended() {
    Scenario::force(&BAD_WIRES);
}

fn no_card() {
    let mut body = Body::start(sensors(), SMALL_FILES.clone());
    body.live(LONG_S);
    let telemetry = body.received().telemetry;
    assert!(telemetry.len() > 190, "{}", telemetry.len());
    assert!(telemetry.iter().skip(1).all(|seen| seen.quality.flux == FluxMark::Present && !seen.activity.logging));
    let status = body.answer("status");
    assert_eq!(status[2], "log: no card");
    assert!(fault(&status, "card errors") > 0);
    assert!(body.chip.resets.is_empty());
}

fn no_converter() {
    let mut body = Body::start(Board { converter: None, ..sensors_and(prepared()) }, SMALL_FILES.clone());
    body.live(LONG_S);
    let telemetry = body.received().telemetry;
    assert!(telemetry.len() > 190, "{}", telemetry.len());
    let is_right = |seen: &towmag::link::Telemetry| {
        seen.quality.flux == FluxMark::Missing && seen.quality.scalar == ScalarMark::Present
    };
    assert!(telemetry.iter().all(is_right));
    let status = body.answer("status");
    assert!(fault(&status, "converter set-up") > 0 || fault(&status, "converter crc") > 0, "{status:?}");
    assert!(body.chip.resets.is_empty());
    assert!(epochs(body.disk()).len() > 150);
}

fn nothing() {
    let mut body = Body::start(Board::default(), SMALL_FILES.clone());
    body.live(LONG_S);
    let telemetry = body.received().telemetry;
    assert!(telemetry.len() > 190, "{}", telemetry.len());
    assert!(telemetry.iter().all(|seen| seen.raw_scalar_pt.is_none()));
    assert_eq!(body.answer("get lambda1"), ["lambda1 = 0.001"]);
    assert!(body.chip.resets.is_empty());
}

fn card_later() {
    let (Board { card, .. }, mut body) = (sensors_and(prepared()), Body::start(sensors(), SMALL_FILES.clone()));
    body.live(10.0);
    body.chip.bus_mut().card = card;
    body.live(12.0);
    assert!(body.received().telemetry.last().unwrap().activity.logging);
    let taken = body.chip.bus_mut().card.take();
    body.live(5.0);
    assert!(body.received().telemetry.last().unwrap().activity.log_failing);
    body.chip.bus_mut().card = taken.map(|mut card| {
        card.lose_power(0);
        card
    });
    body.live(12.0);
    assert!(body.received().telemetry.last().unwrap().activity.logging);
    assert!(body.chip.resets.is_empty());
}

fn bad_wires() {
    let mut body = Body::start(sensors(), SMALL_FILES.clone());
    body.live(5.0);
    body.converter().damaged_frame = Some(0);
    body.live(2.0);
    body.converter().lose_power();
    body.live(3.0);
    assert!(body.received().telemetry.last().unwrap().quality.flux == FluxMark::Present);
    let status = body.answer("status");
    assert_eq!((fault(&status, "converter crc"), fault(&status, "converter resets")), (1, 1), "{status:?}");
}
