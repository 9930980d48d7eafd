//! Values between those that are there: of sensors and receivers that tell more rarely than the rows come.

use crate::statistics::median;

/// A value is led over at most so many steps of its own column.
const LED_STEPS: f64 = 3.0;
/// At least so long, s: positions once a second, with one missing.
const LED_S: f64 = 2.5;

/// Straight between the values that are there, unless they are far apart; angles the short way round.
pub(crate) fn led(times: &[f64], source_s: &[f64], numbers: &[f64], is_angle: bool) -> Vec<f64> {
    let there: Vec<usize> = (0..numbers.len()).filter(|&row| numbers[row].is_finite()).collect();
    let steps = there.windows(2).map(|pair| source_s[pair[1]] - source_s[pair[0]]);
    let usual_s = median(steps.collect()).unwrap_or(0.0);
    let longest_s = (LED_STEPS * usual_s).max(LED_S);
    let value = |time_s: &f64| {
        let next = there.partition_point(|&row| source_s[row] < time_s - 1e-9);
        let (before, after) = (next.checked_sub(1).map(|at| there[at]), there.get(next).copied());
        match (before, after) {
            (_, Some(after)) if (source_s[after] - time_s).abs() <= 1e-9 => numbers[after],
            (Some(before), Some(after)) if source_s[after] - source_s[before] <= longest_s => {
                let share = (time_s - source_s[before]) / (source_s[after] - source_s[before]);
                let mut change = numbers[after] - numbers[before];
                if is_angle {
                    change -= 360.0 * (change / 360.0).round();
                }
                let value = numbers[before] + share * change;
                if is_angle && numbers[before] >= 0.0 { value.rem_euclid(360.0) } else { value }
            }
            _ => f64::NAN,
        }
    };
    times.iter().map(value).collect()
}
