//! Natural neighbours on a regular grid (Sibson 1981), by the crate `spade`, of means a cell; blank far from any track.

use rayon::prelude::*;
use spade::{DelaunayTriangulation, HasPosition, HierarchyHintGenerator, Point2, Triangulation};

use super::cells::{Frame, MapError};
use super::line_distance::line_distance_m;
use super::spots::{Spot, block_means, spots};
use crate::result::SurveyedTow;

/// Values on a regular grid of square cells, rows from north to south, each from west to east.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Easting of the western edge, m.
    pub west_m: f64,
    /// Northing of the northern edge, m.
    pub north_m: f64,
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Cells a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Values of the cells' middles, NaN where blank.
    pub values: Vec<f32>,
    /// Usual distance between lines, m; `None` with fewer than two.
    pub line_distance_m: Option<f64>,
}

/// Without a size asked for there are at most so many: a second's work.
const MOST_CELLS_BY_DEFAULT: f64 = 250_000.0;
/// Cells across the distance between two lines: a quarter of it is as fine as lines can tell (and usual).
const CELLS_A_DISTANCE: f64 = 4.0;
/// Of a single line, where nothing says how wide a cell should be, m.
const SINGLE_LINE_CELL_M: f64 = 1.0;
/// The smallest that is chosen, m: positions are hardly better.
const SMALLEST_CELL_M: f64 = 0.25;
/// Cells further from a measurement than this share of the distance between lines are blank: half of it reaches the middle
/// between two lines, the rest is for lines that wander.
const REACH_DISTANCES: f64 = 0.75;
/// And at least so many cells are filled beside a track.
const LEAST_REACH_CELLS: f64 = 1.5;

impl HasPosition for Spot {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.place_m[0], self.place_m[1])
    }
}

type Mesh = DelaunayTriangulation<Spot, (), (), (), HierarchyHintGenerator<f64>>;

/// The anomaly of all recordings on cells of this size, or of one that suits the lines. `None` where no place is known.
///
/// # Errors
///
/// When the cells are too small.
pub fn anomaly_map(tows: &[SurveyedTow], cell_m: Option<f64>) -> Result<Option<Raster>, MapError> {
    let spots = spots(tows);
    if spots.is_empty() {
        return Ok(None);
    }
    let line_distance_m = line_distance_m(&spots);
    let cell_m = cell_m.unwrap_or_else(|| suitable_cell_m(&spots, line_distance_m));
    let reach_m = (REACH_DISTANCES * line_distance_m.unwrap_or(0.0)).max(LEAST_REACH_CELLS * cell_m);
    let frame = Frame::around(places(&spots), cell_m).checked()?;
    let mesh = Mesh::bulk_load(block_means(&spots, cell_m))?;
    Ok(Some(Raster {
        west_m: frame.west * cell_m,
        north_m: frame.north * cell_m,
        cell_m,
        width: frame.width as usize,
        height: frame.height as usize,
        values: values(&frame, &mesh, reach_m),
        line_distance_m,
    }))
}

/// Of the middles of the cells, blank further than this from any measurement.
fn values(frame: &Frame, mesh: &Mesh, reach_m: f64) -> Vec<f32> {
    let rows = (0..frame.height as usize).into_par_iter();
    rows.flat_map_iter(|row| {
        let neighbours = mesh.natural_neighbor();
        let value = |column: usize| {
            let x_m = (frame.west + column as f64 + 0.5) * frame.cell_m;
            let y_m = (frame.north - row as f64 - 0.5) * frame.cell_m;
            let place = Point2::new(x_m, y_m);
            let nearest = *mesh.nearest_neighbor(place)?.data();
            let distance_m = (nearest.place_m[0] - x_m).hypot(nearest.place_m[1] - y_m);
            let inside = || neighbours.interpolate(|spot| spot.data().anomaly_nt, place);
            // Outside of all measurements the nearest one holds: of a single line that is everywhere.
            (distance_m <= reach_m).then(|| inside().unwrap_or(nearest.anomaly_nt))
        };
        (0..frame.width as usize).map(|column| value(column).map_or(f32::NAN, |value| value as f32)).collect::<Vec<_>>()
    })
    .collect()
}

fn places(spots: &[Spot]) -> impl Iterator<Item = [f64; 2]> + Clone {
    spots.iter().map(|spot| spot.place_m)
}

fn suitable_cell_m(spots: &[Spot], line_distance_m: Option<f64>) -> f64 {
    let wanted_m = line_distance_m.map_or(SINGLE_LINE_CELL_M, |distance_m| distance_m / CELLS_A_DISTANCE);
    let mut cell_m = rounded_up(wanted_m.max(SMALLEST_CELL_M));
    loop {
        let frame = Frame::around(places(spots), cell_m);
        if frame.cells() <= MOST_CELLS_BY_DEFAULT {
            return cell_m;
        }
        cell_m = rounded_up(cell_m * 1.01);
    }
}

/// To 1, 2, 2.5 or 5 times a power of ten.
fn rounded_up(metres: f64) -> f64 {
    let power = 10_f64.powf(metres.log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0];
    steps.into_iter().map(|step| step * power).find(|step| *step >= metres * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::check_cells;
    use crate::navigation::{Navigated, Navigation, Track};
    use crate::tow::Tow;

    /// Lines along the north, so far apart, 200 m long, with a value every 0.2 m of what is below.
    fn tow(lines: usize, apart_m: f64, field: impl Fn(f64, f64) -> f64) -> SurveyedTow {
        let mut tow = SurveyedTow::default();
        let mut track = Track::default();
        for row in 0..lines * 1000 {
            let (line, x, y) = (row / 1000, (row / 1000) as f64 * apart_m + 500_000.0, (row % 1000) as f64 * 0.2);
            tow.time_s.push(row as f64 / 10.0);
            tow.is_valid.push(true);
            tow.anomaly_nt.push(field(x - 500_000.0, y));
            tow.line.push(format!("L{line}").into());
            track.easting_m.push(x);
            track.northing_m.push(y);
        }
        tow.track = Some(track);
        tow
    }

    #[test]
    fn between_lines_it_is_what_lies_there() {
        let field = |x: f64, y: f64| 3.0 + 0.1 * x - 0.05 * y;
        let raster = anomaly_map(&[tow(5, 10.0, field)], None).unwrap().unwrap();
        assert_eq!((raster.cell_m, raster.line_distance_m), (2.5, Some(10.0)));
        let mut filled = 0;
        for (at, value) in raster.values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let x = raster.west_m + (at % raster.width) as f64 * 2.5 + 1.25 - 500_000.0;
            let y = raster.north_m - (at / raster.width) as f64 * 2.5 - 1.25;
            if (0.0..40.0).contains(&x) && (5.0..195.0).contains(&y) {
                filled += 1;
                assert!((f64::from(*value) - field(x, y)).abs() < 0.02, "{x} {y}: {value}");
            }
        }
        assert_eq!(filled, 16 * 76);
    }

    #[test]
    fn far_from_any_line_it_is_blank() {
        let raster = anomaly_map(&[tow(1, 0.0, |_, _| 2.0)], None).unwrap().unwrap();
        assert_eq!((raster.cell_m, raster.line_distance_m), (1.0, None));
        assert!(raster.values.iter().all(|value| value.is_nan() || *value == 2.0));
        assert!(
            (3..=4).contains(&raster.width) && raster.values.iter().filter(|value| value.is_finite()).count() >= 200
        );
        // Two lines of one, the fourth 60 m away.
        let apart = [tow(3, 10.0, |_, _| 1.0), {
            let mut far = tow(1, 0.0, |_, _| 1.0);
            far.track.as_mut().unwrap().easting_m.iter_mut().for_each(|x| *x += 80.0);
            far
        }];
        let raster = anomaly_map(&apart, Some(5.0)).unwrap().unwrap();
        let middle = raster.values[10 * raster.width..11 * raster.width].iter().map(|value| value.is_finite());
        assert!(middle.filter(|is_filled| *is_filled).count() < raster.width - 5);
    }

    #[test]
    fn too_many_cells_are_refused_and_never_chosen() {
        let wide = [tow(2, 40_000.0, |_, _| 1.0)];
        let refused = anomaly_map(&wide, Some(0.1)).unwrap_err();
        assert!(matches!(refused, MapError::TooManyCells { .. }), "{refused}");
        // And before it was surveyed, by where it was alone.
        let [of_wide] = &wide;
        let navigated = Navigated { track: of_wide.track.clone(), ..Navigated::default() };
        let navigation = Navigation { tows: vec![navigated], grid: None };
        let check = |is_usable: bool, cell_m: f64| {
            let time_s = of_wide.time_s.clone();
            let tow = Tow { is_usable: vec![is_usable; time_s.len()], time_s, ..Tow::default() };
            check_cells(&[tow], &navigation, cell_m)
        };
        assert_eq!((check(true, 0.1), check(true, 25.0), check(false, 0.1)), (Err(refused), Ok(()), Ok(())));
        let raster = anomaly_map(&wide, None).unwrap().unwrap();
        assert!(raster.values.len() < 250_000);
        assert_eq!(anomaly_map(&[SurveyedTow::default()], None), Ok(None));
    }

    #[test]
    fn sizes_are_round() {
        assert_eq!([0.3, 1.0, 1.01, 2.2, 26.0, 99.0].map(rounded_up), [0.5, 1.0, 2.0, 2.5, 50.0, 100.0]);
    }
}
