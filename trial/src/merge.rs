//! Parts of a trial as one: equal to the bit to the trial that was run at once.

use serde_json::Value;

use crate::answer::Answer;
use crate::error::TrialError;
use crate::options::TrialOptions;
use crate::outcome::{Trial, Untouched};
use crate::part::Part;
use crate::reply::TrialResult;
use crate::seal::Sealed;

/// The whole of a trial.
#[derive(Clone, Debug)]
pub struct Merged {
    /// What `answers.json` holds.
    pub answers: String,
    /// What `trial.json` holds.
    pub trial: Trial,
}

/// Put the parts of a trial together, in whatever order they are.
///
/// # Errors
///
/// When they are not all the parts of one trial, each once.
pub fn merge(mut parts: Vec<Part>) -> Result<Merged, TrialError> {
    let first = parts.first().ok_or(TrialError::NoParts)?;
    parts.iter().try_for_each(|part| check_same_trial(first, part))?;
    parts.sort_by_key(|part| part.shard.number());
    check_complete(&parts)?;
    let options = parts[0].options();
    let untouched = untouched(&parts);
    let (answers, results) = in_order(parts);
    let sealed = Sealed::of(&answers);
    let trial = Trial::opened(&options, &sealed, untouched, results)?;
    Ok(Merged { answers: sealed.answers, trial })
}

fn check_same_trial(first: &Part, part: &Part) -> Result<(), TrialError> {
    let differs = |what: &str, of_part: String, of_first: String| TrialError::Part {
        name: part.name.clone(),
        what: format!("{what} is {of_part}, that of {} is {of_first}: merge the parts of one trial", first.name),
    };
    if let Some((key, of_part, of_first)) = first_difference(&part.options(), &first.options()) {
        return Err(differs(&format!("its {key}"), of_part, of_first));
    }
    let (of_part, of_first) = (part.shard.of(), first.shard.of());
    if of_part != of_first {
        return Err(differs("the number of its parts", of_part.to_string(), of_first.to_string()));
    }
    let version = |part: &Part| part.file.version.clone().unwrap_or_else(|| "not told".into());
    if version(part) != version(first) {
        return Err(differs("the version of its program", version(part), version(first)));
    }
    let on = |part: &Part| (part.file.on, part.file.untouched.as_ref().map(|reply| reply.json().to_owned()));
    match on(part) == on(first) {
        true => Ok(()),
        // The path is the same: what it names is not.
        false => {
            let what = format!("was run on another recording than {}: merge the parts of one trial", first.name);
            Err(TrialError::Part { name: part.name.clone(), what })
        }
    }
}

/// Name and values of the first option that is not the same.
fn first_difference(one: &TrialOptions, other: &TrialOptions) -> Option<(String, String, String)> {
    let of = |options: &TrialOptions| serde_json::to_value(options).unwrap_or_default();
    let (one, other) = (of(one), of(other));
    let keys = [&one, &other].into_iter().filter_map(Value::as_object).flat_map(|object| object.keys());
    let shown = |value: Option<&Value>| value.map_or_else(|| "not set".into(), Value::to_string);
    let mut differing = keys.filter(|key| one.get(key) != other.get(key));
    differing.next().map(|key| (key.clone(), shown(one.get(key)), shown(other.get(key))))
}

/// Each part once; they are sorted.
fn check_complete(parts: &[Part]) -> Result<(), TrialError> {
    if let Some([one, again]) = parts.array_windows().find(|[one, again]| one.shard == again.shard) {
        let what = format!("is part {}, as {} is: name each part once", again.shard, one.name);
        return Err(TrialError::Part { name: again.name.clone(), what });
    }
    let of = parts[0].shard.of();
    let is_there = |number: &usize| parts.binary_search_by_key(number, |part| part.shard.number()).is_ok();
    let missing: Vec<usize> = (1..=of).filter(|number| !is_there(number)).collect();
    if missing.is_empty() { Ok(()) } else { Err(TrialError::MissingParts { missing, of }) }
}

/// The same of every part, which has been checked.
fn untouched(parts: &[Part]) -> Option<Untouched> {
    let file = &parts[0].file;
    file.on.zip(file.untouched.clone()).map(|(on, said)| ([on.scalar_nt, on.fluxgate_nt], said))
}

fn in_order(parts: Vec<Part>) -> (Vec<Answer>, Vec<TrialResult>) {
    let pairs = parts.into_iter().flat_map(|part| part.answers.into_iter().zip(part.file.results));
    let mut pairs: Vec<(Answer, TrialResult)> = pairs.collect();
    pairs.sort_by_key(|(answer, _)| answer.index);
    pairs.into_iter().unzip()
}
