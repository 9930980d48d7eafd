//! Lines of text.

/// A line and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Line<'a> {
    /// From 1.
    pub(crate) number: u32,
    /// Where it begins, bytes.
    pub(crate) offset: usize,
    /// Without its end.
    pub(crate) text: &'a str,
    /// Whether it has an end: only the last may lack one.
    pub(crate) is_ended: bool,
}

/// All lines, blank ones too, of a text as `decode` gives it: ended by `\n` or `\r\n`.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> + Clone {
    let mut after = 0;
    text.split_inclusive('\n').zip(1_u32..).map(move |(line, number)| {
        let offset = after;
        after += line.len();
        let text = line.trim_end_matches(['\n', '\r']);
        Line { number, offset, text, is_ended: line.ends_with('\n') }
    })
}

/// Whether a line without an end lost characters: fields, or decimals that the last field of the row before has.
pub(crate) fn is_cut(is_ended: bool, fields: usize, wanted: usize, last: &str, last_before: &str) -> bool {
    let decimals = |field: &str| field.rsplit_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
    !is_ended && (fields < wanted || decimals(last) < decimals(last_before))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_know_their_places() {
        let text = "a\r\n\nb\r\r\nc";
        let found: Vec<_> = lines(text).map(|line| (line.number, line.text, line.is_ended)).collect();
        assert_eq!(found, [(1, "a", true), (2, "", true), (3, "b", true), (4, "c", false)]);
        assert!(lines(text).all(|line| text[line.offset..].starts_with(line.text)));
    }

    #[test]
    fn a_cut_line_lacks_fields_or_decimals() {
        assert!(is_cut(false, 1, 2, "5", "5"));
        assert!(is_cut(false, 2, 2, "5.1", "5.12"));
        assert!(!is_cut(false, 2, 2, "5.12", "5.1"));
        assert!(!is_cut(true, 1, 2, "5", "5"));
    }
}
