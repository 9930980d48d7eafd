//! Degrees to metres and back: the UTM zone of the tow.

use proj4rs::Proj;
use proj4rs::transform::transform;

/// Width of a zone, degrees.
const ZONE_DEG: f64 = 6.0;
/// How many there are.
const ZONES: f64 = 60.0;

/// A zone of the Universal Transverse Mercator grid on WGS 84. Metres on it are within 0.04 % of those on the ground at the
/// middle of the zone, and within 0.1 % at its edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// From 1 to 60.
    zone: u16,
    is_south: bool,
}

/// Both ends of a transformation.
pub(crate) struct Projection {
    geographic: Proj,
    plane: Proj,
}

impl Grid {
    /// The zone of a position, degrees. `None` where it is not on Earth.
    pub fn of(latitude_deg: f64, longitude_deg: f64) -> Option<Self> {
        let is_on_earth = latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 180.0;
        let zone = ((longitude_deg + 180.0) / ZONE_DEG).floor().rem_euclid(ZONES);
        is_on_earth.then_some(Self { zone: zone as u16 + 1, is_south: latitude_deg < 0.0 })
    }

    /// Its code in the register of EPSG, as maps ask for it.
    pub fn epsg(&self) -> u16 {
        self.zone + if self.is_south { 32_700 } else { 32_600 }
    }

    /// Easting and northing, m, of a latitude and longitude, degrees. `None` where the projection has no such place.
    pub fn plane(&self, latitude_deg: f64, longitude_deg: f64) -> Option<[f64; 2]> {
        self.projection()?.plane(latitude_deg, longitude_deg)
    }

    /// Latitude and longitude, degrees, of an easting and northing, m.
    pub fn geographic(&self, easting_m: f64, northing_m: f64) -> Option<[f64; 2]> {
        self.projection()?.geographic(easting_m, northing_m)
    }

    /// Ready for many positions.
    pub(crate) fn projection(&self) -> Option<Projection> {
        let south = if self.is_south { " +south" } else { "" };
        let plane = format!("+proj=utm +zone={}{south} +datum=WGS84 +units=m +no_defs", self.zone);
        let [geographic, plane] =
            ["+proj=longlat +datum=WGS84 +no_defs", &plane].map(|definition| Proj::from_proj_string(definition).ok());
        Some(Projection { geographic: geographic?, plane: plane? })
    }
}

impl Projection {
    /// As [`Grid::plane`].
    pub(crate) fn plane(&self, latitude_deg: f64, longitude_deg: f64) -> Option<[f64; 2]> {
        let mut place = (longitude_deg.to_radians(), latitude_deg.to_radians(), 0.0);
        transform(&self.geographic, &self.plane, &mut place).ok()?;
        Some([place.0, place.1]).filter(|place| place.iter().all(|metres| metres.is_finite()))
    }

    /// As [`Grid::geographic`].
    pub(crate) fn geographic(&self, easting_m: f64, northing_m: f64) -> Option<[f64; 2]> {
        let mut place = (easting_m, northing_m, 0.0);
        transform(&self.plane, &self.geographic, &mut place).ok()?;
        let place = [place.1.to_degrees(), place.0.to_degrees()];
        Some(place).filter(|place| place.iter().all(|degrees| degrees.is_finite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By PROJ 9 through rasterio 1.4.3: `rasterio.warp.transform('EPSG:4326', 'EPSG:...', ...)`.
    const PROJ: [(f64, f64, u16, f64, f64); 6] = [
        (54.3, 10.5, 32632, 597612.4572221744, 6017938.378431878),
        (54.3, 11.999, 32632, 695138.5428546601, 6021049.5615000855),
        (-33.45, -70.65, 32719, 346642.6949988917, 6297606.832481072),
        (-33.85, 151.2, 32756, 333471.81485345226, 6253018.169285596),
        (60.4, 5.2, 32631, 621211.3107323586, 6697983.398541752),
        (-17.0, 179.9, 32760, 808795.4434574766, 8118158.74603774),
    ];

    #[test]
    fn it_is_what_proj_says() {
        for (latitude_deg, longitude_deg, epsg, easting_m, northing_m) in PROJ {
            let grid = Grid::of(latitude_deg, longitude_deg).unwrap();
            assert_eq!(grid.epsg(), epsg);
            let [east, north] = grid.plane(latitude_deg, longitude_deg).unwrap();
            assert!((east - easting_m).abs() < 1e-6 && (north - northing_m).abs() < 1e-6, "{east} {north}");
            let [latitude, longitude] = grid.geographic(east, north).unwrap();
            assert!((latitude - latitude_deg).abs() < 1e-12 && (longitude - longitude_deg).abs() < 1e-12);
        }
    }

    #[test]
    fn a_place_that_is_not_on_earth_has_no_zone() {
        assert_eq!(Grid::of(91.0, 0.0).or(Grid::of(0.0, 181.0)).or(Grid::of(f64::NAN, 0.0)), None);
        assert_eq!([-180.0, 180.0, -0.1].map(|east| Grid::of(1.0, east).unwrap().epsg()), [32601, 32601, 32630]);
    }

    #[test]
    fn a_tow_over_the_date_line_stays_on_one_grid() {
        let grid = Grid::of(-17.0, 179.999).unwrap();
        let [west, east] = [179.999, -179.999].map(|longitude_deg| grid.plane(-17.0, longitude_deg).unwrap());
        assert!((east[0] - west[0] - 213.0).abs() < 1.0, "{}", east[0] - west[0]);
    }
}
