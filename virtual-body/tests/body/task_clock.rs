//! A body whose crystal has failed says so.

use towmag::microcontroller::{ClockCheck, ClockFault};
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};

fn body(fault: Option<ClockFault>) -> Body {
    let bench = Bench::new();
    store(&bench, |_| ());
    bench.clock.set(ClockCheck { fault, ..ClockCheck::default() });
    Body::start(&bench)
}

#[test]
fn status_tells_a_failed_crystal() {
    let mut body = body(Some(ClockFault::WrongFrequency { khz: 12_000 }));
    let status = body.answer("status").join("\n");
    assert!(status.contains("crystal failed 1"), "{status}");
}

#[test]
fn a_good_crystal_is_not_mentioned() {
    let mut body = body(None);
    let status = body.answer("status").join("\n");
    assert!(!status.contains("crystal"), "{status}");
}
