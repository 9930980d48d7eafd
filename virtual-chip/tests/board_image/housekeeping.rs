//! Leak contact, battery, and the self-test.

use crate::Scenario;
use crate::bench::{Body, SMALL_FILES, prepared, sensors, sensors_and};

pub(crate) static LEAK_AND_BATTERY: Scenario = Scenario::new(leak_and_battery);
pub(crate) static SELF_TEST: Scenario = Scenario::new(self_test);

/// Port C, and the leak contact's pin on it.
const PORT_C: usize = 2;
const LEAK_PIN: u16 = 1 << 3;

/// The divider's channel of the chip's own converter.
const BATTERY_CHANNEL: usize = 14;

#[test]
fn a_leak_and_the_battery_are_told() {
    Scenario::force(&LEAK_AND_BATTERY);
}

#[test]
fn a_body_with_everything_passes_its_self_test() {
    Scenario::force(&SELF_TEST);
}

fn leak_and_battery() {
    let mut body = Body::start(sensors(), SMALL_FILES.clone());
    body.live(1.0);
    for setting in ["battery_v_per_count 0.01", "leak_fitted on"] {
        assert!(!body.answer(&format!("set {setting}"))[0].starts_with("error"), "{setting}");
    }
    body.answer("save");
    let (board, cells) = body.off();
    let mut body = Body::start(board, cells);
    body.chip.bus_mut().adc.counts[BATTERY_CHANNEL] = 1_234;
    body.live(5.0);
    let told = |body: &mut Body| body.answer("status").into_iter().find(|line| line.starts_with("battery")).unwrap();
    assert_eq!(told(&mut body), "battery: 12.34 V, leak contact: dry");
    body.chip.bus_mut().ports[PORT_C].input &= !LEAK_PIN;
    body.live(5.0);
    assert!(told(&mut body).contains("WET"));
}

fn self_test() {
    let mut body = Body::start(sensors_and(prepared()), SMALL_FILES.clone());
    body.live(15.0);
    assert_eq!(body.received().texts, ["self-test: passed"]);
    let mut told = body.answer("selftest");
    body.live(3.0);
    told.extend(body.received().texts);
    assert_eq!(told[..2], ["self-test: 3 s", "self-test: passed"]);
    assert_eq!(told[2], "ok   crystal: 8000 kHz by the internal oscillator (+-8 %); slow oscillator 32000 Hz");
    assert!(told[3].starts_with("ok   converter: answers with a right CRC, identity 24"), "{}", told[3]);
    // Eight bytes to each sensor's UART, for a wire that is not there.
    let sent = [0, 2].map(|uart| body.chip.bus().usarts[uart].sent.iter().map(|sent| sent.byte).collect::<Vec<_>>());
    assert_eq!(sent, [b"UUUUUUUU", b"UUUUUUUU"]);
}
