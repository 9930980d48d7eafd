//! `host-sim trial`: a blind trial of the diagnosis.

use std::io::Write;
use std::path::Path;

use crate::diagnosis::Table;
use crate::effects::Library;
use crate::error::HostError;
use crate::output::{OutputError, OutputFile};
use crate::report::render_trial;
use crate::summary::to_json;
use crate::trial::{self, Trial, TrialOptions};

/// Shortest recording of a trial, minutes.
const LEAST_MINUTES: f64 = 2.0;
/// Longest, minutes.
const MOST_MINUTES: f64 = 120.0;

/// Draw and seal, diagnose, open and score. `sealed` is told the hash before the first diagnosis begins.
pub fn trial(out: &Path, options: &TrialOptions, sealed: impl FnOnce(&str)) -> Result<Trial, HostError> {
    check(options)?;
    let table = options.on.as_deref().map(Table::read).transpose()?;
    let on = table.as_ref();
    let answers = trial::draw(options, on);
    let mut trial = Trial {
        schema: 1,
        options: options.clone(),
        answers_sha256: answers.sha256.clone(),
        score: None,
        on: None,
        untouched: None,
        results: Vec::new(),
    };
    let made = |source| HostError::from(OutputError::Io { path: out.into(), source });
    std::fs::create_dir_all(out).map_err(made)?;
    write(&out.join("answers.json"), &answers.answers)?;
    write(&out.join("trial.json"), &to_json(&trial))?;
    sealed(&answers.sha256);
    if options.keep {
        let folder = out.join("recordings");
        std::fs::create_dir_all(&folder).map_err(made)?;
        trial::recordings(options, on, &answers, |index, csv| write(&folder.join(format!("{index:03}.csv")), csv))?;
    }
    trial::diagnose_all(options, on, &answers, &mut trial)?;
    trial::score(options, on, &answers, &mut trial)?;
    write(&out.join("report.html"), &render_trial(&trial)?)?;
    write(&out.join("trial.json"), &to_json(&trial))?;
    Ok(trial)
}

fn check(options: &TrialOptions) -> Result<(), HostError> {
    if options.recordings == 0 {
        return Err(HostError::Usage("--recordings 0: choose at least 1".into()));
    }
    if !(LEAST_MINUTES..=MOST_MINUTES).contains(&options.minutes) {
        let minutes = options.minutes;
        return Err(HostError::Usage(format!("--minutes {minutes}: choose {LEAST_MINUTES} to {MOST_MINUTES}")));
    }
    match &options.withhold {
        Some(name) if Library::default().spec(name).is_none() => {
            Err(HostError::Usage(format!("--withhold {name}: no such effect; docs/scenarios.md lists them")))
        }
        _ => Ok(()),
    }
}

fn write(path: &Path, text: &str) -> Result<(), HostError> {
    let mut file = OutputFile::create(path)?;
    file.write_all(text.as_bytes()).map_err(|source| OutputError::Io { path: path.into(), source })?;
    Ok(file.commit()?)
}
