//! Which answer was given for what.

use std::collections::BTreeMap;

use super::Pair;
use crate::diagnosis::Verdict;
use crate::trial::Kind;

pub(super) fn of(all: &[Pair<'_>]) -> BTreeMap<String, BTreeMap<String, usize>> {
    let joined = |mut names: Vec<&str>| {
        names.sort_unstable();
        names.join(" + ")
    };
    let mut table: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for (answer, said) in all {
        let hidden = match answer.kind {
            Kind::None => "none".into(),
            _ => joined(answer.hidden.iter().map(|hidden| hidden.name.as_str()).collect()),
        };
        let diagnosis = &said.diagnosis;
        let answered = match diagnosis.verdict {
            Verdict::NoGap => "none".into(),
            Verdict::Unknown => "unknown".into(),
            verdict => {
                let rest = if verdict == Verdict::PartlyExplained { " + unknown" } else { "" };
                joined(diagnosis.effects.iter().map(|effect| effect.name).collect()) + rest
            }
        };
        *table.entry(hidden).or_default().entry(answered).or_default() += 1;
    }
    table
}
