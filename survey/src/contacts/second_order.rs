//! What a dipole adds to the size of the field beyond its part along the Earth's: iron of 150 nT beside 50,000 nT adds 0.2 nT by its
//! part across, which is what a near pass leaves of a fit that is linear in the moment.
//!
//! `|F e + b| - F = b . e + (b . b - (b . e)^2) / 2 F` to the second order of `b / F`, `F e` being the Earth's field and `b` the dipole's.

use nalgebra::Vector3;

use super::dipole::Dipole;
use super::geometry::Geometry;
use super::way::{Spot, Way};

/// It is no more than this share of an anomaly where the iron's field is below 2,000 nT. Where it is more, amplitudes cancel each other, as
/// those of a fit to noise do, whose squares do not.
const MOST_SHARE: f64 = 0.02;

/// The part of a dipole of known moment that is not linear in it.
struct SecondOrder {
    geometry: Geometry,
    /// In axes (forward, starboard, down) at the closest approach, nT at one distance.
    moment: Vector3<f64>,
    earth_nt: f64,
}

impl Dipole {
    /// Anomaly at places of the way, nT.
    pub(super) fn anomaly_nt(&self, way: &Way, spots: &[Spot]) -> Vec<f64> {
        let linear_nt = self.linear_nt(way, spots);
        let beyond_nt = self.second_order_nt(way, spots, &linear_nt);
        linear_nt.iter().zip(beyond_nt).map(|(linear, beyond)| linear + beyond).collect()
    }

    /// What of it is not linear in the moment, beside what is, nT.
    pub(super) fn second_order_nt(&self, way: &Way, spots: &[Spot], linear_nt: &[f64]) -> Vec<f64> {
        let none = || vec![0.0; spots.len()];
        let Some(beyond) = SecondOrder::of(way, self) else { return none() };
        let beyond_nt: Vec<f64> = spots.iter().map(|spot| beyond.at_nt(spot)).collect();
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, nt| most.max(nt.abs()));
        if most(&beyond_nt) <= MOST_SHARE * most(linear_nt) { beyond_nt } else { none() }
    }
}

impl SecondOrder {
    /// `None` where the Earth's field is not known in the axes of the way.
    fn of(way: &Way, dipole: &Dipole) -> Option<Self> {
        let earth_nt = way.shape.as_ref()?.field_nt;
        let geometry = Geometry::of(way, dipole)?;
        let moment = geometry.moments * Vector3::from(dipole.amplitudes_nt);
        Some(Self { geometry, moment, earth_nt })
    }

    /// At a spot, nT.
    fn at_nt(&self, spot: &Spot) -> f64 {
        let from = self.geometry.off_dipole(spot);
        let square = from.norm_squared();
        let iron_nt = (3.0 * self.moment.dot(&from) / square * from - self.moment) / (square * square.sqrt());
        let along_nt = iron_nt.dot(&self.geometry.field);
        (iron_nt.norm_squared() - along_nt * along_nt) / (2.0 * self.earth_nt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::Levelled;
    use crate::contacts::dipole::amplitudes_of_moment;

    const EARTH_NT: f64 = 50_000.0;

    /// A body that heads north at one unit of way a second.
    fn way() -> Way {
        let time_s: Vec<f64> = (0..1_200).map(|row| 0.1 * f64::from(row)).collect();
        Way::by_positions(&Levelled {
            time_s: &time_s,
            is_valid: &[],
            field_nt: &[EARTH_NT; 1_200],
            variance_nt2: None,
            terms: &[],
            direction: &[[0.6, 0.0, 0.8]; 1_200],
            track: None,
            altitude_m: None,
            depth_m: None,
        })
    }

    #[test]
    fn the_anomaly_is_the_change_of_the_size_of_the_field() {
        let (way, earth) = (way(), Vector3::new(0.6, 0.0, 0.8));
        let (toward, distance) = (Vector3::new(0.0, 0.5, 0.75_f64.sqrt()), 3.0);
        let moment = Vector3::new(20.0, -30.0, 40.0);
        let amplitudes = amplitudes_of_moment(toward, earth) * moment * (100.0 / 27.0);
        let dipole = Dipole { at: 60.0, distance, side_rad: 30_f64.to_radians(), amplitudes_nt: amplitudes.into() };
        let spots: Vec<Spot> = (500..700).map(|row| way.spot_of_row(row)).collect();
        let truth = |spot: &Spot| {
            let from = Vector3::new(spot.at - 60.0, 0.0, 0.0) - distance * toward;
            let r = from.norm();
            let iron_nt = 100.0 * (3.0 * from * moment.dot(&from) / r.powi(5) - moment / r.powi(3));
            (EARTH_NT * earth + iron_nt).norm() - EARTH_NT
        };
        let off = |nt: Vec<f64>| nt.iter().zip(&spots).map(|(nt, spot)| (nt - truth(spot)).abs()).fold(0.0, f64::max);
        let [linear, whole] = [dipole.linear_nt(&way, &spots), dipole.anomaly_nt(&way, &spots)].map(off);
        // What is left is of the third order, and of the part of the moment that hardly shows.
        assert!(linear > 0.3 && whole < 0.1 * linear, "{linear} {whole}");
        // Amplitudes a thousand times as large are no iron's.
        let cancelling = Dipole { amplitudes_nt: dipole.amplitudes_nt.map(|nt| 1e3 * nt), ..dipole };
        let linear_nt = cancelling.linear_nt(&way, &spots);
        assert!(cancelling.second_order_nt(&way, &spots, &linear_nt).iter().all(|nt| *nt == 0.0));
    }
}
