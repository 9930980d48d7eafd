//! A second scalar sensor on the same body.

use super::earth::Slow;
use super::place::Track;
use super::{Scenario, SecondScalar};
use crate::effects::Draw;
use crate::simulator::Attitude;
use crate::simulator::signals::{Signals, interference};

impl SecondScalar {
    /// Its reading without noise, nT, one a row. What rock does is a function of the way, and so comes earlier or later.
    pub(super) fn reads_nt(
        &self,
        scenario: &Scenario,
        slow: &Slow,
        signals: &Signals,
        (track, attitude): (&Track, &[Attitude]),
        strength_nt: f64,
        draw: &mut Draw,
    ) -> Vec<f64> {
        let rows = signals.rows();
        let coefficients = self.interference.of_body(signals.trajectory(), draw);
        let speed_m_per_s = scenario.motion.speed_m_per_s().filter(|speed| *speed > 0.0);
        let earlier_s = speed_m_per_s.map_or(0.0, |speed| self.ahead_m / speed);
        let at = |(row, &time_s): (usize, &f64)| {
            let (sin, cos) = libm::sincos(attitude[row].heading);
            let [north_m, east_m, down_m] = track.place_m[row];
            let place_m = [north_m + self.ahead_m * cos, east_m + self.ahead_m * sin, down_m];
            let sum_nt = track.field_nt(place_m, strength_nt + slow.at(time_s + earlier_s));
            let field_nt = sum_nt.iter().map(|nt| nt * nt).sum::<f64>().sqrt();
            field_nt + interference(&coefficients, field_nt, rows.direction[row], rows.direction_rate[row]).total_nt()
        };
        signals.epochs_s().iter().enumerate().map(at).collect()
    }
}
