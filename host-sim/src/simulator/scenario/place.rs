//! Where the body is, and the field of the iron that it passes.

use super::Scenario;
use super::dipole::{DipoleSpec, Lies};
use super::path::Path;
use crate::simulator::signals::{Grid, Trajectory};

/// WGS 84: semi-major axis, m, and the square of the eccentricity.
const SEMI_MAJOR_M: f64 = 6_378_137.0;
const ECCENTRICITY_2: f64 = 6.694_379_990_141_317e-3;
/// Magnetic constant over 4 pi, in nT m^3 for a moment in A m^2.
const NT_M3_PER_AM2: f64 = 100.0;

/// The body's way in metres about the place of its first row.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// North, east, down, m, one a row; down is the depth, on land 0.
    pub place_m: Vec<[f64; 3]>,
    /// Course, rad from north by east, one a row: what the track does, not how the body yaws.
    pub course: Vec<f64>,
    /// Unit vector of the Earth's field, north, east, down.
    pub earth: [f64; 3],
    /// What lies by it, in the order of the scenario.
    pub dipoles: Vec<Dipole>,
    /// Latitude and longitude of the first row, degrees, if the scenario has a place.
    pub(super) origin_deg: Option<[f64; 2]>,
}

/// A dipole where it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dipole {
    /// North, east, down, m, about the place of the first row and the surface.
    pub place_m: [f64; 3],
    /// North, east, down, A m^2.
    pub moment_am2: [f64; 3],
}

impl Dipole {
    /// Its field at a place, north, east, down, nT: `mu0 / 4 pi (3 (m . r) r / r^5 - m / r^3)`.
    pub fn field_nt(&self, place_m: [f64; 3]) -> [f64; 3] {
        let r: [f64; 3] = std::array::from_fn(|i| place_m[i] - self.place_m[i]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let square = dot(r, r);
        let scale = NT_M3_PER_AM2 / (square * square.sqrt());
        let along = 3.0 * dot(self.moment_am2, r) / square;
        std::array::from_fn(|i| scale * (along * r[i] - self.moment_am2[i]))
    }
}

impl Track {
    /// Latitude and longitude of a place, degrees, if the scenario has one.
    ///
    /// Metres are those of the ellipsoid at the first row: 1.3e-4 off a kilometre north of it, at 45 degrees.
    pub fn degrees(&self, [north_m, east_m]: [f64; 2]) -> Option<[f64; 2]> {
        let origin_deg = self.origin_deg?;
        let [per_north, per_east] = metres_per_degree(origin_deg[0]);
        Some([origin_deg[0] + north_m / per_north, origin_deg[1] + east_m / per_east])
    }

    /// The way back, m north and east.
    pub fn metres(&self, [latitude_deg, longitude_deg]: [f64; 2]) -> Option<[f64; 2]> {
        let origin_deg = self.origin_deg?;
        let [per_north, per_east] = metres_per_degree(origin_deg[0]);
        Some([(latitude_deg - origin_deg[0]) * per_north, (longitude_deg - origin_deg[1]) * per_east])
    }

    pub(super) fn new(
        scenario: &Scenario,
        earth: [f64; 3],
        path: &Path,
        points: impl Iterator<Item = usize>,
        grid: &Grid,
    ) -> Self {
        let origin_deg =
            scenario.field.latitude_deg.zip(scenario.field.longitude_deg).map(|(north, east)| [north, east]);
        let (place_m, course) = points
            .map(|point| (path.at_point(point), path.course.heading_deg(grid.time_s(point)).to_radians()))
            .unzip();
        let mut track = Self { place_m, course, earth, dipoles: Vec::new(), origin_deg };
        track.dipoles = scenario.dipoles.iter().filter_map(|dipole| track.dipole(dipole, path, grid)).collect();
        track
    }

    /// The Earth's field of a size, with the iron's at a place, north, east, down, nT.
    pub(super) fn field_nt(&self, place_m: [f64; 3], earth_nt: f64) -> [f64; 3] {
        let mut sum_nt = self.earth.map(|component| component * earth_nt);
        for dipole in &self.dipoles {
            let iron_nt = dipole.field_nt(place_m);
            (0..3).for_each(|i| sum_nt[i] += iron_nt[i]);
        }
        sum_nt
    }

    /// Iron adds its vector to the Earth's: both sensors see their sum, the scalar its size.
    pub(super) fn add_dipoles(&self, world: &mut Trajectory, path: &Path) {
        if self.dipoles.is_empty() {
            return;
        }
        for (point, (field_nt, direction)) in world.field_nt.iter_mut().zip(&mut world.direction).enumerate() {
            let place_m = path.at_point(point);
            let sum_nt = self.field_nt(place_m, *field_nt);
            *field_nt = sum_nt.iter().map(|nt| nt * nt).sum::<f64>().sqrt();
            *direction = path.attitude[point].to_body(sum_nt.map(|nt| nt / *field_nt));
        }
    }

    fn dipole(&self, spec: &DipoleSpec, path: &Path, grid: &Grid) -> Option<Dipole> {
        let place_m = match spec.lies()? {
            Lies::ByTrack { at_s, offset_m, below_m } => {
                let [north_m, east_m, down_m] = path.at_point(grid.nearest(at_s));
                let (sin, cos) = libm::sincos(path.course.heading_deg(at_s).to_radians());
                [north_m - offset_m * sin, east_m + offset_m * cos, down_m + below_m]
            }
            Lies::ByPlace { latitude_deg, longitude_deg, depth_m } => {
                let [north_m, east_m] = self.metres([latitude_deg, longitude_deg])?;
                [north_m, east_m, depth_m]
            }
        };
        Some(Dipole { place_m, moment_am2: spec.moment() })
    }
}

/// Of the ellipsoid at a latitude: metres per degree of latitude and of longitude.
fn metres_per_degree(latitude_deg: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(latitude_deg.to_radians());
    let w = 1.0 - ECCENTRICITY_2 * sin * sin;
    let meridian_m = SEMI_MAJOR_M * (1.0 - ECCENTRICITY_2) / (w * w.sqrt());
    let across_m = SEMI_MAJOR_M / w.sqrt() * cos;
    [meridian_m.to_radians(), across_m.to_radians()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_of_a_dipole_is_the_textbook_s() {
        let dipole = Dipole { place_m: [0.0; 3], moment_am2: [0.0, 0.0, 10.0] };
        // On the axis 2 m / r^3, on the equator -m / r^3, times 100 nT m^3 / (A m^2).
        assert!((dipole.field_nt([0.0, 0.0, 2.0])[2] - 250.0).abs() < 1e-9);
        assert!((dipole.field_nt([0.0, 2.0, 0.0])[2] + 125.0).abs() < 1e-9);
        let slant = dipole.field_nt([1.0, 0.0, 1.0]);
        let size = slant.iter().map(|b| b * b).sum::<f64>().sqrt();
        // sqrt(1 + 3 sin^2 latitude) at a magnetic latitude of 45 degrees.
        assert!((size - 1000.0 / 2.0_f64.powf(1.5) * 2.5_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn degrees_and_metres_belong_together() {
        let track = Track { origin_deg: Some([39.1, 121.8]), ..Track::default() };
        let back = track.metres(track.degrees([812.0, -440.0]).unwrap()).unwrap();
        assert!((back[0] - 812.0).abs() < 1e-6 && (back[1] + 440.0).abs() < 1e-6);
        // A minute of latitude at 45 degrees is 1852.2 m, one of longitude 1314.2 m (any nautical table).
        let [north, east] = metres_per_degree(45.0).map(|metres| metres / 60.0);
        assert!((north - 1852.2).abs() < 0.1 && (east - 1314.2).abs() < 0.1, "{north} {east}");
    }
}
