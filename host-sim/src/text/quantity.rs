//! A value with its unit and interval, with as many digits as the interval bears.

/// `51 ms (48 to 54)`. Units are those of [`Parameter`](crate::effects::Parameter); short times are in ms.
pub(super) fn quantity(value: f64, ci95: Option<[f64; 2]>, unit: &str) -> String {
    let ends = ci95.unwrap_or([value, value]);
    let largest = ends.iter().fold(value.abs(), |largest, end| largest.max(end.abs()));
    let (scale, unit) = match unit {
        "s" if largest < 1.0 => (1000.0, "ms"),
        "deg" => (1.0, "°"),
        "nT/K" => (1.0, "nT/K"),
        other => (1.0, other),
    };
    let decimals = decimals(scale * (ends[1] - ends[0]), scale * largest);
    let text = |value: f64| fixed(scale * value, decimals);
    let space = if unit.is_empty() || unit == "°" { "" } else { " " };
    let value = format!("{}{space}{unit}", text(value));
    match ci95 {
        Some([low, high]) => format!("{value} ({} to {})", text(low), text(high)),
        None => value,
    }
}

/// Decimals that show one digit of half the interval; three digits of the value where it has no width.
fn decimals(width: f64, largest: f64) -> usize {
    let digits_of = if width > 0.0 { 0.5 * width } else { 0.01 * largest };
    // A width of a tenth is one decimal, whatever its last bit says.
    let exponent = (digits_of.log10() + 1e-6).floor();
    if exponent.is_finite() { (-exponent).clamp(0.0, 9.0) as usize } else { 0 }
}

fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = !text.contains(|c: char| ('1'..='9').contains(&c));
    if is_zero { text.replace('-', "") } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_interval() {
        assert_eq!(quantity(0.051_23, Some([0.048_1, 0.054_2]), "s"), "51 ms (48 to 54)");
        assert_eq!(quantity(0.05, Some([0.0499, 0.0501]), "s"), "50.0 ms (49.9 to 50.1)");
        assert_eq!(quantity(-1.5, Some([-1.9, -1.1]), "nT"), "−1.5 nT (−1.9 to −1.1)");
        assert_eq!(quantity(300.0, Some([299.95, 300.05]), "s"), "300.00 s (299.95 to 300.05)");
        assert_eq!(quantity(12.0, Some([-8.0, 32.0]), "deg"), "12° (−8 to 32)");
        assert_eq!(quantity(0.021, Some([0.018, 0.024]), ""), "0.021 (0.018 to 0.024)");
        assert_eq!(quantity(2.0, None, "nT"), "2.00 nT");
        assert_eq!(quantity(0.0, Some([0.0, 0.0]), "samples"), "0 samples (0 to 0)");
        assert_eq!(quantity(-0.001, Some([-2.0, 2.0]), "nT"), "0 nT (−2 to 2)");
    }
}
