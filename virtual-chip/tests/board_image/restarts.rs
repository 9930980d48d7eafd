//! Sessions that end as they should not.

use crate::Scenario;
use crate::bench::{Body, IMAGE, SMALL_FILES, events, fault, prepared, sensors_and};
use towmag::log::{EventKind, ResetCause};
use towmag_virtual_chip::board::{Board, Oscillators};
use towmag_virtual_chip::peripherals::rcc::{SOFTWARE, WATCHDOG};
use towmag_virtual_chip::time::seconds;

pub(crate) static HANGS: Scenario = Scenario::new(hangs);
pub(crate) static FAULTS: Scenario = Scenario::new(faults);
pub(crate) static PANICS: Scenario = Scenario::new(panics);
pub(crate) static NO_HANDLER: Scenario = Scenario::new(no_handler);

#[test]
fn a_program_that_hangs_is_reset_by_the_watchdog_within_6_to_17_s() {
    Scenario::force(&HANGS);
}

#[test]
fn a_hard_fault_leaves_its_place_and_starts_anew() {
    Scenario::force(&FAULTS);
}

#[test]
fn a_panic_leaves_its_message_and_starts_anew() {
    Scenario::force(&PANICS);
}

#[test]
fn an_interrupt_that_nobody_handles_is_told() {
    Scenario::force(&NO_HANDLER);
}

/// Index, length, and the place of the call.
const PANIC: &str = "panicking18panic_bounds_check";

fn body(low_speed_hz: f64) -> Body {
    let oscillators = Oscillators { low_speed_hz, ..Oscillators::default() };
    let mut body = Body::start(Board { oscillators, ..sensors_and(prepared()) }, SMALL_FILES.clone());
    body.live(9.0);
    body
}

/// Live until the chip is reset; how long that took, seconds.
fn until_reset(body: &mut Body, most_s: f64) -> f64 {
    let (begin_fs, before) = (body.chip.machine().now_fs, body.chip.resets.len());
    while body.chip.resets.len() == before {
        body.live(0.01);
        assert!(seconds(body.chip.machine().now_fs - begin_fs) < most_s, "no reset within {most_s} s");
    }
    seconds(body.chip.machine().now_fs - begin_fs)
}

/// The message that the log has of the end of the session before.
fn last_words(body: &Body) -> Option<String> {
    events(body.disk()).into_iter().find_map(|kind| match kind {
        EventKind::Panic(text) => Some(text.to_string()),
        _ => None,
    })
}

/// It lives on, and has counted what has happened.
fn assert_told(body: &mut Body, flags: u32, cause: ResetCause) {
    assert_eq!(body.chip.resets, [flags]);
    body.live(10.0);
    assert!(body.received().telemetry.last().unwrap().activity.logging);
    assert_eq!(fault(&body.answer("status"), "restarts by fault"), 1);
    assert!(body.chip.bus().lights()[2], "the red light");
    let told = events(body.disk());
    assert!(told.contains(&EventKind::Reset(cause)), "{told:?}");
}

fn hangs() {
    for low_speed_hz in [17e3, 47e3] {
        let mut body = body(low_speed_hz);
        body.chip.hang();
        let took_s = until_reset(&mut body, 17.0);
        assert!((5.9..16.7).contains(&took_s), "{took_s} s with {low_speed_hz} Hz");
        assert_told(&mut body, WATCHDOG, ResetCause::Watchdog);
    }
}

fn faults() {
    let mut body = body(32e3);
    // Nothing is there.
    body.chip.stray_to(0x3000_0000, [0; 3]);
    until_reset(&mut body, 1.0);
    assert_told(&mut body, SOFTWARE, ResetCause::Software);
    assert!(last_words(&body).unwrap().starts_with("hard fault at 30000000, called from "));
    // A pointer to nothing is told with the place of the code that followed it.
    let mut body = self::body(32e3);
    let panic = IMAGE.symbol_like(PANIC);
    body.chip.stray_to(panic, [7, 3, 0x3000_0000]);
    until_reset(&mut body, 1.0);
    assert_told(&mut body, SOFTWARE, ResetCause::Software);
    assert!(last_words(&body).unwrap().starts_with("hard fault at 080"));
}

/// `panic_bounds_check` of the core library, with the place of its call in memory that nothing uses.
fn panics() {
    const UNUSED: u32 = 0x1000_0000;
    let mut body = body(32e3);
    let file = b"somewhere.rs";
    body.chip.set_memory(UNUSED + 16, file);
    let location = [UNUSED + 16, file.len() as u32, 17, 5];
    body.chip.set_memory(UNUSED, &location.map(u32::to_le_bytes).concat());
    let panic = IMAGE.symbol_like(PANIC);
    body.chip.stray_to(panic, [7, 3, UNUSED]);
    until_reset(&mut body, 1.0);
    assert_told(&mut body, SOFTWARE, ResetCause::Software);
    let words = last_words(&body).unwrap();
    assert_eq!(words, "somewhere.rs:17: index out of bounds: the len is 3 but the index is 7");
}

/// The window watchdog's, which the body does not use.
fn no_handler() {
    let mut body = body(32e3);
    body.chip.bus_mut().core.nvic.pend_enabled(0);
    until_reset(&mut body, 1.0);
    assert_told(&mut body, SOFTWARE, ResetCause::Software);
    assert_eq!(last_words(&body).unwrap(), "interrupt 0 has no handler");
}
