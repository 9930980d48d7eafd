//! A field of text: a number, nothing, or something else.

use super::signs::Decimal;

/// What exports write where there is no value, in lower case.
const MISSING: [&str; 21] = [
    "", "*", "-", "--", "---", "?", "nan", "na", "n/a", "#n/a", "#nv", "null", "none", "missing", "inf", "-inf",
    "+inf", "1.#qnan", "-1.#ind", "1.#inf", "**",
];
/// A longer field is no number.
const LONGEST_NUMBER: usize = 48;

/// Whether a field says that there is no value.
pub(crate) fn is_missing(field: &str) -> bool {
    field.is_empty()
        || field.len() <= 8 && {
            let mut lower = [0; 8];
            let lower = &mut lower[..field.len()];
            lower.copy_from_slice(field.as_bytes());
            lower.make_ascii_lowercase();
            MISSING.iter().any(|missing| missing.as_bytes() == lower) || lower.iter().all(|byte| *byte == b'*')
        }
}

/// The number of a field with a decimal point: see [`parse_number`].
pub(crate) fn number(field: &str) -> Option<f64> {
    parse_number(field, Decimal::Point)
}

/// The finite number of a field; `None` when it is none, or stands for a missing one.
#[inline]
pub(crate) fn parse_number(field: &str, decimal: Decimal) -> Option<f64> {
    if decimal == Decimal::Point
        && let Ok(number) = fast_float2::parse::<f64, _>(field)
    {
        return Some(number).filter(|number| number.is_finite());
    }
    // The mark of the lines of a magnetometer: `$ 49895.131,1249`.
    let field = field.trim_start_matches('$').trim();
    if field.is_empty() || field.len() > LONGEST_NUMBER || !field.as_bytes().iter().any(u8::is_ascii_digit) {
        return None;
    }
    let plain = plain(field, decimal)?;
    fast_float2::parse::<f64, _>(&plain).ok().filter(|number| number.is_finite())
}

/// The same number as programs write it: a point, no groups of thousands, `e` for Fortran's `D`.
fn plain(field: &str, decimal: Decimal) -> Option<String> {
    let (point, group) = match decimal {
        Decimal::Point => ('.', ','),
        Decimal::Comma => (',', '.'),
    };
    let groups = |c: char| c == group || c == '\'' || c == ' ' || c == '\u{a0}' || c == '\u{202f}';
    let whole = field.split(point).next().unwrap_or_default();
    if whole.contains(groups) && !is_grouped(whole, groups) {
        return None;
    }
    let mut plain = String::with_capacity(field.len());
    for (at, c) in field.char_indices() {
        match c {
            _ if c == point => plain.push('.'),
            _ if at < whole.len() && groups(c) => {}
            'D' | 'd' => plain.push('e'),
            '\u{2212}' => plain.push('-'),
            _ => plain.push(c),
        }
    }
    Some(plain)
}

/// 51,384 and 1,051,384, not 5,1384.
fn is_grouped(whole: &str, groups: impl Fn(char) -> bool) -> bool {
    let digits = whole.trim_start_matches(['+', '-', '\u{2212}']);
    let mut parts = digits.split(groups);
    let first = parts.next().unwrap_or_default();
    let all_digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    all_digits(first) && first.len() <= 3 && parts.all(|part| part.len() == 3 && all_digits(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_countries() {
        for (field, decimal, number) in [
            ("51384.25", Decimal::Point, 51384.25),
            ("+5", Decimal::Point, 5.0),
            ("-.5", Decimal::Point, -0.5),
            ("5.", Decimal::Point, 5.0),
            ("1.5D+03", Decimal::Point, 1500.0),
            (" -2e3 ", Decimal::Point, -2000.0),
            ("$ 49895.131", Decimal::Point, 49895.131),
            ("51,384.25", Decimal::Point, 51384.25),
            ("51384,25", Decimal::Comma, 51384.25),
            ("51.384,25", Decimal::Comma, 51384.25),
            ("51 384,25", Decimal::Comma, 51384.25),
            ("\u{2212}12,5", Decimal::Comma, -12.5),
        ] {
            assert_eq!(parse_number(field, decimal), Some(number), "{field}");
        }
    }

    #[test]
    fn what_is_no_number() {
        for field in ["", "*", "nan", "inf", "1.5x", "12:30", "5,1384.2", "1.2.3", "leg 1", "e", "0x10", "1e999"] {
            assert_eq!(parse_number(field, Decimal::Point), None, "{field}");
        }
        assert_eq!(parse_number("1.5", Decimal::Comma), None, "neither a decimal nor a group of thousands");
    }

    #[test]
    fn missing_values_have_many_names() {
        assert!(["", "*", "******", "NaN", "N/A", "-", "NULL"].iter().all(|field| is_missing(field)));
        assert!(["0", "leg", "-5", "nanometre"].iter().all(|field| !is_missing(field)));
    }
}
