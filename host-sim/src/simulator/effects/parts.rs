//! What several effects have in common.

use crate::simulator::effect::{Change, Kind, Parameter};
use crate::simulator::signals::Signals;

/// `s(time(t)) - s(t)` at every row: what all timing effects add.
pub(super) fn retimed(signals: &Signals, mut time_s: impl FnMut(usize, f64) -> f64) -> Change {
    let mut change_nt = Vec::with_capacity(signals.len());
    for segment in signals.segments() {
        for row in segment.epochs.clone() {
            let at_s = time_s(row, signals.epochs_s()[row]);
            change_nt.push(signals.scalar_at(segment, at_s) - signals.rows().scalar_nt[row]);
        }
    }
    Change::of_scalar(change_nt)
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
    Parameter { name, unit, range: [-limit, limit], plausible: [-plausible, plausible], kind: Kind::Linear }
}

/// A nonlinear parameter.
pub(super) const fn nonlinear(
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
    plausible: [f64; 2],
) -> Parameter {
    Parameter { name, unit, range, plausible, kind: Kind::Nonlinear }
}

/// Azimuth of an axis in the body.
pub(super) const AXIS_AZIMUTH_DEG: Parameter = Parameter {
    name: "axis_azimuth_deg",
    unit: "deg",
    range: [-360.0, 360.0],
    plausible: [-180.0, 180.0],
    kind: Kind::Cyclic,
};

/// Elevation of an axis in the body, positive down.
pub(super) const AXIS_ELEVATION_DEG: Parameter = nonlinear("axis_elevation_deg", "deg", [-90.0, 90.0], [-90.0, 90.0]);
