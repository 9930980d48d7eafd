//! A trial in parts is the trial at once, and what is no such thing is refused.
use std::sync::LazyLock;

use towmag_trial::{BlindTrial, Merged, Part, RealRecording, Request, Shard, TrialError, TrialOptions, merge};

const RECORDINGS: usize = 4;

fn options(seed: u64, withhold: Option<&str>) -> TrialOptions {
    let withhold = withhold.map(String::from);
    TrialOptions { recordings: RECORDINGS, seed, minutes: Some(2.0), withhold, ..TrialOptions::default() }
}

/// Says something else of every recording, with digits that do not forgive.
fn diagnosis(request: &Request<'_>) -> Result<String, TrialError> {
    let mixed =
        request.recording.bytes().fold(request.withheld.len() as u64, |sum, byte| sum * 31 % 999_983 + u64::from(byte));
    let probability = mixed as f64 / 3_000_000.0;
    Ok(format!(
        r#"{{"schema": 1, "verdict": "no_gap", "summary": "As simulated.", "p": {:e}, "effects": [],
        "candidates": [{{"name": "none", "probability": {probability}}}]}}"#,
        probability * 1e-300
    ))
}

fn run(options: TrialOptions, real: Option<RealRecording>) -> (String, String) {
    let blind = BlindTrial::draw(options, real, || {}).unwrap();
    let trial = blind.run(diagnosis, || {}).unwrap();
    (blind.answers().into(), json(&trial))
}

fn json(trial: &towmag_trial::Trial) -> String {
    serde_json::to_string_pretty(trial).unwrap()
}

fn part_of(options: &TrialOptions, number: usize, of: usize) -> Part {
    part_on(options, number, of, None)
}

fn part_on(options: &TrialOptions, number: usize, of: usize, real: Option<RealRecording>) -> Part {
    let shard = Some(Shard::new(number, of).unwrap());
    let (answers, trial) = run(TrialOptions { shard, ..options.clone() }, real);
    Part::read(&format!("part {number}"), &answers, &trial).unwrap()
}

/// A trial at once.
static AT_ONCE: LazyLock<(String, String)> = LazyLock::new(|| run(options(5, None), None));
/// And what each of three jobs has left of it. Both are made once for all tests: nearly all of the time goes into recordings.
static OF_THREE: LazyLock<[(String, String); 3]> = LazyLock::new(|| {
    [1, 2, 3].map(|number| {
        let shard = Some(Shard::new(number, 3).unwrap());
        run(TrialOptions { shard, ..options(5, None) }, None)
    })
});

fn of_three() -> [Part; 3] {
    [1, 2, 3].map(|number: usize| {
        let (answers, trial) = &OF_THREE[number - 1];
        Part::read(&format!("part {number}"), answers, trial).unwrap()
    })
}

fn merged(parts: Vec<Part>) -> (String, String) {
    let Merged { answers, trial } = merge(parts).unwrap();
    (answers, json(&trial))
}

#[test]
fn parts_in_any_order_are_the_trial_at_once() {
    let parts = of_three();
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        assert!(merged(order.map(|place| parts[place].clone()).into()) == *AT_ONCE, "{order:?}");
    }
    let withheld = options(5, Some("mains_alias"));
    let parts = [3, 1, 2].map(|number| part_of(&withheld, number, 3));
    assert!(merged(parts.into()) == run(withheld, None));
}

#[test]
fn any_number_of_parts_is_the_trial_at_once() {
    for of in [1, RECORDINGS] {
        let parts = (1..=of).rev().map(|number| part_of(&options(5, None), number, of));
        assert!(merged(parts.collect()) == *AT_ONCE, "{of}");
    }
}

#[test]
fn parts_on_a_real_recording_are_the_trial_on_it() {
    let made = BlindTrial::draw(TrialOptions { recordings: 2, ..options(5, None) }, None, || {}).unwrap();
    let kept = std::sync::Mutex::new(vec![String::new(); 2]);
    made.recordings(|index, csv| {
        kept.lock().unwrap()[index] = csv.into();
        Ok::<(), TrialError>(())
    })
    .unwrap();
    let [csv, other] = <[String; 2]>::try_from(kept.into_inner().unwrap()).unwrap();
    let real = |csv: &str| Some(RealRecording::read("rec.csv", csv.into(), &["mains_alias".into()]).unwrap());
    let options = options(5, None);
    let parts = [1, 2].map(|number| part_on(&options, number, 2, real(&csv)));
    assert!(merged(parts.to_vec()) == run(options.clone(), real(&csv)));
    let foreign = part_on(&options, 2, 2, real(&other));
    let error = merge(vec![parts[0].clone(), foreign]).unwrap_err();
    assert_eq!(error.to_string(), "part 2: was run on another recording than part 1: merge the parts of one trial");
}

fn refused(parts: Vec<Part>) -> String {
    let error = merge(parts).unwrap_err();
    assert!(error.is_bad_input(), "{error}");
    error.to_string()
}

#[test]
fn what_is_not_all_parts_of_one_trial_each_once_is_refused() {
    let options = options(5, None);
    let [first, second, _] = of_three();
    assert!(refused(Vec::new()).contains("no part of a trial"));
    let missing = refused(vec![second.clone()]);
    assert!(missing.starts_with("parts 1, 3 of 3 missing: ") && missing.contains("--shard 1/3"), "{missing}");
    assert!(refused(vec![second.clone(), first.clone()]).starts_with("part 3 of 3 missing"));
    let doubled = refused(vec![second.clone(), first.clone(), second.clone()]);
    assert_eq!(doubled, "part 2: is part 2/3, as part 2 is: name each part once");
    let other = |options: TrialOptions, of| refused(vec![first.clone(), part_of(&options, 2, of)]);
    let seed = other(TrialOptions { seed: 8, ..options.clone() }, 3);
    assert_eq!(seed, "part 2: its seed is 8, that of part 1 is 5: merge the parts of one trial");
    assert!(other(TrialOptions { targets: Some(false), ..options.clone() }, 3).contains("its targets is false"));
    assert!(other(options, 2).contains("the number of its parts is 2, that of part 1 is 3"));
}

#[test]
fn a_part_that_is_not_what_a_job_has_left_is_refused() {
    let options = TrialOptions { shard: Some(Shard::new(1, 3).unwrap()), ..options(5, None) };
    let (answers, trial) = &OF_THREE[0];
    let refused = |answers: &str, trial: &str| {
        let error = Part::read("one", answers, trial).unwrap_err();
        assert!(error.is_bad_input());
        error.to_string()
    };
    let unopened = json(&BlindTrial::draw(options.clone(), None, || {}).unwrap().unopened());
    assert!(refused(answers, &unopened).starts_with("one: is not finished: run it again, with --shard 1/3"));
    assert!(refused(&answers.replace("\"world\": 0", "\"world\": 1"), trial).contains("that were sealed"));
    assert!(refused("{", trial).starts_with("one: answers.json cannot be read"));
    assert!(refused(answers, "[]").starts_with("one: trial.json cannot be read"));
    assert!(refused(answers, &AT_ONCE.1).contains("run without --shard"));
    assert!(refused(answers, &trial.replace("\"1/3\"", "\"2/3\"")).contains("results and answers do not fit"));
    let other = Part::read("two", answers, &trial.replace("\"version\": \"", "\"version\": \"9")).unwrap();
    let error = merge(vec![Part::read("one", answers, trial).unwrap(), other]).unwrap_err().to_string();
    assert!(error.starts_with("two: the version of its program is 9"), "{error}");
    let many = TrialOptions { shard: Some(Shard::new(1, 99).unwrap()), ..options };
    assert!(many.check().unwrap_err().to_string().contains("there are only 4 recordings"));
}
