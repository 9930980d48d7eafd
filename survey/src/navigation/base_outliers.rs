//! Readings of a base station that are not the Earth's field: spikes, dummies, and cars that pass it.

use crate::statistics::{NORMAL_MEDIAN, median};

/// No storm moves the total field further from its median, nT: the strongest known changed the horizontal field by 1,600 nT (Colaba,
/// 1859: Tsurutani et al. 2003).
const FURTHEST_NT: f64 = 3_000.0;
/// A reading is held against the median of those about it, to this time before and after, s: a car is by in a third of it.
const NEIGHBOURS_S: f64 = 60.0;
/// But of a slow base station to so many readings: of fewer the median follows a spike.
const LEAST_NEIGHBOURS: usize = 3;
/// Of a fast one so many are taken on each side, spread over that time.
const MOST_NEIGHBOURS: usize = 60;
/// A reading is off by more than so many standard deviations of all: of 36,000 that are normal not one is.
const OFF_STD: f64 = 6.0;
/// And by more than this, nT: pulsations of the field with periods of a minute and more, on all but the stormiest days.
const OFF_NT: f64 = 5.0;

/// Readings, time in s and field in nT in the order of time, without outliers.
pub(super) fn without_outliers(readings: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let middle_nt = median(&mut readings.iter().map(|(_, nt)| *nt).collect::<Vec<_>>()).unwrap_or(0.0);
    let mut readings = readings;
    readings.retain(|(_, nt)| (nt - middle_nt).abs() <= FURTHEST_NT);
    let off_nt: Vec<f64> = (0..readings.len()).map(|at| off_nt(&readings, at).abs()).collect();
    let std_nt = median(&mut off_nt.clone()).unwrap_or(0.0) / NORMAL_MEDIAN;
    let limit_nt = OFF_NT.max(OFF_STD * std_nt);
    readings.into_iter().zip(off_nt).filter(|(_, off_nt)| *off_nt <= limit_nt).map(|(reading, _)| reading).collect()
}

/// How far a reading is off the median of as many before it as after it: where the field climbs evenly, not at all.
fn off_nt(readings: &[(f64, f64)], at: usize) -> f64 {
    let (time_s, field_nt) = readings[at];
    let before = at - readings[..at].partition_point(|(s, _)| *s < time_s - NEIGHBOURS_S);
    let after = readings[at + 1..].partition_point(|(s, _)| *s <= time_s + NEIGHBOURS_S);
    let reach = before.min(after).max(LEAST_NEIGHBOURS).min(at).min(readings.len() - 1 - at);
    let step = reach.div_ceil(MOST_NEIGHBOURS).max(1);
    let mut near: Vec<f64> = (1..=reach).step_by(step).flat_map(|k| [readings[at - k].1, readings[at + k].1]).collect();
    near.push(field_nt);
    field_nt - median(&mut near).unwrap_or(field_nt)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty minutes of a reading a second: a slow change, a pulsation of 4 nT, and what is wrong.
    fn readings(wrong_nt: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let field_nt = |s: f64| 49_500.0 + 0.01 * s + 4.0 * (s / 10.0).sin() + wrong_nt(s);
        (0..1200).map(|s| (f64::from(s), field_nt(f64::from(s)))).collect()
    }

    fn left_out(wrong_nt: impl Fn(f64) -> f64) -> usize {
        1200 - without_outliers(readings(wrong_nt)).len()
    }

    #[test]
    fn spikes_dummies_and_cars_go() {
        assert_eq!(left_out(|s| if s == 600.0 { 300.0 } else { 0.0 }), 1);
        assert_eq!(left_out(|s| if (300.0..600.0).contains(&s) { 50_000.0 } else { 0.0 }), 300);
        let car = |s: f64| 60.0 * (-((s - 700.0) / 6.0).powi(2)).exp();
        assert!((10..25).contains(&left_out(car)), "{}", left_out(car));
        // At the ends too.
        assert_eq!(left_out(|s| if s == 2.0 { -80.0 } else { 0.0 }), 1);
    }

    #[test]
    fn what_the_field_does_stays() {
        assert_eq!(left_out(|_| 0.0), 0);
        let sudden = |s: f64| 60.0 / (1.0 + (-(s - 600.0) / 20.0).exp());
        assert_eq!(left_out(sudden), 0);
        let minutes: Vec<(f64, f64)> =
            (0..60).map(|k| (60.0 * f64::from(k), 49_500.0 + f64::from(k * k) / 20.0)).collect();
        assert_eq!(without_outliers(minutes.clone()), minutes);
        let mut spiked = minutes;
        spiked[30].1 += 100.0;
        assert_eq!(without_outliers(spiked).len(), 59);
    }
}
