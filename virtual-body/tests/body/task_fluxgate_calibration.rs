//! `calibrate fluxgate` in the task of the console: from counts to settings in the flash, and the start with them.

use std::rc::Rc;
use towmag::estimate::Prior;
use towmag::log::EventKind;
use towmag::model::Coefficients;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::turned_sensor::{Draw, TurnedSensor, Turning};

/// A body with coefficients of its own and a card.
fn bench() -> Rc<Bench> {
    let bench = Bench::new();
    let coefficients = Coefficients::from_basis([2.0; 18]).unwrap();
    store(&bench, |stored| stored.accept(&Prior { coefficients, information: None, level: None }));
    bench.card.replace(Some(fat16(8000)));
    bench
}

/// A body that has told what its self-test at the start has found.
fn started(bench: &Rc<Bench>) -> Body {
    let mut body = Body::start(bench);
    body.live(20);
    body
}

fn sensor() -> TurnedSensor {
    TurnedSensor::drawn(&mut Draw::new(20), 0)
}

/// What the sensors read while somebody turns the body.
fn turn(body: &mut Body, seconds: usize) {
    let draw = &mut Draw::new(24);
    let turning = Turning::tumbled(draw, seconds);
    for epoch in sensor().epochs(&turning, &FluxgateSettings::default(), true, draw) {
        body.tasks.context.session.step(&epoch);
    }
}

fn is_calibrating(body: &mut Body) -> bool {
    body.live(1);
    body.received().telemetry.last().unwrap().activity.calibrating
}

fn bias_nt(body: &mut Body) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| {
        let name = format!("flux_{axis}_bias_nt");
        body.answer(&format!("get {name}")).concat().strip_prefix(&format!("{name} = ")).unwrap().parse().unwrap()
    })
}

#[test]
fn what_was_accepted_holds_from_the_next_start() {
    let bench = bench();
    let mut body = started(&bench);
    assert!(body.answer("calibrate fluxgate")[0].starts_with("calibration of the fluxgate running: "));
    assert!(is_calibrating(&mut body));
    assert!(body.answer("calibrate start")[0].starts_with("error: a calibration is running"));
    turn(&mut body, 30);
    assert!(body.answer("calibrate stop")[0].starts_with("error: only 299 usable epochs, 420 are needed"));
    turn(&mut body, 180);
    let told = body.answer("calibrate stop");
    assert!(told.len() == 6 && told[5].starts_with("keep it with calibrate accept yes"), "{told:?}");
    assert!(!is_calibrating(&mut body));
    let accepted = body.answer("calibrate accept yes");
    assert!(accepted.len() == 1 && accepted[0].starts_with("calibration of the fluxgate accepted"), "{accepted:?}");
    assert!(bench.restarts.get() > 0);
    let events: Vec<EventKind> = body.events().into_iter().map(|event| event.kind).collect();
    assert_eq!(events.iter().filter(|kind| matches!(kind, EventKind::CalibrationFailed { .. })).count(), 1);
    let axes = events.iter().find_map(|kind| match kind {
        EventKind::FluxgateCalibrated { axes, used_epochs, rms_before_nt, rms_after_nt } => {
            assert!(*used_epochs > 2_000 && *rms_before_nt > 100.0 && *rms_after_nt < 1.0, "{kind:?}");
            Some(*axes)
        }
        _ => None,
    });
    drop(body);

    let mut body = started(&bench);
    assert_eq!(Some(bias_nt(&mut body)), axes.map(|axes| axes.bias_nt));
    for (found_nt, true_nt) in bias_nt(&mut body).into_iter().zip(sensor().bias_nt) {
        assert!((found_nt - true_nt).abs() < 2.0, "{found_nt} {true_nt}");
    }
}

#[test]
fn the_power_goes_before_it_is_accepted() {
    let bench = bench();
    let mut body = started(&bench);
    body.answer("calibrate fluxgate");
    turn(&mut body, 180);
    assert_eq!(body.answer("calibrate stop").len(), 6);
    let flash = bench.flash.borrow().clone();
    drop(body);
    let mut body = started(&bench);
    assert_eq!(body.answer("status")[4], "calibration: none");
    assert_eq!(bias_nt(&mut body), [0.0; 3]);
    assert_eq!(*bench.flash.borrow(), flash, "nothing was stored");
}

#[test]
fn a_flash_that_refuses_is_told_and_the_body_goes_on() {
    let bench = bench();
    let mut body = started(&bench);
    body.answer("calibrate fluxgate");
    turn(&mut body, 180);
    body.answer("calibrate stop");
    bench.flash_refuses.set(true);
    let refused = body.answer("calibrate accept yes");
    assert!(refused[0].starts_with("error: not stored, gone with the next start: "), "{refused:?}");
    assert_eq!(bench.restarts.get(), 0);
    // What is `set` and saved afterwards brings the axes with it.
    bench.flash_refuses.set(false);
    body.answer("set lambda1 0.002");
    assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
    drop(body);
    let mut body = started(&bench);
    assert!((bias_nt(&mut body)[0] - sensor().bias_nt[0]).abs() < 2.0);
}
