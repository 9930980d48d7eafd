//! Numbers with as many digits as mean something.

/// With so many digits behind the point; empty where it is not a number.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { format!("{value:.decimals$}") } else { String::new() }
}

/// Rounded to so many significant digits.
pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// With so many significant digits; empty where it is not a number.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value.is_finite() { zmij::Buffer::new().format(rounded(value, digits)).into() } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_asked_for() {
        assert_eq!([fixed(1.23456, 3), fixed(f64::NAN, 3), fixed(-0.5, 1)], ["1.235", "", "-0.5"]);
        assert_eq!(
            [significant(0.001234567, 3), significant(12345.6, 3), significant(f64::NAN, 3)],
            ["0.00123", "12300.0", ""]
        );
        assert_eq!(significant(1.23456e-12, 4), "1.235e-12");
    }
}
