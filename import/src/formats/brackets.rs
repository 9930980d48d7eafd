//! Units in brackets behind a name: `Time [s]`, `Flux X (nT)`.

/// The name, and the unit if one stands behind it.
pub(super) fn split_unit(header: &str) -> (String, Option<String>) {
    let header = header.trim();
    let inner = [('(', ')'), ('[', ']'), ('{', '}')].into_iter().find_map(|(open, close)| {
        let (name, unit) = header.strip_suffix(close)?.rsplit_once(open)?;
        Some((name.trim(), unit.trim())).filter(|(name, unit)| !name.is_empty() && !unit.is_empty())
    });
    match inner {
        Some((name, unit)) => (name.into(), Some(unit.into())),
        None => (header.into(), None),
    }
}

#[cfg(test)]
mod tests {
    use super::split_unit;

    #[test]
    fn a_unit_is_what_stands_in_brackets_at_the_end() {
        assert_eq!(split_unit(" Time [s] "), ("Time".into(), Some("s".into())));
        assert_eq!(split_unit("Flux (x) (nT)"), ("Flux (x)".into(), Some("nT".into())));
        assert_eq!(split_unit("mag"), ("mag".into(), None));
        assert_eq!(split_unit("(nT)"), ("(nT)".into(), None));
        assert_eq!(split_unit("a ()"), ("a ()".into(), None));
    }
}
