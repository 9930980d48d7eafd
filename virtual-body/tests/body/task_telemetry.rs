//! What goes up the cable while the body lives.

use towmag::Status;
use towmag::health::{Count, FIGURES};
use towmag::link::{FAULT_NAMES, FaultCounters};
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};

fn body() -> Body {
    let bench = Bench::new();
    store(&bench, |_| ());
    Body::start(&bench)
}

fn fault(counters: &FaultCounters, name: &str) -> u32 {
    counters.0[FAULT_NAMES.iter().position(|found| *found == name).unwrap()]
}

#[test]
fn every_epoch_goes_up_with_what_is_missing() {
    let mut body = body();
    body.live(3);
    body.received();
    body.live(20);
    let received = body.received();
    assert_eq!((received.telemetry.len(), received.bad), (200, 0));
    assert!(received.telemetry.windows(2).all(|pair| pair[1].tick == pair[0].tick + 1));
    for message in &received.telemetry {
        assert_eq!(message.raw_scalar_pt, Some(49_800_131));
        assert_eq!((message.quality.scalar, message.quality.flux), (ScalarMark::Present, FluxMark::Missing));
        assert!(message.status == Status::from_code(4).unwrap() && message.compensated.is_none(), "{message:?}");
        assert!(message.activity.log_failing && !message.activity.logging);
    }
    // A silent converter is set up again once a second; its faults go round in the messages.
    assert!((22..=24).contains(&body.bench.fluxgate_wakes.get()));
    let mut counters = FaultCounters::default();
    received.telemetry.iter().for_each(|message| counters.update(&message.faults));
    assert!(fault(&counters, "converter bus") >= 20 && fault(&counters, "fluxgate missing") >= 200, "{counters:?}");
    assert_eq!(fault(&counters, "card errors"), body.health.counts.get(Count::LogErrors));
}

#[test]
fn figures_go_up_every_two_seconds() {
    let mut body = body();
    body.bench.restarts_by_fault.set(2);
    body.live(20);
    let figures = body.received().figures;
    assert!((10..=11).contains(&figures.len()));
    let last = figures.last().unwrap();
    assert_eq!(last.len(), FIGURES);
    // Log errors; cost of an epoch; stack; ticks of the known loop.
    assert_eq!(last[8], body.health.counts.get(Count::LogErrors));
    assert_eq!(last[11..], [50_000, 40_000, 12_345, 100_000]);
}

#[test]
fn a_cable_that_takes_nothing_costs_whole_frames_that_are_counted() {
    let mut body = body();
    body.bench.room.set(0);
    body.live(10);
    assert!(body.bench.listens.get(), "the transmitter is to call when it has room");
    let dropped = body.health.counts.get(Count::FramesDropped);
    assert!((50..=90).contains(&dropped), "{dropped}");
    body.bench.room.set(usize::MAX);
    body.live(2);
    let received = body.received();
    assert!(received.bad == 0 && !body.bench.listens.get());
    let ticks: Vec<u32> = received.telemetry.iter().map(|message| message.tick).collect();
    let missing: u32 = ticks.windows(2).map(|pair| pair[1] - pair[0] - 1).sum();
    // Besides the epochs, a frame of figures every two seconds.
    assert!((missing..=missing + 5).contains(&dropped), "{dropped} dropped, {missing} epochs missing");
}

#[test]
fn a_busy_transmitter_loses_no_byte() {
    let mut body = body();
    for room in [3, 100, 900, 1, 517, 800, 400, 900, 700, 800] {
        body.bench.room.set(room);
        body.live(1);
    }
    body.bench.room.set(usize::MAX);
    body.live(1);
    let received = body.received();
    assert_eq!((received.bad, body.health.counts.get(Count::FramesDropped)), (0, 0));
    assert!(received.telemetry.len() >= 100);
}
