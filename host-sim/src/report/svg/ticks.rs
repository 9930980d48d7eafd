//! Where an axis has its labels.

use crate::text::clock;

/// Steps of clock time that a person counts in, s.
const CLOCK_STEPS_S: [f64; 14] =
    [1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0, 3600.0, 7200.0, 21_600.0];

/// The largest of 1, 2 and 5 times a power of ten that is not above `step`.
pub(in crate::report) fn round_step(step: f64) -> f64 {
    let power = 10_f64.powi(step.log10().floor() as i32);
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * power <= step * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * power
}

/// Round values from `low` to `high`, at most `most` and at least half as many less one, each with its text.
pub(super) fn numbers(low: f64, high: f64, most: usize) -> Vec<(f64, String)> {
    let least = (high - low) / most as f64;
    if !(least > 0.0 && least.is_finite()) {
        return Vec::new();
    }
    let down = round_step(least);
    let step = [down, 2.0 * down, 2.5 * down].into_iter().find(|step| round_step(*step) >= least).unwrap_or(5.0 * down);
    let step = round_step(step);
    let decimals = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    multiples(low, high, step).map(|value| (value, number(value, decimals))).collect()
}

/// Round clock times; `offset_s` makes seconds since 1970 of a value on the axis.
pub(super) fn clocks(low: f64, high: f64, offset_s: f64, most: usize) -> Vec<(f64, String)> {
    let least = (high - low) / most as f64;
    let step = CLOCK_STEPS_S.into_iter().find(|step| *step >= least).unwrap_or(86_400.0);
    let text = |utc_s: f64| if step < 60.0 { clock::seconds(utc_s) } else { clock::minutes(utc_s) };
    multiples(low + offset_s, high + offset_s, step).map(|utc_s| (utc_s - offset_s, text(utc_s))).collect()
}

fn multiples(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil(), (high / step + 1e-9).floor());
    let count = if (last - first).is_finite() && last >= first { (last - first) as usize + 1 } else { 0 };
    (0..count.min(100)).map(move |k| (first + k as f64) * step)
}

fn number(value: f64, decimals: usize) -> String {
    let whole = if value == 0.0 { 0.0 } else { value }; // no minus before a zero
    if decimals == 0 {
        crate::text::number::group(whole.round() as i64)
    } else {
        format!("{whole:.decimals$}").replace('-', "−")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(ticks: Vec<(f64, String)>) -> Vec<String> {
        ticks.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn numbers_are_round_and_few() {
        assert_eq!(texts(numbers(-7.0, 12.0, 5)), ["−5", "0", "5", "10"]);
        assert_eq!(texts(numbers(49_987.0, 50_031.0, 5)), ["49,990", "50,000", "50,010", "50,020", "50,030"]);
        assert_eq!(texts(numbers(0.0, 0.05, 5)), ["0.00", "0.01", "0.02", "0.03", "0.04", "0.05"][..].to_vec());
        assert!(numbers(1.0, 1.0, 5).is_empty() && numbers(0.0, f64::NAN, 5).is_empty());
        for k in 1..200 {
            let found = numbers(0.3, 0.3 + 0.37 * f64::from(k), 6).len();
            assert!((2..=7).contains(&found), "{k}: {found}");
        }
    }

    #[test]
    fn clock_ticks_are_full_minutes() {
        let noon_s = 1_780_315_200.0; // 2026-06-01 12:00:00
        assert_eq!(texts(clocks(70.0, 710.0, noon_s, 6)), ["12:02", "12:04", "12:06", "12:08", "12:10"]);
        assert_eq!(texts(clocks(0.0, 12.0, noon_s, 3)), ["12:00:00", "12:00:05", "12:00:10"]);
    }
}
