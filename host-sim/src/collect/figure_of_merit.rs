//! Figure of merit: what a manoeuvre about each axis, on each heading, leaves from peak to peak, summed (Leliak 1961;
//! Hardwick 1984). The manoeuvres are told from the way in which the field's direction moves in the body.

use super::continuity::Continuity;
use super::heading::HeadingSectors;

/// Length of a window, s: one period of the lowest frequency of the band, and of a slow manoeuvre.
const WINDOW_S: f64 = 10.0;
/// Samples that a window needs to count: nine tenths of it.
const LEAST_SAMPLES: u64 = 90;
/// Least movement of the field's direction in a manoeuvre, standard deviation, rad: half a degree.
const LEAST_TURN_RAD: f64 = 0.01;
/// Share of that movement that belongs to one axis where the manoeuvre can be told.
const TOLD: f64 = 0.8;
/// An axis this near to the field, as the sine of the angle, moves its direction too little to be told.
const LEAST_SINE: f64 = 0.2;

/// Names of the manoeuvres: turns about the axes forward, starboard and down.
pub const MANOEUVRES: [&str; 3] = ["roll", "pitch", "yaw"];

/// Peak to peak on one heading in one manoeuvre, means over its windows, nT.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeritCell {
    /// How many windows of 10 s.
    pub windows: u64,
    /// Of the band-passed reading.
    pub before_nt: f64,
    /// Of the residual.
    pub after_nt: f64,
}

/// By heading, in the order of [`SECTORS`](super::SECTORS), and manoeuvre, in that of [`MANOEUVRES`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FigureOfMerit(pub [[MeritCell; 3]; 8]);

impl FigureOfMerit {
    /// The cells that were seen.
    pub fn seen(&self) -> impl Iterator<Item = &MeritCell> {
        self.0.iter().flatten().filter(|cell| cell.windows > 0)
    }

    /// Sums before and after over the cells that were seen, nT; `None` where none was.
    pub fn sums_nt(&self) -> Option<[f64; 2]> {
        self.seen().map(|cell| [cell.before_nt, cell.after_nt]).reduce(|a, b| [a[0] + b[0], a[1] + b[1]])
    }
}

/// Collects a [`FigureOfMerit`].
#[derive(Clone, Debug, Default)]
pub struct MeritCollector {
    window: Window,
    ends_s: f64,
    continuity: Continuity,
    found: FigureOfMerit,
}

/// Sums over a window.
#[derive(Clone, Debug, Default)]
struct Window {
    count: u64,
    sum: [f64; 3],
    products: [[f64; 3]; 3],
    heading: [f64; 2],
    before: Option<(f64, f64)>,
    after: Option<(f64, f64)>,
}

impl MeritCollector {
    /// Take in one row: heading, the field in body axes, nT, and the band before and after compensation, nT.
    pub fn push(&mut self, time_s: f64, heading_deg: f64, flux_nt: [f64; 3], [before_nt, after_nt]: [f64; 2]) {
        if self.continuity.after_gap(time_s) || self.window.count == 0 || time_s >= self.ends_s {
            self.close();
            self.ends_s = time_s + WINDOW_S;
        }
        let length = flux_nt.iter().map(|value| value * value).sum::<f64>().sqrt();
        let direction = flux_nt.map(|value| value / length);
        let window = &mut self.window;
        window.count += 1;
        for (i, x) in direction.iter().enumerate() {
            window.sum[i] += x;
            direction.iter().enumerate().for_each(|(j, y)| window.products[i][j] += x * y);
        }
        window.heading[0] += heading_deg.to_radians().cos();
        window.heading[1] += heading_deg.to_radians().sin();
        let wider = |range: Option<(f64, f64)>, value: f64| {
            Some(range.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
        };
        window.before = wider(window.before, before_nt);
        window.after = wider(window.after, after_nt);
    }

    fn close(&mut self) {
        let window = std::mem::take(&mut self.window);
        let (Some(axis), Some(before), Some(after)) = (window.axis(), window.before, window.after) else { return };
        let heading_deg = window.heading[1].atan2(window.heading[0]).to_degrees();
        let cell = &mut self.found.0[HeadingSectors::sector(heading_deg)][axis];
        cell.windows += 1;
        let share = 1.0 / cell.windows as f64;
        cell.before_nt += share * (before.1 - before.0 - cell.before_nt);
        cell.after_nt += share * (after.1 - after.0 - cell.after_nt);
    }

    /// What was found.
    pub fn figure(&self) -> FigureOfMerit {
        let mut last = self.clone();
        last.close();
        last.found
    }
}

impl Window {
    /// The axis about which the body turned. A turn about an axis moves the field's direction in the body across both.
    fn axis(&self) -> Option<usize> {
        if self.count < LEAST_SAMPLES {
            return None;
        }
        let mean = self.sum.map(|sum| sum / self.count as f64);
        let covariance = |i: usize, j: usize| self.products[i][j] / self.count as f64 - mean[i] * mean[j];
        let all = (0..3).map(|i| covariance(i, i)).sum::<f64>();
        let along = |axis: usize| {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let square = mean[j] * mean[j] + mean[k] * mean[k];
            let across = covariance(j, j) * mean[k] * mean[k] + covariance(k, k) * mean[j] * mean[j]
                - 2.0 * covariance(j, k) * mean[j] * mean[k];
            if square > LEAST_SINE * LEAST_SINE { across / square / all } else { 0.0 }
        };
        let told = (0..3).map(|axis| (axis, along(axis))).max_by(|a, b| a.1.total_cmp(&b.1));
        told.filter(|(_, share)| *share > TOLD && all.sqrt() > LEAST_TURN_RAD).map(|(axis, _)| axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Field of 50,000 nT, in a body that rolls, pitches or yaws by 5 degrees every 5 s.
    fn turned(axis: usize, time_s: f64) -> [f64; 3] {
        let field = [22_000.0, 15_000.0, 42_000.0];
        let (sine, cosine) = (0.087 * (std::f64::consts::TAU * time_s / 5.0).sin()).sin_cos();
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut seen = field;
        seen[j] = cosine * field[j] + sine * field[k];
        seen[k] = cosine * field[k] - sine * field[j];
        seen
    }

    #[test]
    fn manoeuvres_are_told_and_their_peaks_are_summed() {
        let mut collector = MeritCollector::default();
        for i in 0..3_000 {
            let time_s = 0.1 * f64::from(i);
            let axis = (i / 1_000) as usize;
            let swing = (std::f64::consts::TAU * time_s / 5.0).sin();
            let amplitude = 1.0 + axis as f64;
            collector.push(time_s, 90.0, turned(axis, time_s), [10.0 * swing, amplitude * swing]);
        }
        let figure = collector.figure();
        assert_eq!(figure.seen().count(), 3);
        for (axis, cell) in figure.0[2].iter().enumerate() {
            assert_eq!(cell.windows, 10);
            assert!((cell.after_nt - 2.0 * (1.0 + axis as f64)).abs() < 0.02, "{cell:?}");
        }
        let [before, after] = figure.sums_nt().unwrap();
        assert!((before - 60.0).abs() < 0.2 && (after - 12.0).abs() < 0.05);
    }

    #[test]
    fn straight_tow_and_mixed_motion_are_no_manoeuvre() {
        let mut collector = MeritCollector::default();
        for i in 0..1_000 {
            let time_s = 0.1 * f64::from(i);
            collector.push(time_s, 90.0, turned(0, 0.0), [1.0, 1.0]);
        }
        for i in 1_000..2_000 {
            let time_s = 0.1 * f64::from(i);
            let (roll, pitch) = (turned(0, time_s), turned(1, 1.3 * time_s));
            collector.push(time_s, 90.0, std::array::from_fn(|k| roll[k] + pitch[k]), [1.0, 1.0]);
        }
        assert_eq!(collector.figure().sums_nt(), None);
    }
}
