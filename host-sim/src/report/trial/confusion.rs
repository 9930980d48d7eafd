//! Which answer was given for what: a matrix, and a list of what was not right.

use std::collections::{BTreeMap, BTreeSet};

use towmag_trial::Score;

use crate::effects::{Library, Spec};
use crate::text::diagnosis as words;

/// What was hidden against what was said.
pub(super) struct Matrix {
    pub(super) said: Vec<String>,
    pub(super) rows: Vec<MatrixRow>,
}

pub(super) struct MatrixRow {
    pub(super) hidden: String,
    pub(super) of: usize,
    pub(super) cells: Vec<MatrixCell>,
}

pub(super) struct MatrixCell {
    pub(super) count: usize,
    /// Of the row, percent.
    pub(super) shade: usize,
    pub(super) is_right: bool,
}

/// An answer that was not right.
pub(super) struct Mistake {
    pub(super) hidden: String,
    pub(super) said: String,
}

/// An answer in a word: pairs have no row of their own, and several names are one column.
fn column(said: &str) -> String {
    let named: Vec<&str> = said.split(" + ").filter(|name| *name != "unknown").collect();
    match named[..] {
        [] => "unknown".into(),
        [name] => name.into(),
        _ => "several".into(),
    }
}

pub(super) fn matrix(score: &Score) -> Matrix {
    let rows: Vec<(&String, &BTreeMap<String, usize>)> =
        score.confusion.iter().filter(|(hidden, _)| !hidden.contains(" + ")).collect();
    let found: BTreeSet<String> = rows.iter().flat_map(|(_, said)| said.keys().map(|said| column(said))).collect();
    // Those of effects first, in the order of the rows.
    let last = ["none", "unknown", "several"];
    let mut said: Vec<String> = found.iter().filter(|name| !last.contains(&name.as_str())).cloned().collect();
    said.extend(last.iter().filter(|name| found.contains(**name)).map(|name| name.to_string()));
    let row = |(hidden, answers): &(&String, &BTreeMap<String, usize>)| {
        let of: usize = answers.values().sum();
        let right = right_answer(hidden);
        let cell = |name: &String| {
            let own = answers.iter().filter(|(answer, _)| column(answer) == *name);
            let count = own.map(|(_, count)| count).sum();
            MatrixCell { count, shade: 100 * count / of.max(1), is_right: *name == right }
        };
        MatrixRow { hidden: name_of(hidden), of, cells: said.iter().map(cell).collect() }
    };
    let rows = rows.iter().map(row).collect();
    Matrix { rows, said: said.iter().map(|name| name_of(name)).collect() }
}

/// What ought to be said.
fn right_answer(hidden: &str) -> String {
    let is_known = |name: &str| name == "none" || words::spec(&specs(), name).is_some();
    if hidden.split(" + ").all(is_known) { hidden.into() } else { "unknown".into() }
}

pub(super) fn mistakes(score: &Score) -> Vec<Mistake> {
    let mut all = Vec::new();
    for (hidden, answers) in &score.confusion {
        let right = right_answer(hidden);
        for (said, count) in answers.iter().filter(|(said, _)| **said != right) {
            let times = if *count > 1 { format!(" ({count} times)") } else { String::new() };
            all.push(Mistake { hidden: names(hidden), said: names(said) + &times });
        }
    }
    all
}

fn names(joined: &str) -> String {
    joined.split(" + ").map(name_of).collect::<Vec<String>>().join(" + ")
}

/// As it is written in every file: what a reader searches for.
pub(super) fn name_of(name: &str) -> String {
    match name {
        "none" => "no gap".into(),
        other => other.replace('_', " "),
    }
}

/// What is written about the effects of this program.
pub(super) fn specs() -> Vec<&'static Spec> {
    Library::default().specs().collect()
}
