//! Which functions of the image can panic, against the list of those that may: `firmware/panics.toml`.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, bail};

use super::calls::{Image, Number};
use crate::repository;

/// Where every panic of a Rust program ends.
pub(super) const END: &str = "core::panicking::panic_fmt";

/// The ways there. What calls them contains the place that panics.
const WAYS: [&str; 6] = [
    "core::panicking::",
    "core::cell::panic_already",
    "core::option::unwrap_failed",
    "core::option::expect_failed",
    "core::result::unwrap_failed",
    "core::slice::index::slice_index_fail",
];

/// The list of those that may, from the root of the repository.
const LIST: &str = "firmware/panics.toml";

/// Function, and the kinds of panic in it.
type Panics = BTreeMap<String, BTreeSet<String>>;

/// An entry of the list.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    function: String,
    kinds: BTreeSet<String>,
    /// Why it may stay.
    reason: String,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    #[serde(default)]
    may: Vec<Entry>,
}

/// Fail where the image and the list differ, and say in what.
pub fn check() -> anyhow::Result<()> {
    let image = super::image()?;
    let found = panics(&image)?;
    let text = repository::text(LIST).with_context(|| format!("{LIST} is not there"))?;
    let list: List = toml::from_str(&text).context(LIST)?;
    if let Some(entry) = list.may.iter().find(|entry| entry.reason.trim().is_empty()) {
        bail!("{LIST}: {} has no reason", entry.function);
    }
    let allowed = list.may.into_iter().map(|entry| (entry.function, entry.kinds)).collect();
    let complaints = differences(&found, &allowed);
    if !complaints.is_empty() {
        bail!("the image and {LIST} differ:\n{}", complaints.join("\n"));
    }
    println!("{} functions of the image can panic, each with its reason in {LIST}", found.len());
    Ok(())
}

fn panics(image: &Image) -> anyhow::Result<Panics> {
    image.named(END).context("no function of the image panics: it is not the one that is meant")?;
    let mut found = Panics::new();
    for function in image.functions.iter().filter(|function| !is_way(&function.name)) {
        let kinds = function.calls.iter().filter_map(|callee: &Number| kind(&image.functions[*callee].name));
        for kind in kinds {
            found.entry(function.name.clone()).or_default().insert(kind.to_string());
        }
    }
    Ok(found)
}

pub(super) fn is_way(name: &str) -> bool {
    WAYS.iter().any(|way| name.starts_with(way))
}

/// How a way is called in the list.
fn kind(name: &str) -> Option<&str> {
    let without_types = is_way(name).then(|| name.split("::<").next()).flatten()?;
    without_types.rsplit("::").next()
}

fn differences(found: &Panics, allowed: &Panics) -> Vec<String> {
    let shown = |kinds: &BTreeSet<String>| kinds.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
    let mut complaints = Vec::new();
    for (function, kinds) in found {
        match allowed.get(function) {
            Some(may) if may == kinds => {}
            Some(may) => complaints.push(format!("  {function}: {}, in the list {}", shown(kinds), shown(may))),
            None => complaints.push(format!("  {function}: {}, not in the list", shown(kinds))),
        }
    }
    let gone = allowed.keys().filter(|function| !found.contains_key(*function));
    complaints.extend(gone.map(|function| format!("  {function}: in the list, but it no longer panics")));
    complaints
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panics_of(entries: &[(&str, &str)]) -> Panics {
        let mut panics = Panics::new();
        for (function, kind) in entries {
            panics.entry((*function).into()).or_default().insert((*kind).into());
        }
        panics
    }

    #[test]
    fn what_is_new_changed_or_gone_is_told() {
        let found = panics_of(&[("a", "panic"), ("b", "unwrap_failed")]);
        assert!(differences(&found, &found).is_empty());
        let listed = panics_of(&[("b", "panic"), ("c", "panic")]);
        let told = differences(&found, &listed);
        assert_eq!(told.len(), 3, "{told:?}");
    }

    #[test]
    fn a_kind_is_the_last_of_its_name() {
        assert_eq!(kind("core::panicking::panic_const::panic_const_div_by_zero"), Some("panic_const_div_by_zero"));
        assert_eq!(kind("core::panicking::assert_failed::<u64, u64>"), Some("assert_failed"));
        assert_eq!(kind("core::option::Option::map"), None);
    }
}
