//! `host-sim trial` on a handful of short recordings.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use host_sim::command;
use towmag_trial::{Answer, Kind, Shard, Trial, TrialOptions, seal};

fn run(folder: &Path, name: &str, options: &TrialOptions) -> (Trial, Vec<Answer>) {
    let out = folder.join(name);
    let mut told = String::new();
    let trial = command::trial(&out, options, |sha256| {
        let sealed: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(out.join("trial.json")).unwrap()).unwrap();
        assert_eq!((sealed["answers_sha256"].as_str(), sealed["score"].is_null()), (Some(sha256), true));
        told = sha256.into();
    })
    .unwrap();
    let answers = std::fs::read_to_string(out.join("answers.json")).unwrap();
    assert_eq!((seal(&answers), &trial.answers_sha256), (told.clone(), &told));
    (trial, serde_json::from_str(&answers).unwrap())
}

fn options(withhold: Option<&str>) -> TrialOptions {
    TrialOptions {
        recordings: 4,
        seed: 5,
        minutes: Some(2.0),
        withhold: withhold.map(String::from),
        ..TrialOptions::default()
    }
}

/// Three recordings that are kept.
fn of_three() -> TrialOptions {
    TrialOptions { recordings: 3, keep: true, ..options(None) }
}

/// A trial of [`of_three`], and the folder that it is in.
struct Whole {
    folder: PathBuf,
    trial: Trial,
    answers: Vec<Answer>,
}

/// Made once for all tests that only read it.
fn whole() -> &'static Whole {
    static WHOLE: LazyLock<Whole> = LazyLock::new(|| {
        // A temporary folder would stay, as nothing drops what is made once.
        let here = Path::new(env!("CARGO_TARGET_TMPDIR")).join("trial");
        let _ = std::fs::remove_dir_all(&here);
        let (trial, answers) = run(&here, "whole", &of_three());
        Whole { folder: here.join("whole"), trial, answers }
    });
    &WHOLE
}

#[test]
fn the_score_is_of_what_was_hidden_and_the_answers_are_sealed_first() {
    let Whole { trial, answers, .. } = whole();
    let score = trial.score.as_ref().unwrap();
    let clean = answers.iter().filter(|answer| answer.kind == Kind::None).count();
    assert_eq!(score.false_alarms.of, clean);
    let groups = [&score.false_alarms_by_noise, &score.false_alarms_by_motion, &score.false_alarms_by_recorder];
    assert!(groups.iter().all(|group| group.values().map(|rate| rate.of).sum::<usize>() == clean));
    assert_eq!(score.confusion.values().flat_map(|said| said.values()).sum::<usize>(), 3);
    assert!(host_sim::text::trial::text(score).contains("False alarms"));
}

#[test]
fn a_withheld_effect_is_all_that_singles_hide_and_is_put_back() {
    let folder = tempfile::tempdir().unwrap();
    let (trial, answers) = run(folder.path(), "out", &options(Some("mains_alias")));
    for (answer, said) in answers.iter().zip(&trial.results) {
        let has = answer.hidden.iter().any(|hidden| hidden.name == "mains_alias");
        assert!(has || answer.kind != Kind::Single);
        assert_eq!(said.put_back.is_some(), has);
        assert!(said.diagnosis.said().effects.iter().all(|effect| effect.name != "mains_alias"));
    }
}

#[test]
fn what_cannot_be_tried_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |options: TrialOptions| {
        let error = command::trial(&folder.path().join("out"), &options, |_| {}).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(!folder.path().join("out").exists());
    };
    refused(TrialOptions { recordings: 0, ..options(None) });
    refused(TrialOptions { minutes: Some(0.5), ..options(None) });
    refused(options(Some("gremlins")));
}

#[test]
fn recordings_that_are_kept_are_those_that_were_diagnosed() {
    let folder = tempfile::tempdir().unwrap();
    let Whole { folder: out, trial, .. } = whole();
    let kept = out.join("recordings/001.csv");
    let again = folder.path().join("again");
    let settings = command::DiagnoseOptions { seed: of_three().seed, ..Default::default() };
    command::diagnose(&kept, &again, &settings).unwrap();
    let read =
        |path: PathBuf| -> serde_json::Value { serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap() };
    let (mut diagnosis, told) = (read(again.join("diagnosis.json")), read(out.join("trial.json")));
    // The trial's own was made of no file.
    let provenance = diagnosis.as_object_mut().unwrap().remove("provenance").unwrap();
    assert_eq!(provenance["inputs"][0]["file"], "001.csv");
    let (of_trial, of_file) =
        (trial.results[1].diagnosis.json(), std::fs::read_to_string(again.join("diagnosis.json")).unwrap());
    assert!(of_file.starts_with(of_trial.trim_end().trim_end_matches('}').trim_end()), "the same bytes before it");
    assert_eq!(told["results"][1]["diagnosis"], diagnosis);
    assert!(std::fs::read_to_string(out.join("report.html")).unwrap().contains("figures that it is held to"));
}

#[test]
fn effects_put_into_a_recording_are_scored_against_the_untouched_one() {
    let folder = tempfile::tempdir().unwrap();
    let on = Some(whole().folder.join("recordings/000.csv"));
    let (trial, answers) = run(folder.path(), "on", &TrialOptions { on, recordings: 2, keep: true, ..options(None) });
    let score = trial.on.unwrap();
    assert!(trial.score.is_none() && trial.untouched.is_some() && !score.untouched.is_empty());
    assert_eq!(score.named.iter().map(|bin| bin.named.of).sum::<usize>(), answers.len());
    assert!(host_sim::text::trial::text_on(&score).contains("newly named"));
    for answer in &answers {
        let kept = folder.path().join(format!("on/recordings/{:03}.csv", answer.index));
        assert!(std::fs::read_to_string(kept).unwrap().lines().count() > 1000);
    }
}

#[test]
fn bad_rows_of_a_recording_are_left_out_unless_strict() {
    let folder = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(whole().folder.join("recordings/000.csv")).unwrap();
    let mut lines: Vec<&str> = good.lines().collect();
    let (twice, spoilt) = (lines[300], lines[500].replacen(',', ",*", 1));
    lines[500] = &spoilt;
    lines.insert(301, twice);
    let recording = folder.path().join("spoilt.csv");
    std::fs::write(&recording, lines.join("\n") + "\n").unwrap();
    let on = TrialOptions { on: Some(recording), recordings: 1, keep: true, ..options(None) };
    let (trial, _) = run(folder.path(), "on", &on);
    assert!(trial.untouched.is_some());
    let kept = std::fs::read_to_string(folder.path().join("on/recordings/000.csv")).unwrap();
    assert_eq!(kept.lines().count(), good.lines().count(), "without the row that is there twice");
    assert!(!kept.contains('*'));
    let strict = command::trial(&folder.path().join("strict"), &TrialOptions { strict: true, ..on }, |_| {});
    assert!(strict.unwrap_err().to_string().contains("spoilt.csv:302: time_s: "));
}

/// What was made apart has the same bytes: of the seed alone comes all that there is.
#[test]
fn a_trial_in_three_jobs_is_merged_to_the_files_of_one() {
    let folder = tempfile::tempdir().unwrap();
    let part = |number: usize| {
        let name = format!("part{number}");
        run(folder.path(), &name, &TrialOptions { shard: Some(Shard::new(number, 3).unwrap()), ..of_three() });
        folder.path().join(name)
    };
    let [first, second, third] = [1, 2, 3].map(part);
    let out = folder.path().join("merged");
    let refused = command::merge_trial(&[third.clone(), first.clone()], &out).unwrap_err();
    assert!(refused.exit_code() == 2 && refused.to_string().contains("--shard 2/3"), "{refused}");
    let onto_a_part = command::merge_trial(&[third.clone(), first.clone(), second.clone()], &second).unwrap_err();
    assert!(onto_a_part.exit_code() == 2 && !out.exists(), "{onto_a_part}");
    command::merge_trial(&[third, first, second], &out).unwrap();
    let files = ["answers.json", "trial.json", "report.html", ".host-sim"].map(String::from);
    for file in files.into_iter().chain((0..3).map(|index| format!("recordings/{index:03}.csv"))) {
        let read = |of: &Path| std::fs::read(of.join(&file)).unwrap();
        assert!(read(&whole().folder) == read(&out), "{file}");
    }
}
