//! What a rest is drawn over: of what its driver is made of, that which tells most of it; and, where that tells clearly more, a second
//! thing beside it.

use super::curve::{self, Row};
use super::map;
use crate::diagnosis::policy::MAP_LEAST_MORE;
use crate::diagnosis::result::{Curve, DriverForm, Map};
use crate::diagnosis::shapes::expression::{Expr, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::inputs::{AXES, fast_reading, reading_rate, tilts, turns, turns_of_direction};
use crate::diagnosis::shapes::scene::Scene;

/// Parts of a curve.
const PARTS: usize = 24;
/// The body's axes.
const WAYS: [&str; 3] = ["forward", "starboard", "down"];
/// Rows that are held out together: 10 s.
const TOGETHER: usize = 100;

/// What is left, and what is fitted to it, nT, one value a row; and how it enters.
pub(super) struct Drawn<'b> {
    pub(super) left_nt: &'b [Option<f64>],
    pub(super) fitted_nt: &'b [Option<f64>],
    pub(super) form: DriverForm,
    pub(super) scene: &'b Scene,
    pub(super) level_nt: f64,
}

impl<'b> Drawn<'b> {
    pub(super) fn new(
        left_nt: &'b [Option<f64>],
        fitted_nt: &'b [Option<f64>],
        form: DriverForm,
        scene: &'b Scene,
    ) -> Self {
        let mut drawn = Self { left_nt, fitted_nt, form, scene, level_nt: 0.0 };
        let rows = drawn.rows(&Expr::Number(0.0)).unwrap_or_default();
        drawn.level_nt = rows.iter().map(|row| row.fitted_nt).sum::<f64>() / rows.len().max(1) as f64;
        drawn
    }

    /// The rows that are used along an axis; none where the recording has not what it needs.
    pub(super) fn rows(&self, over: &Expr) -> Option<Vec<Row>> {
        let along = over.evaluate(self.scene)?;
        let of = |row: usize| {
            let fitted_nt = self.fitted_nt.get(row).copied().flatten().unwrap_or(0.0);
            Some(Row { row, left_nt: self.left_nt[row]?, fitted_nt, along: along[row] })
        };
        Some((0..along.len()).filter_map(of).collect())
    }

    /// The curve over a driver, of which one group may be known, and its map where that tells clearly more.
    pub(super) fn over(&self, input: &str, group: Option<&Group>) -> (Option<Curve>, Option<Map>) {
        let own = own_axes(input, group, self.scene);
        let tells = |over: &Expr| Some((self.closed(&[(over, PARTS)])?, over.clone()));
        // Of those that tell as much the one that comes first.
        let best =
            own.iter().filter_map(tells).reduce(|best, other| if other.0 > best.0 + 1e-3 { other } else { best });
        let Some((closed, over)) = best else { return (None, None) };
        let points = curve::curve(self, &over, PARTS);
        let beside = own.into_iter().chain(beside(self.form)).filter(|axis| *axis != over);
        let with =
            beside.filter_map(|axis| Some((self.closed(&[(&over, map::PARTS[0]), (&axis, map::PARTS[1])])?, axis)));
        let second = with.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(with, _)| *with > closed + MAP_LEAST_MORE);
        let map = second.and_then(|(_, axis)| map::map(self, [&over, &axis]));
        (points.map(|points| Curve { over: label(&over), points }), map)
    }

    /// Share of the squares of what is left that means over cells of some axes close on stretches that are held out.
    fn closed(&self, axes: &[(&Expr, usize)]) -> Option<f64> {
        let along = axes.iter().map(|(over, parts)| Some((self.rows(over)?, *parts))).collect::<Option<Vec<_>>>()?;
        let rows = &along.first()?.0;
        let mut cells = vec![0; rows.len()];
        let mut count = 1;
        for (rows, parts) in &along {
            let edges = edges(rows, *parts);
            cells.iter_mut().zip(rows).for_each(|(cell, row)| *cell = *cell * parts + part_of(&edges, row.along));
            count *= parts;
        }
        // Of noise it is the size that follows the driver.
        let value = |row: &Row| if self.form == DriverForm::Variance { row.left_nt.abs() } else { row.left_nt };
        let values: Vec<f64> = rows.iter().map(value).collect();
        let halves: Vec<usize> = rows.iter().map(|row| row.row / TOGETHER % 2).collect();
        Some(closed_by_cells(&values, &halves, &cells, count))
    }
}

/// Share of the squares that the means of one half of the rows close of the other, both ways; a mean of few rows is shrunk.
fn closed_by_cells(values: &[f64], halves: &[usize], cells: &[usize], count: usize) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let mut sums = vec![[(0.0, 0.0); 2]; count];
    for ((value, half), cell) in values.iter().zip(halves).zip(cells) {
        let (sum, rows) = &mut sums[*cell][*half];
        *sum += value - mean;
        *rows += 1.0;
    }
    let predicted = |cell: usize, half: usize| {
        let (sum, rows): (f64, f64) = sums[cell][1 - half];
        sum / (rows + curve::ROWS_ALIKE)
    };
    let rows = || values.iter().map(|value| value - mean).zip(halves).zip(cells);
    let left: f64 = rows().map(|((value, half), cell)| (value - predicted(*cell, *half)).powi(2)).sum();
    1.0 - left / rows().map(|((value, _), _)| value * value).sum::<f64>().max(f64::MIN_POSITIVE)
}

/// Inner edges of parts with equally many rows, ascending.
pub(super) fn edges(rows: &[Row], parts: usize) -> Vec<f64> {
    let mut along: Vec<f64> = rows.iter().map(|row| row.along).collect();
    along.sort_by(f64::total_cmp);
    let mut edges: Vec<f64> = (1..parts).map(|k| along[k * along.len() / parts]).collect();
    edges.dedup();
    edges
}

/// The part in which a value is.
pub(super) fn part_of(edges: &[f64], along: f64) -> usize {
    edges.partition_point(|edge| *edge <= along)
}

/// What a driver is: the directions of an attitude, the axes of a turn, the course of a column; else time.
fn own_axes(input: &str, group: Option<&Group>, scene: &Scene) -> Vec<Expr> {
    let recorded = |name: &str| scene.variable(name).map(|_| var(name));
    let attitude = || AXES.map(var).into_iter().chain(recorded("heading_deg")).chain(tilts(scene));
    let filtered = group.iter().flat_map(|group| &group.shapes).flat_map(Expr::filtered).cloned();
    let others: Vec<Expr> = match input {
        "attitude" => attitude().collect(),
        "attitude_rate" => turns(scene),
        "attitude_history" => filtered.chain(attitude()).collect(),
        column => recorded(column).into_iter().collect(),
    };
    let mut all: Vec<Expr> = group.iter().map(|group| group.over.clone()).collect();
    for axis in others {
        if !all.contains(&axis) {
            all.push(axis);
        }
    }
    if all.is_empty() { vec![var("t")] } else { all }
}

/// What a driver may be drawn beside: the direction that a moment turns with; the slope of a reading that is late, and the reading of which
/// a part is too much.
fn beside(form: DriverForm) -> Vec<Expr> {
    let reading = match form {
        DriverForm::Delay => Some(reading_rate()),
        DriverForm::Multiplicative => Some(fast_reading(Expr::clone)),
        DriverForm::Additive | DriverForm::Variance => None,
    };
    AXES.map(var).into_iter().chain(reading).collect()
}

/// An axis in words, with its unit.
pub(super) fn label(over: &Expr) -> String {
    if let Some(axis) = turns_of_direction().iter().position(|turn| turn == over) {
        return format!("rate of turning about the body's axis {}, 1/s", WAYS[axis]);
    }
    match over {
        Expr::Variable(name) => named(name),
        Expr::Filtered(of, Filter::Rate) => format!("{}, change per s", label(of)),
        Expr::Filtered(of, _) => format!("{}, as it was before", label(of)),
        other if *other == reading_rate() => "slope of the reading, nT/s".into(),
        other if other.to_string().starts_with("(s") => "reading without its background, nT".into(),
        other if other.to_string().contains("heading_deg") => "rate of turning of the heading, 1/s".into(),
        other => other.to_string(),
    }
}

fn named(variable: &str) -> String {
    if let Some(axis) = AXES.iter().position(|axis| *axis == variable) {
        return format!("direction of the field along the body, {}", WAYS[axis]);
    }
    match variable {
        "t" => "time since the first row, s".into(),
        "depth" => "depth, m".into(),
        "temperature" => "temperature, °C".into(),
        "heading_deg" => "heading, °".into(),
        "roll_deg" => "roll, °".into(),
        "pitch_deg" => "pitch, °".into(),
        column => column.replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_is_that_of_stretches_the_means_do_not_know() {
        let halves: Vec<usize> = (0..4000).map(|row| row / TOGETHER % 2).collect();
        let cells: Vec<usize> = (0..4000).map(|row| row * 7 % 24).collect();
        let course: Vec<f64> = cells.iter().map(|cell| *cell as f64).collect();
        assert!(closed_by_cells(&course, &halves, &cells, 24) > 0.97);
        // What each stretch has for itself no mean of the others closes.
        let own: Vec<f64> = (0..4000).map(|row| if row / TOGETHER % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(closed_by_cells(&own, &halves, &cells, 24) < 0.0);
    }

    #[test]
    fn parts_hold_equally_many_rows_and_those_alike_are_not_split() {
        let row = |along: f64| Row { row: 0, left_nt: 0.0, fitted_nt: 0.0, along };
        let spread: Vec<Row> = (0..90).map(|k| row(f64::from(k))).collect();
        assert_eq!(edges(&spread, 3), [30.0, 60.0]);
        assert_eq!([29.0, 30.0, 89.0].map(|along| part_of(&[30.0, 60.0], along)), [0, 1, 2]);
        let switch: Vec<Row> = (0..90).map(|k| row(f64::from(k / 45))).collect();
        assert_eq!(edges(&switch, 6), [0.0, 1.0]);
    }

    /// A body that turns round while a pump comes and goes.
    fn pumping() -> Scene {
        let course = |of: &dyn Fn(f64) -> f64| (0..4000).map(|row| of(f64::from(row))).collect::<Vec<f64>>();
        let [pump, cx] = [course(&|row| (row / 37.0).sin()), course(&|row| (row / 11.0).cos())];
        let [cy, cz] = [course(&|row| (row / 11.0).sin()), course(&|row| 0.1 * (row / 5.0).sin())];
        Scene::with([("pump_A", pump), ("cx", cx), ("cy", cy), ("cz", cz)], vec![0..4000])
    }

    fn drawn(left: impl Fn(f64, f64) -> f64) -> (Option<Curve>, Option<Map>) {
        let scene = pumping();
        let [pump, cx] = ["pump_A", "cx"].map(|name| scene.variable(name).unwrap());
        let left: Vec<Option<f64>> = pump.iter().zip(cx).map(|(pump, cx)| Some(left(*pump, *cx))).collect();
        Drawn::new(&left, &[], DriverForm::Additive, &scene).over("pump_A", None)
    }

    #[test]
    fn a_moment_is_drawn_over_its_column_and_the_direction_that_it_turns_with() {
        let (curve, map) = drawn(|pump, cx| pump * cx);
        let map = map.unwrap();
        assert_eq!(curve.unwrap().over, "pump A");
        assert_eq!(map.over, ["pump A", "direction of the field along the body, forward"]);
        let at =
            |line: &[Option<_>], column: usize| line[column].map(|cell: crate::diagnosis::CurvePoint| cell.left_nt);
        let [astern, ahead] = [map.cells.first().unwrap(), map.cells.last().unwrap()];
        assert!(at(ahead, 11).unwrap() > 0.5 && at(astern, 11).unwrap() < -0.5);
        assert!(at(ahead, 0).unwrap() < -0.5 && at(astern, 0).unwrap() > 0.5);
    }

    #[test]
    fn what_a_curve_tells_has_no_map() {
        let (curve, map) = drawn(|pump, _| pump.abs());
        assert!(map.is_none());
        let points = curve.unwrap().points;
        assert!(points[0].left_nt > 0.9 && points[12].left_nt < 0.2, "{points:?}");
    }
}
