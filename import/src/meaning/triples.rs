//! Vectors among the columns: three names that differ in one letter.

use super::columns::told_unit;
use super::names::normalised;
use crate::source::SourceColumn;
use crate::units::Dimension;

/// Three columns that look like a vector.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Triple {
    /// What their names have in common.
    pub(super) prefix: String,
    /// Where they are, in the order x, y, z.
    pub(super) at: [usize; 3],
    /// How likely it is a magnetic one; 0: it is none.
    pub(super) score: u32,
}

const LETTERS: [[char; 3]; 3] = [['x', 'y', 'z'], ['u', 'v', 'w'], ['1', '2', '3']];
/// Names of fluxgates.
const FLUXGATES: [&str; 4] = ["flux", "fluxgate", "fgm", "vector"];
/// Words of names of what is a vector too, but none of the field.
const OTHERS: [&str; 13] =
    ["acc", "gyro", "vel", "pos", "utm", "ecef", "rate", "ang", "coord", "grid", "std", "force", "wind"];

/// All of them, the most likely one first; of equals the first in the file.
pub(super) fn find(columns: &[SourceColumn]) -> Vec<Triple> {
    let names: Vec<String> = columns.iter().map(|column| normalised(&column.name)).collect();
    let mut triples: Vec<Triple> = Vec::new();
    for (at, name) in names.iter().enumerate() {
        for letters in LETTERS {
            let found = triple(&names, at, name, letters).filter(|triple| all_numbers(columns, triple));
            if let Some(mut triple) = found
                && triples.iter().all(|there| there.at != triple.at)
            {
                triple.score = score(&columns[at], name, &triple.prefix);
                triples.push(triple);
            }
        }
    }
    triples.sort_by_key(|triple| std::cmp::Reverse(triple.score));
    triples
}

/// The triple whose first name this is: its letter stands at the end or the beginning of a word.
fn triple(names: &[String], at: usize, name: &str, letters: [char; 3]) -> Option<Triple> {
    name.char_indices().rev().filter(|(_, c)| *c == letters[0]).find_map(|(place, c)| {
        let (before, after) = (&name[..place], &name[place + c.len_utf8()..]);
        let is_end = after.is_empty() || after.starts_with('_');
        let is_begin = before.is_empty() || before.ends_with('_');
        if !is_end && !is_begin {
            return None;
        }
        let other = |letter: char| {
            let wanted = format!("{before}{letter}{after}");
            names.iter().position(|name| *name == wanted)
        };
        let prefix = before.trim_end_matches('_');
        // Numbers count sensors as often as axes: only a fluxgate's are axes for sure.
        if letters[0] == '1' && !FLUXGATES.contains(&prefix) {
            return None;
        }
        let prefix = if prefix.is_empty() { after.trim_start_matches('_') } else { prefix };
        Some(Triple { prefix: prefix.to_string(), at: [at, other(letters[1])?, other(letters[2])?], score: 0 })
    })
}

fn all_numbers(columns: &[SourceColumn], triple: &Triple) -> bool {
    triple.at.iter().all(|&at| columns[at].as_numbers().is_some())
}

fn score(column: &SourceColumn, name: &str, prefix: &str) -> u32 {
    if OTHERS.iter().any(|other| name.contains(other)) {
        return 0;
    }
    let unit = match told_unit(column).map(|unit| unit.dimension) {
        Some(Dimension::Field) => 30,
        Some(Dimension::Number) | None => 0,
        Some(_) => return 0,
    };
    let word = if column.name.starts_with("flux_x_nT") {
        100
    } else if FLUXGATES.iter().any(|word| prefix.starts_with(word)) {
        60
    } else if ["mag", "vm", "fg", "vec", "b", "bfield", "field"].iter().any(|word| prefix.starts_with(word)) {
        40
    } else if prefix.contains("compass") {
        5
    } else if prefix.is_empty() {
        10
    } else {
        2
    };
    unit + word
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(names: &[&str]) -> Vec<(String, [usize; 3])> {
        let columns: Vec<_> = names.iter().map(|name| SourceColumn::numbers(*name, vec![1.0])).collect();
        find(&columns).into_iter().filter(|triple| triple.score > 0).map(|t| (t.prefix, t.at)).collect()
    }

    #[test]
    fn letters_may_stand_anywhere_at_the_edge_of_a_word() {
        assert_eq!(found(&["t", "flux_b_x", "flux_b_y", "flux_b_z"])[0], ("flux_b".into(), [1, 2, 3]));
        assert_eq!(found(&["B1z", "B1y", "B1x"])[0], ("b1".into(), [2, 1, 0]));
        assert_eq!(found(&["XMag", "YMag", "ZMag"])[0].1, [0, 1, 2]);
        assert_eq!(found(&["LLOU", "LLOV", "LLOW"])[0].1, [0, 1, 2]);
        assert_eq!(found(&["X", "Y", "Z"])[0].1, [0, 1, 2]);
        assert_eq!(found(&["flux_x_nT", "flux_y_nT", "flux_z_nT"])[0].1, [0, 1, 2]);
    }

    #[test]
    fn the_likeliest_comes_first_and_others_are_none() {
        let names = ["CompassX", "CompassY", "CompassZ", "GyroX", "GyroY", "GyroZ", "flux_a_x", "flux_a_y", "flux_a_z"];
        let triples = found(&names);
        assert_eq!(triples.iter().map(|(prefix, _)| prefix.as_str()).collect::<Vec<_>>(), ["flux_a", "compass"]);
        assert!(found(&["max", "may", "maz_1"]).is_empty());
    }
}
