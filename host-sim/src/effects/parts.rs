//! What several effects have in common.

use crate::effects::{Change, Domain, Kind, Parameter, Step};
use crate::simulator::signals::Signals;

/// `s(time(t)) - s(t)` at every row: what all timing effects add.
pub(super) fn retimed(signals: &Signals, mut time_s: impl FnMut(usize, f64) -> f64) -> Change {
    let mut change_nt = Vec::with_capacity(signals.len());
    for segment in signals.segments() {
        for row in segment.epochs.clone() {
            let at_s = time_s(row, signals.epochs_s()[row]);
            change_nt.push(signals.scalar_at(segment, at_s) - signals.scalar_at_rows_nt()[row]);
        }
    }
    Change::of_scalar(change_nt)
}

/// Each component of `f(time(t)) - f(t)` at every row; `time_s` is given the row, the axis and the row's own time.
pub(super) fn flux_retimed(signals: &Signals, time_s: impl Fn(usize, usize, f64) -> f64) -> Change {
    let flux_nt = flux_on_grid_nt(signals);
    let mut change_nt = Vec::with_capacity(signals.len());
    for segment in signals.segments() {
        for row in segment.epochs.clone() {
            let late = |i: usize| {
                let at_s = time_s(row, i, signals.epochs_s()[row]).clamp(segment.span_s[0], segment.span_s[1]);
                signals.grid().vector_at(&flux_nt, at_s)[i] - signals.rows().flux_nt[row][i]
            };
            change_nt.push([0, 1, 2].map(late));
        }
    }
    Change::of_flux(change_nt)
}

/// The clean reading of the fluxgate on the grid, nT.
pub(super) fn flux_on_grid_nt(signals: &Signals) -> Vec<[f64; 3]> {
    let trajectory = signals.trajectory();
    trajectory.field_nt.iter().zip(&trajectory.direction).map(|(nt, c)| c.map(|cosine| nt * cosine)).collect()
}

/// The value at any time of what is known at some, by straight lines; beyond the ends what it is there.
pub(super) fn between_rows(times_s: &[f64], values: &[f64], at_s: f64) -> f64 {
    let after = times_s.partition_point(|&time_s| time_s <= at_s);
    match (after.checked_sub(1), values.get(after)) {
        (None, _) => values[0],
        (Some(before), None) => values[before],
        (Some(before), Some(next)) => {
            let share = (at_s - times_s[before]) / (times_s[after] - times_s[before]);
            values[before] + share * (next - values[before])
        }
    }
}

/// One value a row from the row's number.
pub(super) fn scalar_by_row(signals: &Signals, of: impl FnMut(usize) -> f64) -> Change {
    Change::of_scalar((0..signals.len()).map(of).collect())
}

/// What a first-order low-pass of `nt` (on the grid) adds at every row. It starts anew, in steady state, after a gap.
pub(super) fn low_passed(signals: &Signals, nt: &[f64], time_constant_s: f64) -> Change {
    let grid = signals.grid();
    let mut change_nt = Vec::with_capacity(signals.len());
    for segment in signals.segments() {
        let points = signals.points(segment);
        let mut difference_nt = grid.low_pass(nt, time_constant_s, points.clone());
        difference_nt.iter_mut().zip(&nt[points.clone()]).for_each(|(passed, input)| *passed -= input);
        let own = crate::simulator::signals::Grid {
            start_s: grid.time_s(points.start),
            len: difference_nt.len(),
            rate_hz: grid.rate_hz,
        };
        // A segment of one row has no dynamics.
        let at = |row: usize| if own.len < 4 { 0.0 } else { own.at(&difference_nt, signals.epochs_s()[row]) };
        change_nt.extend(segment.epochs.clone().map(at));
    }
    Change::of_scalar(change_nt)
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Unit vector in body axes from azimuth (forward to starboard) and elevation (positive down), degrees.
pub(super) fn axis(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth_deg.to_radians());
    let (sin_elevation, cos_elevation) = libm::sincos(elevation_deg.to_radians());
    [cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation]
}

/// A linear parameter of either sign: accepted up to `limit`, plausible up to `plausible`.
pub(super) const fn linear(name: &'static str, unit: &'static str, limit: f64, plausible: f64) -> Parameter {
    Parameter {
        name,
        unit,
        range: [-limit, limit],
        plausible: [-plausible, plausible],
        kind: Kind::Linear,
        domain: Domain::Real,
    }
}

/// A parameter that is any number, found as `kind` says.
pub(super) const fn real(
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
    plausible: [f64; 2],
    kind: Kind,
) -> Parameter {
    Parameter { name, unit, range, plausible, kind, domain: Domain::Real }
}

/// Azimuth of an axis in the body.
pub(super) const fn axis_azimuth_deg(kind: Kind) -> Parameter {
    Parameter {
        domain: Domain::Cyclic { turn: 360.0 },
        ..real("axis_azimuth_deg", "deg", [-360.0, 360.0], [-180.0, 180.0], kind)
    }
}

/// Elevation of an axis in the body, positive down.
pub(super) const fn axis_elevation_deg(kind: Kind) -> Parameter {
    real("axis_elevation_deg", "deg", [-90.0, 90.0], [-90.0, 90.0], kind)
}

/// When something begins, on the recording's own axis. Which times are plausible depends on the recording.
pub(super) const TIME_S: Parameter = Parameter {
    name: "time_s",
    unit: "s",
    range: [f64::MIN, f64::MAX],
    plausible: [f64::NEG_INFINITY, f64::INFINITY],
    kind: Kind::Discrete(Step::fixed(0.1)),
    domain: Domain::Moment,
};

/// Time of the middle row on the recording's own axis, s: where something that happens once is typical.
pub(super) fn middle_s(signals: &Signals) -> f64 {
    signals.recording_time_s(signals.len() / 2)
}

/// Whether a row is at or after a time on the recording's own axis. To a microsecond: 58012.8 is the row that is written so.
pub(super) fn has_begun(signals: &Signals, row: usize, from_s: f64) -> bool {
    signals.recording_time_s(row) > from_s - 1e-6
}

/// Three components a row from the row's number and the clean reading of the fluxgate.
pub(super) fn flux_by_row(signals: &Signals, mut of: impl FnMut(usize, [f64; 3]) -> [f64; 3]) -> Change {
    Change::of_flux(signals.rows().flux_nt.iter().enumerate().map(|(row, &f)| of(row, f)).collect())
}

/// Slope of `s` at every row, nT/s.
pub(super) fn slope_nt_per_s(signals: &Signals) -> Vec<f64> {
    let half_s = 0.5 / signals.grid().rate_hz;
    let mut slope = Vec::with_capacity(signals.len());
    for segment in signals.segments() {
        for &time_s in &signals.epochs_s()[segment.epochs.clone()] {
            let value = |offset: f64| signals.scalar_at(segment, time_s + offset * half_s);
            // Differences of two widths, so that the error is of fourth order.
            slope.push((8.0 * (value(1.0) - value(-1.0)) - (value(2.0) - value(-2.0))) / (12.0 * half_s));
        }
    }
    slope
}

/// Depth, m, one value a row. What needs it is not applied to recordings without it.
pub(super) fn depth_m(signals: &Signals) -> &[f64] {
    signals.trajectory().depth_m.as_deref().expect("Effect::applies_to asks for depth_m")
}

/// Warming since the first row, K.
pub(super) fn warming_k(signals: &Signals, row: usize) -> f64 {
    signals.trajectory().temperature_deg_c.as_ref().map_or(0.0, |temperature| temperature[row] - temperature[0])
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
