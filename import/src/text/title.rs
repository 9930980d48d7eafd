//! Titles of columns: a name, and behind it a unit in brackets.

use super::cell::number;
use crate::units;

/// No title has more brackets that could hold its unit.
const MOST_BRACKETS: usize = 4;

/// A name without its unit, and the unit: what stands in brackets and is known as one, else what stands in brackets at the end.
/// `EM[0]` is an element of an array.
pub(crate) fn name_and_unit(title: &str) -> (String, Option<String>) {
    let title = title.trim();
    let rest = |begin: usize, end: usize| {
        format!("{} {}", title[..begin].trim_end(), title[end..].trim_start()).trim().to_string()
    };
    let whole = |(begin, _, end): &(usize, &str, usize)| *begin == 0 && *end == title.len();
    let is_element = |inner: &str| number(inner).is_some();
    let mut pieces = bracketed(title).filter(|piece| !whole(piece) && !is_element(piece.1));
    let known = pieces.clone().find(|(_, inner, _)| units::is_unit(inner));
    if let Some((begin, inner, end)) = known.or_else(|| pieces.find(|(_, _, end)| *end == title.len())) {
        return (rest(begin, end), Some(inner.to_string()).filter(|unit| !unit.is_empty()));
    }
    let bare = bracketed(title).find(whole).map(|(_, inner, _)| inner).filter(|inner| !inner.is_empty());
    (bare.unwrap_or(title).to_string(), None)
}

/// What stands in brackets, the last first: where it begins, what it is, where it ends.
fn bracketed(title: &str) -> impl Iterator<Item = (usize, &str, usize)> + Clone {
    let closed = title.char_indices().rev().filter_map(|(at, c)| {
        let pairs = [('(', ')'), ('[', ']'), ('{', '}')];
        pairs.into_iter().find(|(_, close)| *close == c).map(|(open, _)| (at, open))
    });
    closed.take(MOST_BRACKETS).filter_map(|(at, open)| {
        let begin = title[..at].rfind(open)?;
        Some((begin, title[begin + 1..at].trim(), at + 1))
    })
}

#[cfg(test)]
mod tests {
    use super::name_and_unit;

    #[test]
    fn names_come_without_their_units() {
        for (title, name, unit) in [
            ("B1x [nT]", "B1x", Some("nT")),
            (" Mag{nT} ", "Mag", Some("nT")),
            ("Depth(m)", "Depth", Some("m")),
            ("GPSTime [hh:mm:ss.sss]", "GPSTime", Some("hh:mm:ss.sss")),
            ("Flux (x) (nT)", "Flux (x)", Some("nT")),
            ("B [nT] raw", "B raw", Some("nT")),
            ("latitude(d'\")", "latitude", Some("d'\"")),
            ("mag", "mag", None),
            ("(mag)", "mag", None),
            ("a ()", "a", None),
            ("EM[0]", "EM[0]", None),
            ("EM[1] (nT)", "EM[1]", Some("nT")),
            ("()", "()", None),
            ("", "", None),
        ] {
            assert_eq!(name_and_unit(title), (name.to_string(), unit.map(str::to_string)), "{title}");
        }
    }
}
