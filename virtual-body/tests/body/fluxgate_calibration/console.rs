//! The same under the operator's hand: commands, answers, and what is stored.

use towmag::Epoch;
use towmag::estimate::{Information, TRIANGLE};
use towmag::housekeeping::Housekeeping;
use towmag::link::{
    Action, Answer, CalibrationSession, FaultCounters, MAX_BODY, SessionState, StatusReport, execute, parse,
};
use towmag::model::Coefficients;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::store::{BodySettings, Condition, Stored};
use towmag_virtual_body::turned_sensor::{Draw, TurnedSensor, Turning};

/// A body whose 18 coefficients were calibrated before.
struct Body {
    stored: Stored,
    draft: BodySettings,
    session: CalibrationSession,
}

impl Body {
    fn new(fluxgate: FluxgateSettings) -> Self {
        let settings = BodySettings { fluxgate, ..BodySettings::default() };
        let coefficients = Coefficients::from_basis([3.0; 18]).unwrap();
        let information = Information::new(coefficients, [0.5; TRIANGLE], 0.3);
        let stored = Stored { settings, coefficients, information, level: None };
        Self { stored, draft: settings, session: CalibrationSession::new(fluxgate) }
    }

    fn answer(&mut self, line: &str) -> (Vec<String>, Action) {
        let status = StatusReport {
            firmware_version: "0.1.0",
            tick: 1234,
            time: None,
            sectors_left: None,
            session: SessionState::Idle,
            settings: Condition::Intact,
            is_unsaved: false,
            housekeeping: Housekeeping::default(),
            faults: FaultCounters::default(),
        };
        let command = parse(line).unwrap();
        let (answer, action) = execute(&command, &mut self.stored, &mut self.draft, &mut self.session, &status);
        (lines(&answer, &self.draft), action)
    }

    fn only(&mut self, line: &str) -> String {
        let (lines, action) = self.answer(line);
        assert_eq!((lines.len(), action), (1, Action::None), "{lines:?}");
        lines.concat()
    }
}

/// The lines of an answer; one as long as a frame may have been cut.
fn lines(answer: &Answer, settings: &BodySettings) -> Vec<String> {
    let lines: Vec<String> =
        (0..).map_while(|number| answer.line(settings, number)).map(|line| line.to_string()).collect();
    assert!(lines.iter().all(|line| line.len() < MAX_BODY), "{lines:?}");
    lines
}

fn epochs(sensor: &TurnedSensor, settings: &FluxgateSettings) -> Vec<Epoch> {
    let draw = &mut Draw::new(23);
    sensor.epochs(&Turning::tumbled(draw, 120), settings, false, draw)
}

#[test]
fn a_result_is_told_and_kept_only_when_accepted() {
    let sensor = TurnedSensor::drawn(&mut Draw::new(20), 0);
    let running = FluxgateSettings { ampere_per_count: 2e-6, ..FluxgateSettings::default() };
    let mut body = Body::new(running);
    let before = body.stored;
    // Saved, but not what the epochs are made with: the result starts from what they are.
    assert_eq!(body.only("set flux_x_bias_nt 777"), "flux_x_bias_nt = 777");
    assert_eq!(body.answer("save").1, Action::SaveSettings);
    assert_eq!(
        body.only("calibrate fluxgate"),
        "calibration of the fluxgate running: turn slowly, below 17 deg/s, through all directions, far from iron"
    );
    for line in ["calibrate start", "calibrate fluxgate", "calibrate accept yes"] {
        assert_eq!(body.only(line), "error: a calibration is running: calibrate stop or calibrate discard yes");
    }
    assert!(body.only("calibrate stop").starts_with("error: only 0 usable epochs, 420 are needed: "));
    epochs(&sensor, &running).iter().for_each(|epoch| body.session.step(epoch));
    assert_eq!(body.answer("status").0[4], "calibration of the fluxgate: running, 1199 of 1200 epochs used");
    let (told, action) = body.answer("calibrate stop");
    assert_eq!((told.len(), action), (6, Action::None), "{told:?}");
    assert!(told[0].starts_with("fluxgate less scalar: ") && told[0].ends_with(" nT after, 1199 epochs; +- 1.96 std:"));
    assert!(told[1].starts_with("sensor x: offset ") && told[4].starts_with("angles: xy "), "{told:?}");
    for line in ["calibrate start", "calibrate fluxgate", "calibrate stop"] {
        assert_eq!(body.only(line), "error: a result is waiting: calibrate accept yes or calibrate discard yes");
    }
    assert_eq!(body.stored.coefficients, before.coefficients, "not before it is accepted");
    let (told, action) = body.answer("calibrate accept yes");
    assert!(told[0].contains("coefficients zero: calibrate start"), "{told:?}");
    assert_eq!(action, Action::SaveCalibration);
    let fluxgate = body.stored.settings.fluxgate;
    for axis in 0..3 {
        assert!((fluxgate.bias_nt[axis] - sensor.bias_nt[axis]).abs() < 2.0, "{fluxgate:?}");
        assert!((fluxgate.nt_per_count[axis] / sensor.nt_per_count[axis] - 1.0).abs() < 1e-4, "{fluxgate:?}");
    }
    assert_eq!((body.draft.fluxgate, fluxgate.ampere_per_count), (fluxgate, 2e-6));
    assert_eq!((body.stored.coefficients, body.stored.information), (Coefficients::ZERO, None));
    assert_eq!(body.session.state(), SessionState::Idle);
}

#[test]
fn a_result_is_given_up_by_discard() {
    let settings = FluxgateSettings::default();
    let mut body = Body::new(settings);
    let before = body.stored;
    body.only("calibrate fluxgate");
    epochs(&TurnedSensor::drawn(&mut Draw::new(20), 0), &settings).iter().for_each(|epoch| body.session.step(epoch));
    assert_eq!(body.answer("calibrate stop").0.len(), 6);
    assert_eq!(body.only("calibrate discard yes"), "calibration discarded");
    assert_eq!((body.stored, body.session.state()), (before, SessionState::Idle));
    body.only("calibrate start");
    let running = "error: a calibration is running: calibrate stop or calibrate discard yes";
    assert_eq!(body.only("calibrate fluxgate"), running);
}

/// What turning on can mend goes on; what it cannot ends, and says where to begin anew.
#[test]
fn a_refused_recording_goes_on_when_that_helps() {
    let settings = FluxgateSettings::default();
    let draw = &mut Draw::new(22);
    let sensor = TurnedSensor::drawn(draw, 0);
    let mut body = Body::new(settings);
    body.only("calibrate fluxgate");
    let level = Turning::swung(draw, &[[0.0, 0.0, 1.0]], 360.0, 60);
    let level = sensor.epochs(&level, &settings, false, draw);
    level.iter().for_each(|epoch| body.session.step(epoch));
    assert!(body.only("calibrate stop").starts_with("error: sensor z may be "));
    epochs(&sensor, &settings).iter().for_each(|epoch| body.session.step(epoch));
    assert_eq!(body.answer("calibrate stop").0.len(), 6);
    body.only("calibrate discard yes");
    let shaken = TurnedSensor { noise_nt: 15.0, ..sensor };
    body.only("calibrate fluxgate");
    epochs(&shaken, &settings).iter().for_each(|epoch| body.session.step(epoch));
    assert!(body.only("calibrate stop").contains("nT rms are left: go away from iron, calibrate fluxgate"));
    assert_eq!(body.session.state(), SessionState::Idle);
}

#[test]
fn the_longest_refusals_fit_a_line() {
    use towmag::fluxgate_calibration::FluxgateCalibrationError::{NotCovered, NotFinite, TooShort};
    use towmag::link::SessionError;
    for error in
        [TooShort { used_epochs: 419, needed_epochs: 420 }, NotCovered { unknown: 8, error_nt: 1e6 }, NotFinite]
    {
        let line = format!("error: {}", SessionError::Fluxgate(error));
        assert!(line.len() <= MAX_BODY, "{line}");
    }
}
