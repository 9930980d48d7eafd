//! The field's change with the day, from a base station.

use super::base_station::{BaseStation, BaseTimes};
use super::moving_mean::moving_mean;
use crate::statistics::median;
use crate::tow::Tow;

/// What the base station says, to be taken from the field.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diurnal {
    /// For each recording a value a row, nT, about one constant that all recordings share; `None` where no base station
    /// covers nine tenths of the recording.
    pub variation_nt: Vec<Option<Vec<f64>>>,
    /// What is wrong with the readings of each recording.
    pub faults: Vec<Faults>,
    /// The constant, nT: the median of all readings of the base station.
    pub reference_nt: f64,
}

/// What is wrong with a base station's readings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faults {
    /// Readings that are not the Earth's field (spikes, dummies, cars), and were not used.
    pub left_out: usize,
    /// The longest time in which it reads the same, s.
    pub stood_s: f64,
}

/// The readings are smoothed so that nothing of the base station's own noise gets into the band of targets, 0.1 Hz and
/// above: the gain of three running means of 16 s at 0.1 Hz is (sin(1.6 pi) / (1.6 pi))^3 = -0.007, and 0.5 at 0.02 Hz.
const SMOOTHING_HALF_S: f64 = 8.0;
const SMOOTHINGS: usize = 3;

/// The field's change with the day in the rows of all recordings. Missing readings in between are bridged, at the ends the
/// nearest one holds.
pub fn diurnal(tows: &[Tow]) -> Diurnal {
    let (smoothed, faults): (Vec<Option<Vec<f64>>>, _) = tows.iter().map(smoothed).unzip();
    let reference_nt = median(&mut smoothed.iter().flatten().flatten().copied().collect::<Vec<_>>()).unwrap_or(0.0);
    let about = |field: Vec<f64>| field.into_iter().map(|field_nt| field_nt - reference_nt).collect();
    Diurnal { variation_nt: smoothed.into_iter().map(|field| field.map(about)).collect(), faults, reference_nt }
}

/// The base station's field in the rows of a recording.
fn smoothed(tow: &Tow) -> (Option<Vec<f64>>, Faults) {
    let Some(field_nt) = tow.base_nt.clone() else { return (None, Faults::default()) };
    // A base station slower than the recording has a value in a row, and then none for a while.
    let times = BaseTimes::Recording(tow.time_s.clone());
    let base = BaseStation { times, field_nt };
    let stood_s = base.stood_s();
    let (base, left_out) = base.without_outliers();
    let faults = Faults { left_out, stood_s };
    let Ok(mut field) = base.join(tow) else { return (None, faults) };
    for _ in 0..SMOOTHINGS {
        bridge(&mut field);
        field = moving_mean(&tow.time_s, &field, SMOOTHING_HALF_S);
    }
    bridge(&mut field);
    (Some(field), faults)
}

/// Straight over missing values, by rows.
fn bridge(values: &mut [f64]) {
    let known: Vec<usize> = (0..values.len()).filter(|&row| values[row].is_finite()).collect();
    let (Some(&first), Some(&last)) = (known.first(), known.last()) else { return };
    let (start, end) = (values[first], values[last]);
    values[..first].fill(start);
    values[last..].fill(end);
    for pair in known.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let slope = (values[to] - values[from]) / (to - from) as f64;
        for row in from + 1..to {
            values[row] = values[from] + slope * (row - from) as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tow(base_nt: impl Fn(f64) -> f64) -> Tow {
        let time_s: Vec<f64> = (0..6000).map(|row| f64::from(row) / 10.0).collect();
        Tow { base_nt: Some(time_s.iter().map(|time_s| base_nt(*time_s)).collect()), time_s, ..Tow::default() }
    }

    #[test]
    fn what_is_slow_goes_and_what_is_fast_stays_out() {
        let wave = |period_s: f64| move |t: f64| 50_000.0 + (std::f64::consts::TAU * t / period_s).cos();
        let gain = |period_s: f64| {
            let variation = diurnal(&[tow(wave(period_s))]).variation_nt.remove(0).unwrap();
            variation[1000..5000].iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
        };
        assert!(gain(10.0) < 0.02 && gain(300.0) > 0.95, "{} {}", gain(10.0), gain(300.0));
    }

    #[test]
    fn recordings_share_one_reference() {
        let both = diurnal(&[tow(|_| 50_000.0), tow(|_| 50_010.0), tow(|_| 50_010.0)]);
        assert_eq!(both.reference_nt, 50_010.0);
        assert!((both.variation_nt[0].as_ref().unwrap()[3000] + 10.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_wrong_with_the_readings_is_told() {
        let spiked = |t: f64| 50_000.0 + 0.01 * t + if (300.0..301.0).contains(&t) { 300.0 } else { 0.0 };
        let found = diurnal(&[tow(spiked), tow(|t| 50_000.0 + 0.01 * t.min(200.0)), Tow::default()]);
        let [spikes, stands, none] = found.faults[..] else { panic!("{found:?}") };
        assert_eq!((spikes.left_out, stands.left_out, none), (10, 0, Faults::default()));
        assert!((399.0..401.0).contains(&stands.stood_s) && spikes.stood_s < 1.0, "{stands:?}");
        let variation_nt = found.variation_nt[0].as_ref().unwrap();
        assert!((variation_nt[3000] - variation_nt[2500] - 0.5).abs() < 0.02, "the spike is none of it");
    }

    #[test]
    fn missing_readings_are_bridged_but_not_half_a_recording() {
        let half = |t: f64| if t < 300.0 { 50_000.0 } else { f64::NAN };
        assert_eq!(diurnal(&[tow(half), Tow { base_nt: None, ..tow(half) }]).variation_nt, [None, None]);
        let a_value_a_minute = |t: f64| if t % 60.0 < 0.05 { 50_000.0 + t } else { f64::NAN };
        assert!(diurnal(&[tow(a_value_a_minute)]).variation_nt[0].is_some());
        let gap = |t: f64| if (200.0..250.0).contains(&t) { f64::NAN } else { 50_000.0 + t };
        let found = diurnal(&[tow(gap)]);
        let at = |row: usize| found.variation_nt[0].as_ref().unwrap()[row] + found.reference_nt;
        assert!((at(2250) - 50_225.0).abs() < 0.01, "{}", at(2250));
    }
}
