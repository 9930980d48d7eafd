//! A whole trial of diagnoses that are made up: what they are given, and what is made of what they say.
use std::sync::Mutex;

use towmag_trial::{Answer, BlindTrial, Kind, RealRecording, Request, TrialError, TrialOptions, seal};

const NOTHING: &str = r#"{"schema": 1, "verdict": "no_gap", "summary": "As simulated.", "effects": [],
    "candidates": [{"name": "none", "probability": 0.75}]}"#;

fn options(withhold: Option<&str>) -> TrialOptions {
    TrialOptions {
        recordings: 6,
        seed: 5,
        minutes: Some(2.0),
        withhold: withhold.map(String::from),
        ..TrialOptions::default()
    }
}

fn draw(options: TrialOptions, real: Option<RealRecording>) -> (BlindTrial, Vec<Answer>) {
    let blind = BlindTrial::draw(options, real, || {}).unwrap();
    let answers = serde_json::from_str(blind.answers()).unwrap();
    (blind, answers)
}

/// What a diagnosis was asked, without the texts: name, whether there is a second recording, what is withheld.
type Asked = (String, bool, Vec<String>);

fn run(blind: &BlindTrial) -> (towmag_trial::Trial, Vec<Asked>) {
    let asked = Mutex::new(Vec::new());
    let diagnose = |request: &Request<'_>| -> Result<String, TrialError> {
        assert!(request.recording.starts_with("time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT") && request.seed == 5);
        let second = request.confirm.inspect(|second| assert_ne!(*second, request.recording));
        asked.lock().unwrap().push((request.name.to_string(), second.is_some(), request.withheld.to_vec()));
        Ok(NOTHING.into())
    };
    let trial = blind.run(diagnose, || {}).unwrap();
    let mut asked = asked.into_inner().unwrap();
    asked.sort_by_key(|(name, ..)| name.clone());
    (trial, asked)
}

#[test]
fn single_effects_come_with_a_second_recording_and_everything_is_counted() {
    let (blind, answers) = draw(options(None), None);
    assert_eq!(blind.sha256(), seal(blind.answers()));
    assert!(blind.unopened().score.is_none() && blind.recording_count() == 6);
    let (trial, asked) = run(&blind);
    for (answer, asked) in answers.iter().zip(&asked) {
        assert_eq!(*asked, (format!("recording {}", answer.index), answer.kind == Kind::Single, Vec::new()));
    }
    let score = trial.score.unwrap();
    let clean = answers.iter().filter(|answer| answer.kind == Kind::None).count();
    assert_eq!((score.false_alarms.hits, score.false_alarms.of), (0, clean));
    assert!(score.calibration.bins.iter().all(|bin| bin.promised == 0.75));
    assert_eq!(score.calibration.bins.iter().map(|bin| bin.came.of).sum::<usize>(), 6);
    assert_eq!(score.calibration.bins.iter().map(|bin| bin.came.hits).sum::<usize>(), clean);
    let json = serde_json::to_value(&trial.results).unwrap();
    assert_eq!(
        json[0],
        serde_json::json!({ "diagnosis": serde_json::from_str::<serde_json::Value>(NOTHING).unwrap() })
    );
}

#[test]
fn what_is_withheld_is_put_back_where_it_is_hidden() {
    let (blind, answers) = draw(TrialOptions { recordings: 12, ..options(Some("mains_alias")) }, None);
    let (trial, asked) = run(&blind);
    let has = |answer: &Answer| answer.hidden.iter().any(|hidden| hidden.name == "mains_alias");
    let hidden = answers.iter().filter(|answer| has(answer)).count();
    assert!(hidden > 0 && asked.len() == answers.len() + hidden);
    assert_eq!(asked.iter().filter(|(.., withheld)| withheld.is_empty()).count(), hidden);
    assert!(answers.iter().zip(&trial.results).all(|(answer, result)| result.put_back.is_some() == has(answer)));
    assert_eq!(trial.score.unwrap().withheld.unwrap().noticed.of, hidden);
}

#[test]
fn what_is_no_diagnosis_ends_the_trial() {
    let (blind, _) = draw(TrialOptions { recordings: 1, ..options(None) }, None);
    let error = blind.run(|_: &Request<'_>| Ok::<_, TrialError>("nothing found".into()), || {}).unwrap_err();
    assert!(matches!(error, TrialError::Reply { .. }) && !error.is_bad_input(), "{error}");
    let error = |options| BlindTrial::draw(options, None, || {}).err().unwrap().to_string();
    assert_eq!(error(TrialOptions { recordings: 0, ..options(None) }), "recordings 0: choose at least 1");
    assert_eq!(error(TrialOptions { minutes: Some(0.5), ..options(None) }), "minutes 0.5: choose 2 to 120");
}

#[test]
fn effects_are_put_into_a_real_recording_in_the_order_that_is_asked_for() {
    let (made, _) = draw(TrialOptions { recordings: 1, ..options(None) }, None);
    let kept = Mutex::new(String::new());
    made.recordings(|_, csv| {
        kept.lock().unwrap().push_str(csv);
        Ok::<(), TrialError>(())
    })
    .unwrap();
    let csv = kept.into_inner().unwrap();
    let injectable = ["mains_alias", "an_effect_of_somebody_else", "fluxgate_bias"].map(String::from);
    let read = |injectable: &[String]| RealRecording::read("rec.csv", csv.clone(), injectable);
    assert!(matches!(read(&injectable[1..2]), Err(TrialError::NothingToPutIn { .. })));
    let (blind, answers) = draw(options(None), Some(read(&injectable).unwrap()));
    assert_eq!(
        answers[..2].iter().map(|answer| &answer.hidden[0].name).collect::<Vec<_>>(),
        [&injectable[0], &injectable[2]]
    );
    blind
        .recordings(|index, injected| {
            // Targets change both sensors; nothing else of the file has changed.
            assert!(answers.iter().any(|answer| answer.index == index && (1..=3).contains(&answer.targets.len())));
            let changed = |column: usize| {
                let field = |line: &str| line.split(',').nth(column).unwrap().to_string();
                csv.lines().zip(injected.lines()).any(|(before, after)| field(before) != field(after))
            };
            let columns = csv.lines().next().unwrap().split(',').count();
            let all: Vec<usize> = (0..columns).filter(|column| changed(*column)).collect();
            assert_eq!(all, [1, 2, 3, 4]);
            assert_eq!(injected.lines().count(), csv.lines().count());
            Ok::<(), TrialError>(())
        })
        .unwrap();
    let (trial, asked) = run(&blind);
    assert_eq!((asked.len(), asked[0].1), (answers.len() + 1, false));
    let on = trial.on.unwrap();
    assert_eq!((on.untouched.as_str(), trial.score.is_none()), ("As simulated.", true));
    assert_eq!(on.named.iter().map(|bin| bin.named.of).sum::<usize>(), answers.len());
}
