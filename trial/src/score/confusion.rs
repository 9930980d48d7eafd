//! Which answer was given for what.

use std::collections::BTreeMap;

use super::judged::Judged;
use crate::answer::Kind;
use crate::said::Verdict;

pub(super) fn of(all: &[Judged<'_>]) -> BTreeMap<String, BTreeMap<String, usize>> {
    let joined = |mut names: Vec<&str>| {
        names.sort_unstable();
        names.join(" + ")
    };
    let mut table: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for (answer, result) in all {
        let hidden = match answer.kind {
            Kind::None => "none".into(),
            _ => joined(answer.hidden.iter().map(|hidden| hidden.name.as_str()).collect()),
        };
        let said = result.diagnosis.said();
        let answered = match said.verdict {
            Verdict::NoGap => "none".into(),
            Verdict::Unknown => "unknown".into(),
            verdict => {
                let rest = if verdict == Verdict::PartlyExplained { " + unknown" } else { "" };
                joined(said.effects.iter().map(|effect| effect.name.as_str()).collect()) + rest
            }
        };
        *table.entry(hidden).or_default().entry(answered).or_default() += 1;
    }
    table
}
