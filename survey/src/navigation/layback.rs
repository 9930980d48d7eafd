//! From the ship to the body: it follows in the wake.
//!
//! A towed body goes, but for currents across, where the ship has gone: so many metres back along the ship's own way.

use super::error::NavigationError;
use super::moving_mean::moving_mean;
use super::options::Layback;
use super::path::Motion;
use crate::statistics::median;
use crate::tow::Tow;

/// Depth and cable are averaged over twice this, s: the body's bobbing in swell, up to some 10 s, is no layback.
const LAYBACK_HALF_S: f64 = 10.0;
/// The course at the start is that of the first so many metres.
const START_M: f64 = 10.0;
/// The body's velocity is its way over twice this, s.
const VELOCITY_HALF_S: f64 = 1.0;
/// So many rows may lack what the layback needs: one in so many.
const ONE_IN: usize = 10;

/// How far the body is behind the tow point in each row, m.
pub(crate) fn layback_m(tow: &Tow, layback: Layback) -> Result<Vec<f64>, NavigationError> {
    let factor = match layback {
        Layback::Fixed(layback_m) => return Ok(vec![layback_m; tow.len()]),
        Layback::Cable(factor) => factor,
    };
    let [cable_m, depth_m] = [("cable_out_m", &tow.cable_out_m), ("depth_m", &tow.depth_m)].map(|(lacking, column)| {
        let missing = || NavigationError::NoLayback { recording: tow.name.clone(), lacking };
        let column = column.as_ref().ok_or_else(missing)?;
        let absent = column.iter().filter(|metres| metres.is_nan()).count();
        if absent * ONE_IN > tow.len() { Err(missing()) } else { Ok(column) }
    });
    let (cable_m, depth_m) = (cable_m?, depth_m?);
    let squares: Vec<f64> = cable_m.iter().zip(depth_m).map(|(cable, depth)| cable * cable - depth * depth).collect();
    if squares.iter().filter(|square| **square < 0.0).count() * ONE_IN > tow.len() {
        return Err(NavigationError::CableTooShort { recording: tow.name.clone() });
    }
    let each: Vec<f64> = squares.iter().map(|square| factor * square.max(0.0).sqrt()).collect();
    let usual_m = median(&mut each.iter().copied().filter(|metres| metres.is_finite()).collect::<Vec<_>>());
    let means = moving_mean(&tow.time_s, &each, LAYBACK_HALF_S);
    Ok(means.into_iter().map(|mean| if mean.is_nan() { usual_m.unwrap_or(0.0) } else { mean }).collect())
}

/// The body's motion: in each row where the ship was `behind_m` metres ago.
pub(crate) fn behind(time_s: &[f64], ship: &[Option<Motion>], behind_m: &[f64]) -> Vec<Option<Motion>> {
    let wake = Wake::of(ship);
    let places: Vec<Option<[f64; 2]>> =
        (0..ship.len()).map(|row| wake.at(wake.along_m[row]? - behind_m[row])).collect();
    let speed = |row: usize| {
        let [first, last] = around(time_s, &places, row)?;
        let step_s = time_s[last] - time_s[first];
        let (from, to) = (places[first]?, places[last]?);
        (step_s > 0.0).then(|| [0, 1].map(|axis: usize| (to[axis] - from[axis]) / step_s))
    };
    let motion = |row: usize| {
        let stretch = ship[row]?.stretch;
        Some(Motion { place_m: places[row]?, velocity_m_per_s: speed(row)?, stretch })
    };
    (0..ship.len()).map(motion).collect()
}

/// The outermost rows near this one with places.
fn around(time_s: &[f64], places: &[Option<[f64; 2]>], row: usize) -> Option<[usize; 2]> {
    let is_near = |other: &usize| (time_s[*other] - time_s[row]).abs() <= VELOCITY_HALF_S && places[*other].is_some();
    let first = (0..=row).rev().take_while(is_near).last()?;
    let last = (row..places.len()).take_while(is_near).last()?;
    Some([first, last])
}

/// Where the ship has been, by the way it has made.
struct Wake {
    /// In each row, m.
    along_m: Vec<Option<f64>>,
    /// Way and place, without the rows in which it made none.
    points: Vec<(f64, [f64; 2])>,
    /// Unit vector of the course at the start.
    start: [f64; 2],
}

impl Wake {
    fn of(ship: &[Option<Motion>]) -> Self {
        let mut points: Vec<(f64, [f64; 2])> = Vec::new();
        let mut along_m = Vec::with_capacity(ship.len());
        for motion in ship {
            let Some(place) = motion.map(|motion| motion.place_m) else {
                along_m.push(None);
                continue;
            };
            let way = points.last().map_or(0.0, |(way, before)| way + distance_m(*before, place));
            if points.last().is_none_or(|(before, _)| way > *before) {
                points.push((way, place));
            }
            along_m.push(Some(way));
        }
        let start = start(&points);
        Self { along_m, points, start }
    }

    fn at(&self, along_m: f64) -> Option<[f64; 2]> {
        let (_, first) = *self.points.first()?;
        match self.points.partition_point(|(way, _)| *way <= along_m) {
            0 => Some([0, 1].map(|axis: usize| first[axis] + along_m * self.start[axis])),
            at if at == self.points.len() => self.points.last().map(|(_, place)| *place),
            at => {
                let ((from_m, from), (to_m, to)) = (self.points[at - 1], self.points[at]);
                let share = (along_m - from_m) / (to_m - from_m);
                Some([0, 1].map(|axis: usize| from[axis] + share * (to[axis] - from[axis])))
            }
        }
    }
}

/// Nothing is known of the way before the recording: it is taken for straight.
fn start(points: &[(f64, [f64; 2])]) -> [f64; 2] {
    let (Some((_, first)), Some((_, last))) = (points.first(), points.last()) else { return [0.0; 2] };
    let there = points.iter().find(|(way, _)| *way >= START_M).map_or(last, |(_, place)| place);
    let length = distance_m(*first, *there);
    if length > 0.0 { [0, 1].map(|axis: usize| (there[axis] - first[axis]) / length) } else { [0.0; 2] }
}

fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 100 m north, then east, at 2 m/s and 10 Hz.
    fn ship() -> (Vec<f64>, Vec<Option<Motion>>) {
        let time_s: Vec<f64> = (0..1500).map(|row| f64::from(row) / 10.0).collect();
        let motion = |time_s: &f64| {
            let way = 2.0 * time_s;
            let place_m = if way < 100.0 { [0.0, way] } else { [way - 100.0, 100.0] };
            Some(Motion { place_m, velocity_m_per_s: [f64::NAN; 2], stretch: 0 })
        };
        (time_s.clone(), time_s.iter().map(motion).collect())
    }

    #[test]
    fn the_body_goes_round_the_ships_corner() {
        let (time_s, ship) = ship();
        let body = behind(&time_s, &ship, &vec![30.0; 1500]);
        let place = |row: usize| body[row].unwrap().place_m.map(|metres| (metres * 10.0).round() / 10.0);
        // Before the start the way is straight; at 60 s the ship has made 120 m, the body 90.
        assert_eq!([place(0), place(600), place(700)], [[0.0, -30.0], [0.0, 90.0], [10.0, 100.0]]);
        let velocity = body[1000].unwrap().velocity_m_per_s;
        assert!((velocity[0] - 2.0).abs() < 1e-9 && velocity[1].abs() < 1e-9, "{velocity:?}");
    }

    #[test]
    fn the_layback_is_the_base_of_the_triangle() {
        let rows = 100;
        let tow = Tow {
            time_s: (0..rows).map(|row| row as f64 / 10.0).collect(),
            is_usable: vec![true; rows],
            cable_out_m: Some(vec![50.0; rows]),
            depth_m: Some(vec![30.0; rows]),
            ..Tow::default()
        };
        assert!(layback_m(&tow, Layback::Cable(0.9)).unwrap().iter().all(|metres| (metres - 36.0).abs() < 1e-9));
        assert_eq!(layback_m(&tow, Layback::Fixed(7.0)).unwrap(), vec![7.0; rows]);
        let short = Tow { depth_m: Some(vec![51.0; rows]), ..tow.clone() };
        let said = layback_m(&short, Layback::Cable(1.0)).unwrap_err();
        assert!(matches!(said, NavigationError::CableTooShort { .. }), "{said}");
        let without = Tow { cable_out_m: None, ..tow };
        assert!(layback_m(&without, Layback::Cable(1.0)).unwrap_err().to_string().contains("cable_out_m is missing"));
    }
}
