//! The console: from bytes to commands to answers, and a calibration under its hand.

use crate::sample;

use proptest::collection::vec;
use proptest::prelude::*;
use sample::epochs;
use towmag::body::UnixTime;
use towmag::housekeeping::Housekeeping;
use towmag::link::{
    Action, Answer, Calibrate, CalibrationSession, Command, Dropped, FaultCounters, Found, HELP, Input, LONGEST_LINE,
    LineReader, MAX_BODY, SessionState, StatusReport, acknowledged, acknowledgement, execute, numbered, parse,
};
use towmag::store::{BodySettings, Condition, Parameter, Stored};

fn push(reader: &mut LineReader, bytes: &[u8]) -> Vec<Input> {
    bytes.iter().filter_map(|&byte| reader.push(byte)).collect()
}

fn status() -> StatusReport {
    StatusReport {
        firmware_version: "0.1.0",
        tick: 1234,
        time: None,
        sectors_left: Some(36_000),
        session: SessionState::Idle,
        settings: Condition::Intact,
        is_unsaved: false,
        housekeeping: Housekeeping::default(),
        faults: FaultCounters::default(),
    }
}

/// The body as far as the console sees it.
#[derive(Default)]
struct Body {
    stored: Stored,
    draft: BodySettings,
    session: CalibrationSession,
}

impl Body {
    fn answer(&mut self, line: &str) -> (Vec<String>, Action) {
        let command = parse(line).unwrap();
        let (answer, action) = execute(&command, &mut self.stored, &mut self.draft, &mut self.session, &status());
        (lines(&answer, &self.draft), action)
    }
}

fn lines(answer: &Answer, settings: &BodySettings) -> Vec<String> {
    (0..).map_while(|number| answer.line(settings, number)).map(|line| line.to_string()).collect()
}

fn time_set(unix_us: u64, error_us: u32, stamp_us: Option<u32>) -> Command {
    Command::TimeSet { time: UnixTime { unix_us, error_us }, stamp_us }
}

#[test]
fn commands() {
    let lambda1 = Parameter::named("lambda1").unwrap();
    for (line, command) in [
        ("status", Command::Status),
        ("  STATUS  ", Command::Status),
        ("get", Command::Get(None)),
        ("get lambda1", Command::Get(Some(lambda1))),
        ("set lambda1 0.5", Command::Set { parameter: lambda1, value: "0.5".try_into().unwrap() }),
        ("calibrate start", Command::Calibrate(Calibrate::Start)),
        ("calibrate stop", Command::Calibrate(Calibrate::Stop)),
        ("calibrate fluxgate", Command::Calibrate(Calibrate::Fluxgate)),
        ("Calibrate Accept Yes", Command::Calibrate(Calibrate::Accept)),
        ("calibrate\tdiscard yes", Command::Calibrate(Calibrate::Discard)),
        ("log start", Command::Log(true)),
        ("log stop yes", Command::Log(false)),
        ("save", Command::Save),
        ("time set 1767225600", time_set(1_767_225_600_000_000, 1_000_000, None)),
        ("time set 1767225600.25@4294967295+-1500", time_set(1_767_225_600_250_000, 1_500, Some(u32::MAX))),
        ("time ask", Command::TimeAsk),
        ("help", Command::Help),
        ("?", Command::Help),
        ("reset yes", Command::Reset),
    ] {
        assert_eq!(parse(line), Ok(command), "{line}");
    }
}

#[test]
fn refusals_say_what_to_type() {
    for (line, answer) in [
        ("frobnicate 1", "error: no command \"frobnicate\": type help"),
        ("status now", "error: type status"),
        ("reset all", "error: type reset yes"),
        ("reset", "not done: to confirm it, type reset yes"),
        ("log stop", "not done: to confirm it, type log stop yes"),
        ("calibrate accept", "not done: to confirm it, type calibrate accept yes"),
        ("calibrate discard no", "error: type calibrate discard yes"),
        ("save it", "error: type save"),
        ("get a b", "error: type get or get name"),
        ("get nothing", "error: no setting \"nothing\": type get for all of them"),
        ("set lambda1", "error: type set name value"),
        ("set lambda1 1 2", "error: type set name value"),
        ("calibrate", "error: type calibrate start, fluxgate, stop, accept yes or discard yes"),
        ("log on", "error: type log start or log stop yes"),
        ("time set 1767225600000", "error: type time set seconds, since 1970-01-01 UTC, of the years 2020 to 2099"),
    ] {
        assert_eq!(parse(line).unwrap_err().to_string(), answer);
    }
    let long = "x".repeat(1000);
    assert!(parse(&long).unwrap_err().to_string().len() < MAX_BODY);
    assert!(parse(&format!("get {long}")).unwrap_err().to_string().len() < MAX_BODY);
    assert!(parse(&format!("set lambda1 {long}")).is_err());
}

#[test]
fn lines_end_as_terminals_end_them() {
    let mut reader = LineReader::default();
    let inputs =
        push(&mut reader, b"\r\n\r\nstatus\rhelp\nreset yes\r\n \r\nstqt\x08\x7fatus\nnonsense\x15log stop yes\n");
    let commands = [Command::Status, Command::Help, Command::Reset, Command::Status, Command::Log(false)];
    assert_eq!(inputs, commands.map(Input::Command));
    assert_eq!(reader.counters().commands, 5);
}

#[test]
fn damaged_and_overlong_lines_are_dropped_and_counted() {
    let mut reader = LineReader::default();
    assert_eq!(push(&mut reader, b"log \xffstop\n"), [Input::Dropped(Dropped::Damaged)], "never a part of a line");
    // Reported once: noise must not fill the cable with answers.
    assert_eq!(push(&mut reader, b"\0\0\0\n\xf0\n\x80reset yes\n"), []);
    assert_eq!(push(&mut reader, b"status\n"), [Input::Command(Command::Status)]);
    let mut long = vec![b' '; LONGEST_LINE - 6];
    long.extend_from_slice(b"status\n");
    assert_eq!(push(&mut reader, &long), [Input::Command(Command::Status)]);
    long.insert(0, b' ');
    assert_eq!(push(&mut reader, &long), [Input::Dropped(Dropped::Overlong)]);
    assert_eq!(push(&mut reader, b"res"), []);
    reader.receive_error();
    assert_eq!(push(&mut reader, b"et yes\n"), []);
    assert_eq!(push(&mut reader, b"reset yes\n"), [Input::Command(Command::Reset)]);
    let counters = reader.counters();
    assert_eq!((counters.damaged, counters.overlong, counters.receive_errors, counters.commands), (5, 1, 1, 3));
}

proptest! {
    #[test]
    fn after_any_garbage_the_next_line_is_read(garbage in vec(any::<u8>(), 0..500)) {
        let mut reader = LineReader::default();
        push(&mut reader, &garbage);
        push(&mut reader, b"\n");
        prop_assert_eq!(push(&mut reader, b"status\n"), [Input::Command(Command::Status)]);
    }

    #[test]
    fn every_line_of_text_has_an_answer_that_fits(line in "[ -~]{0,80}") {
        let mut reader = LineReader::default();
        let inputs = push(&mut reader, format!("{line}\n").as_bytes());
        prop_assert_eq!(inputs.len(), usize::from(!line.trim().is_empty()));
        if let Some(Input::Refused(error)) = inputs.first() {
            prop_assert!(error.to_string().len() <= MAX_BODY);
        }
    }

    /// Words that mean something, in any order: no panic, and the settings stay valid.
    #[test]
    fn any_sequence_of_commands(words in vec(words(), 0..40)) {
        let mut body = Body::default();
        for line in words {
            if let Ok(command) = parse(&line) {
                let (answer, _) = execute(&command, &mut body.stored, &mut body.draft, &mut body.session, &status());
                prop_assert!(!lines(&answer, &body.draft).is_empty());
            }
            prop_assert!(body.stored.settings.validate().is_ok() && body.draft.validate().is_ok());
        }
    }
}

fn words() -> impl Strategy<Value = String> {
    let fixed = prop_oneof![
        Just("status"),
        Just("get"),
        Just("calibrate start"),
        Just("calibrate stop"),
        Just("calibrate fluxgate"),
        Just("calibrate accept yes"),
        Just("calibrate discard yes"),
        Just("log stop yes"),
        Just("save"),
        Just("help"),
    ];
    let value = prop_oneof![
        "[0-9.e-]{1,8}",
        Just("qtfm-gen2".to_string()),
        Just("qtfm-gen1".to_string()),
        Just("rls".to_string()),
        Just("off".to_string())
    ];
    let set = (any::<proptest::sample::Index>(), value).prop_map(|(index, value)| {
        let parameters: Vec<_> = Parameter::all().collect();
        format!("set {} {value}", parameters[index.index(parameters.len())].name())
    });
    prop_oneof![fixed.prop_map(str::to_string), set]
}

#[test]
fn answers_fit_their_frames() {
    assert!(HELP.iter().all(|line| line.len() <= MAX_BODY));
    let mut body = Body::default();
    let (answer, action) = body.answer("get");
    assert_eq!((answer.len(), action), (Parameter::all().count(), Action::None));
    assert_eq!(answer[0], "method = adaptive");
    assert_eq!(body.answer("get lambda2").0, ["lambda2 = 0.025"]);
    assert_eq!(body.answer("get gen2_decimals").0, ["gen2_decimals (not in this scalar_format)"]);
    assert_eq!(body.answer("help").0, HELP);
}

#[test]
fn settings_are_set_and_stored() {
    let mut body = Body::default();
    assert_eq!(body.answer("set lambda2 0.1"), (vec!["lambda2 = 0.1".into()], Action::None));
    assert_eq!(body.stored, Stored::default(), "not before it is saved");
    assert_eq!(body.answer("get lambda2").0, ["lambda2 = 0.1"]);
    assert_eq!(body.answer("status").0[3], "settings: intact; changed and not saved: type save");
    assert_eq!(
        body.answer("save"),
        (vec!["saved: holds from the next start, log at once".into()], Action::SaveSettings)
    );
    assert_eq!(body.answer("save"), (vec!["nothing to save".into()], Action::None));
    let (answer, action) = body.answer("set lambda2 -1");
    assert_eq!(answer, ["error: lambda2 is -1: choose 0.000000001 to 1000000"]);
    assert_eq!(action, Action::None);
    assert_eq!(body.stored.settings.estimator.penalty.lambda2, 0.1);
    body.answer("set lambda1 0.5");
    assert_eq!(body.answer("log stop yes").1, Action::SaveSettings);
    assert!(!body.stored.settings.log && body.stored.settings.estimator.penalty.lambda1 != 0.5, "log alone");
    assert_eq!(
        body.answer("time set 1767225600").1,
        Action::SetTime { time: UnixTime { unix_us: 1_767_225_600_000_000, error_us: 1_000_000 }, stamp_us: None }
    );
    assert_eq!(body.answer("reset yes").1, Action::Restart);
}

#[test]
fn status_names_every_fault_there_is() {
    let mut report = status();
    assert_eq!(
        lines(&Answer::Status(report), &BodySettings::default()),
        [
            "towmag 0.1.0, tick 1234",
            "time: not set, type time set seconds",
            "log: on, room for 10 h",
            "settings: intact",
            "calibration: none",
            "battery: not measured, leak contact: not fitted",
        ]
    );
    report.faults.0[1] = 7;
    report.faults.0[35] = u32::MAX;
    report.housekeeping = Housekeeping { battery_v: Some(12.345), has_leak: Some(true) };
    let all = lines(&Answer::Status(report), &BodySettings::default());
    assert_eq!(all[5], "battery: 12.35 V, leak contact: WET");
    assert_eq!(all[6..], ["fault: scalar cut lines 7", "fault: restarts by fault 4294967295"]);
}

#[test]
fn a_calibration_is_kept_only_when_accepted() {
    let mut body = Body::default();
    for (line, answer) in [
        ("calibrate stop", "error: no calibration is running: calibrate start or calibrate fluxgate"),
        ("calibrate accept yes", "error: no result to accept: calibrate start, turn the body, calibrate stop"),
        ("calibrate start", "calibration running: roll, pitch and yaw on four headings"),
        ("calibrate start", "error: a calibration is running: calibrate stop or calibrate discard yes"),
        ("calibrate accept yes", "error: a calibration is running: calibrate stop or calibrate discard yes"),
    ] {
        assert_eq!(body.answer(line), (vec![answer.to_string()], Action::None), "{line}");
    }
    // Too short a recording goes on; the message tells by how much.
    assert!(body.answer("calibrate stop").0[0].starts_with("error: only 0 usable epochs"));
    for epoch in epochs("calibration.csv") {
        body.session.step(&epoch);
    }
    assert!(body.answer("status").0[4].starts_with("calibration: running, "));
    let (answer, action) = body.answer("calibrate stop");
    assert_eq!((answer.len(), action), (21, Action::None));
    assert_eq!(body.stored, Stored::default(), "not before it is accepted");
    let Some(Found::Terms(summary)) = body.session.found().copied() else { panic!("no result waits") };
    assert!(summary.improvement_ratio > 5.0, "{}", answer[0]);
    assert!((1e2..1e5).contains(&summary.condition_number), "{}", answer[1]);
    assert!(summary.std.iter().all(|std| std.is_finite() && *std > 0.0));
    assert!(answer[2].starts_with("permanent x: ") && answer[2].ends_with(" nT"), "{}", answer[2]);
    assert!(answer[19].starts_with("eddy z dz: ") && answer[19].ends_with(" s"), "{}", answer[19]);
    assert_eq!(
        body.answer("calibrate start").0,
        ["error: a result is waiting: calibrate accept yes or calibrate discard yes"]
    );
    assert_eq!(
        body.answer("calibrate stop").0,
        ["error: a result is waiting: calibrate accept yes or calibrate discard yes"]
    );
    let mut other = Body { stored: body.stored, draft: body.draft, session: body.session.clone() };
    assert_eq!(other.answer("calibrate discard yes"), (vec!["calibration discarded".into()], Action::None));
    assert_eq!((other.stored, other.session.state()), (Stored::default(), SessionState::Idle));
    assert_eq!(
        body.answer("calibrate accept yes"),
        (vec!["calibration accepted: starting anew with it".into()], Action::SaveCalibration)
    );
    assert_eq!(body.stored.coefficients, summary.coefficients);
    assert!(body.stored.information.is_some());
    assert_eq!(body.session.state(), SessionState::Idle);
}

#[test]
fn a_session_is_the_calibration_of_the_desk() {
    let settings = towmag::Settings::default();
    let mut session = CalibrationSession::default();
    let mut desk = towmag::estimate::Calibration::new(&settings).unwrap();
    let mut used = 0;
    session.start(&settings).unwrap();
    for (number, epoch) in epochs("calibration.csv").into_iter().enumerate() {
        // With gaps.
        let epoch = towmag::Epoch { scalar_pt: epoch.scalar_pt.filter(|_| number % 500 != 99), ..epoch };
        session.step(&epoch);
        used += u32::from(desk.step(&epoch) == Ok(true));
    }
    let result = desk.solve().unwrap();
    assert_eq!(used, result.used_epochs);
    let Ok(Found::Terms(summary)) = session.stop() else { panic!("no result") };
    assert_eq!((summary.coefficients, summary.condition_number), (result.coefficients, result.condition_number));
    assert_eq!(summary.improvement_ratio, result.std_before_nt / result.rms_after_nt);
    // The nT of a permanent term are those of eq. (4); an eddy term is in seconds at 50,000 nT.
    assert_eq!(summary.std[0], f64::from(result.std_nt[0]));
    assert_eq!(summary.std[17], f64::from(result.std_nt[17]) / 50_000.0);
}

#[test]
fn a_numbered_line_is_known_by_its_crc() {
    // CRC-32 (ISO-HDLC) of "12 set lambda1 0.002", by zlib.
    assert_eq!(numbered(12, "set lambda1 0.002").unwrap(), "#12 set lambda1 0.002*1662dfce");
    let mut reader = LineReader::default();
    let line = format!("{}\n", numbered(12, "status").unwrap());
    let whole = Input::Numbered { number: 12, command: Ok(Command::Status) };
    assert_eq!(push(&mut reader, line.as_bytes()), [whole]);
    let unknown = push(&mut reader, format!("{}\n", numbered(13, "frobnicate").unwrap()).as_bytes());
    assert!(matches!(unknown[..], [Input::Numbered { number: 13, command: Err(_) }]), "{unknown:?}");
    assert_eq!(push(&mut reader, b"#12 reset yes\n"), [Input::Dropped(Dropped::Damaged)]);
    // A bit of the last digit flipped makes it Ctrl-U.
    let cleared = numbered(49755, "set method 0").unwrap().replacen("5 ", "\x15 ", 1) + "\n";
    assert_eq!(push(&mut LineReader::default(), cleared.as_bytes()), [Input::Dropped(Dropped::Damaged)]);
    assert_eq!(acknowledged(&acknowledgement(12)), Some(12));
    assert!(numbered(12, &"x".repeat(LONGEST_LINE)).is_none());
}

proptest! {
    /// Bytes that are lost without a trace and bits that flip never make a command of a numbered line but itself.
    #[test]
    fn a_damaged_numbered_line_does_nothing(
        number: u16,
        sent in words(),
        lost in vec(0..LONGEST_LINE, 0..4),
        flipped in vec((0..LONGEST_LINE, 0..8), 0..4),
    ) {
        let mut bytes = numbered(number, &sent).unwrap().as_bytes().to_vec();
        for (place, bit) in flipped {
            if let Some(byte) = bytes.get_mut(place) {
                *byte ^= 1_u8 << bit;
            }
        }
        for place in lost {
            if place < bytes.len() {
                bytes.remove(place);
            }
        }
        bytes.push(b'\n');
        for input in push(&mut LineReader::default(), &bytes) {
            match input {
                Input::Numbered { number: done, command } => prop_assert_eq!((done, command), (number, parse(&sent))),
                Input::Command(command) => prop_assert!(false, "{:?}", command),
                Input::Refused(_) | Input::Dropped(_) => {}
            }
        }
    }
}
