//! Numbers as a person reads them: three significant digits, a true minus sign, powers of ten only when they help.

/// `value` with three significant digits, such as `12.1`, `0.430`, `48,200` or `−1.23 × 10⁻⁵`; a dash when it is not a number.
pub fn three_digits(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    // Rust rounds here, so that 9.996 is taken as 10.0 and not as 10.00.
    let scientific = format!("{value:.2e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let text = match exponent {
        _ if value == 0.0 => "0".into(),
        -3..=1 => format!("{value:.*}", (2 - exponent) as usize),
        2..=5 => thousands(value, exponent),
        _ => format!("{mantissa} × 10{}", superscript(exponent)),
    };
    text.replace('-', "−")
}

/// Three digits without zeros that say nothing: `0.25` for 0.250.
pub fn short(value: f64) -> String {
    let text = three_digits(value);
    match text.contains('.') && !text.contains('×') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

/// A whole number with three significant digits and commas.
fn thousands(value: f64, exponent: i32) -> String {
    let unit = 10_f64.powi(exponent - 2);
    group(((value / unit).round() * unit) as i64)
}

/// `value` with a comma before every third digit.
pub fn group(value: i64) -> String {
    let digits = value.unsigned_abs().to_string();
    let mut text = String::from(if value < 0 { "−" } else { "" });
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

fn superscript(exponent: i32) -> String {
    let digit = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        c => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
    };
    exponent.to_string().chars().map(digit).collect()
}

/// `value` rounded to `decimals`: keeps digits that nobody can see out of the page.
pub(crate) fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_that_say_nothing_are_left_out() {
        assert_eq!([0.005, 0.25, 1.5, 20.0, 0.0916, 100.0].map(short), ["0.005", "0.25", "1.5", "20", "0.0916", "100"]);
    }

    #[test]
    fn three_digits_everywhere() {
        for (value, text) in [
            (12.149, "12.1"),
            (0.43, "0.430"),
            (9.996, "10.0"),
            (-0.00123, "−0.00123"),
            (999.6, "1,000"),
            (123.4, "123"),
            (48_213.0, "48,200"),
            (-1.234e-5, "−1.23 × 10⁻⁵"),
            (4.56e12, "4.56 × 10¹²"),
            (0.0, "0"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(three_digits(value), text);
        }
    }

    #[test]
    fn commas_every_third_digit() {
        assert_eq!([0, 999, 1_000, -1_234_567].map(group), ["0", "999", "1,000", "−1,234,567"]);
    }
}
