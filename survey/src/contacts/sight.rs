//! What a dipole adds to the field where the way bends: the profiles of a straight pass, and what the bend makes of them.

use super::dipole::{Dipole, profiles, weighed};
use super::geometry::{ABOUT, Geometry};
use super::way::{Spot, Way};

/// Step of the difference quotients by place and distance, as a share of the distance.
const DERIVATIVE_STEP: f64 = 0.01;
/// The way is straight if about a dipole it is no further beside its direction than this share of the distance.
const STRAIGHT: f64 = 0.1;
/// And no higher or lower than this: depths are known better than courses.
const LEVEL: f64 = 0.02;

/// A dipole as it is seen from the way.
pub(super) struct Sight {
    dipole: Dipole,
    bent: Option<Geometry>,
}

impl Sight {
    pub(super) fn of(way: &Way, dipole: &Dipole) -> Self {
        let bent = way.is_bent_at(dipole.at, dipole.distance).then(|| Geometry::of(way, dipole)).flatten();
        Self { dipole: *dipole, bent }
    }

    /// The three profiles at a spot, of 1 nT.
    pub(super) fn profiles(&self, spot: &Spot) -> [f64; 3] {
        let u = (spot.at - self.dipole.at) / self.dipole.distance;
        let straight = profiles(u);
        let bend = self.bent.as_ref().and_then(|bent| bent.bend(spot));
        bend.map_or(straight, |bend| std::array::from_fn(|k| straight[k] + bend[k]))
    }
}

impl Dipole {
    /// Its anomaly at places of the way, as far as it is linear in the moment, which is what is fitted, nT.
    pub(super) fn linear_nt(&self, way: &Way, spots: &[Spot]) -> Vec<f64> {
        let sight = Sight::of(way, self);
        spots.iter().map(|spot| weighed(sight.profiles(spot), self.amplitudes_nt)).collect()
    }

    /// What a joint fit of it is made of, one value a place of the way each: the three profiles a nT, then what being further
    /// along and further away by one hundredth of the distance changes, in nT.
    pub(super) fn columns(&self, way: &Way, spots: &[Spot]) -> Vec<Vec<f64>> {
        let step = DERIVATIVE_STEP * self.distance;
        let later = Self { at: self.at + step, ..*self };
        let further = Self { distance: self.distance + step, ..*self };
        let [own, later, further] = [self, &later, &further].map(|dipole| Sight::of(way, dipole));
        let mut columns = vec![Vec::new(); 5];
        for spot in spots {
            let [a, b, c] = own.profiles(spot);
            let here = weighed([a, b, c], self.amplitudes_nt);
            let change = |sight: &Sight| weighed(sight.profiles(spot), self.amplitudes_nt) - here;
            let row = [a, b, c, change(&later), change(&further)];
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
        columns
    }
}

impl Way {
    /// Whether the way bends about a place, for a dipole so far away.
    pub(super) fn is_bent_at(&self, at: f64, distance: f64) -> bool {
        let Some(shape) = &self.shape else { return false };
        let [forward, _] = shape.axes(self.row_at(at));
        let closest = self.spot(at).place;
        [-1.0, -0.5, 0.5, 1.0].into_iter().any(|share| {
            let off = share * ABOUT * distance;
            let beside = self.spot(at + off).place - closest - forward * off;
            beside.xy().norm() > STRAIGHT * distance || beside.z.abs() > LEVEL * distance
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::*;
    use crate::contacts::Levelled;
    use crate::contacts::dipole::amplitudes_of_moment;
    use crate::navigation::Track;

    /// A quarter of a circle of this radius, m, to starboard from north, between straight legs, 0.1 m a row; it falls by this in a
    /// heave of 10 m of way.
    fn way(radius_m: f64, heave_m: f64) -> (Way, Vec<Vector3<f64>>) {
        let leg_m = 100.0;
        let arc_m = radius_m * std::f64::consts::FRAC_PI_2;
        let along_m: Vec<f64> = (0..((2.0 * leg_m + arc_m) * 10.0) as usize).map(|k| 0.1 * k as f64).collect();
        let course = |m: f64| ((m - leg_m) / radius_m).clamp(0.0, std::f64::consts::FRAC_PI_2);
        let depth_m: Vec<f64> = along_m.iter().map(|m| heave_m * (m * std::f64::consts::TAU / 10.0).sin()).collect();
        // On the circle by its own formula, not by steps of the course.
        let place = |m: f64| {
            let (sin, cos) = course(m).sin_cos();
            let (before, after) = (m.min(leg_m), (m - leg_m - arc_m).max(0.0));
            [radius_m * (1.0 - cos) + after, before + radius_m * sin]
        };
        let places_m = along_m.iter().zip(&depth_m).map(|(m, down)| Vector3::new(place(*m)[0], place(*m)[1], *down));
        let course_deg = along_m.iter().map(|m| course(*m).to_degrees()).collect();
        // Field to north and down, as a level body sees it.
        let field = |m: &f64| [0.6 * course(*m).cos(), -0.6 * course(*m).sin(), 0.8];
        let direction: Vec<[f64; 3]> = along_m.iter().map(field).collect();
        let time_s: Vec<f64> = along_m.clone();
        let track = Track { along_m: along_m.clone(), course_deg, ..Track::default() };
        let levelled = Levelled {
            time_s: &time_s,
            is_valid: &[],
            field_nt: &[],
            variance_nt2: None,
            terms: &[],
            direction: &direction,
            track: Some(&track),
            altitude_m: None,
            depth_m: Some(&depth_m),
        };
        (Way::by_positions(&levelled), places_m.collect())
    }

    /// `100 (3 (m . u) (e . u) - m . e) / r^3`.
    fn anomaly_nt(from: Vector3<f64>, moment: Vector3<f64>) -> f64 {
        let (field, u) = (Vector3::new(0.0, 0.6, 0.8), from.normalize());
        100.0 * (3.0 * moment.dot(&u) * field.dot(&u) - moment.dot(&field)) / from.norm().powi(3)
    }

    #[test]
    fn the_anomaly_on_a_bend_is_that_of_the_dipole() {
        let (side_rad, distance) = (0.7_f64, 8.0);
        for (radius_m, heave_m, at, most) in
            [(20.0, 0.0, 100.0, 0.01), (20.0, 0.5, 110.0, 0.02), (1e4, 0.5, 100.0, 0.01)]
        {
            let (way, places_m) = way(radius_m, heave_m);
            let row = way.row_at(at);
            let [forward, starboard] = way.shape.as_ref().unwrap().axes(row);
            let toward = starboard * side_rad.sin() + Vector3::z() * side_rad.cos();
            let dipole_m = places_m[row] + toward * distance;
            let moment = Vector3::new(3.0, -5.0, 10.0);
            let axes = Matrix3::from_rows(&[forward.transpose(), starboard.transpose(), Vector3::z().transpose()]);
            let amplitudes = amplitudes_of_moment(axes * toward, axes * Vector3::new(0.0, 0.6, 0.8))
                * (axes * moment)
                * (100.0 / distance.powi(3));
            let dipole = Dipole { at, distance, side_rad, amplitudes_nt: amplitudes.into() };
            let rows = row - 350..row + 350;
            let seen = dipole.linear_nt(&way, &rows.clone().map(|row| way.spot_of_row(row)).collect::<Vec<_>>());
            let truth: Vec<f64> = rows.map(|row| anomaly_nt(places_m[row] - dipole_m, moment)).collect();
            let peak = truth.iter().fold(0.0, |peak: f64, nt| peak.max(nt.abs()));
            let off = seen.iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < most * peak, "radius {radius_m} heave {heave_m}: {off} of {peak} nT");
            // The straight pass would be wrong by more.
            let straight = |m: f64| {
                profiles((m - at) / distance).iter().zip(dipole.amplitudes_nt).map(|(p, a)| p * a).sum::<f64>()
            };
            let straight_off = way.at[row - 350..row + 350].iter().zip(&truth).map(|(m, nt)| (straight(*m) - nt).abs());
            assert!(straight_off.fold(0.0, f64::max) > 4.0 * off || radius_m > 1e3 && heave_m == 0.0);
        }
    }

    #[test]
    fn a_straight_way_has_the_profiles() {
        let (way, _) = way(1e5, 0.0);
        let dipole = Dipole { at: 60.0, distance: 5.0, side_rad: 0.3, amplitudes_nt: [0.0; 3] };
        let sight = Sight::of(&way, &dipole);
        assert!(sight.bent.is_none());
        assert_eq!(sight.profiles(&way.spot(63.0)), profiles(0.6));
    }
}
