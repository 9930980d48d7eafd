//! The pictures of a rest: over that course of its driver which tells most of it, and, where that tells clearly more, over a second one
//! beside it.

use super::axes::{beside, label, own_axes};
use super::drawn::{Drawn, Row, edges, part_of};
use super::{curve, map};
use crate::diagnosis::policy::MAP_LEAST_MORE;
use crate::diagnosis::result::{Curve, DriverForm, Map};
use crate::diagnosis::shapes::expression::Expr;
use crate::diagnosis::shapes::group::Group;

/// Parts of a curve.
const PARTS: usize = 24;
/// Rows that are held out together: 10 s.
const TOGETHER: usize = 100;

impl Drawn<'_> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::CurvePoint;
    use crate::diagnosis::shapes::scene::Scene;

    #[test]
    fn a_share_is_that_of_stretches_the_means_do_not_know() {
        let halves: Vec<usize> = (0..4000).map(|row| row / TOGETHER % 2).collect();
        let cells: Vec<usize> = (0..4000).map(|row| row * 7 % 24).collect();
        let course: Vec<f64> = cells.iter().map(|cell| *cell as f64).collect();
        assert!(closed_by_cells(&course, &halves, &cells, 24) > 0.97);
        // What each stretch has for itself no mean of the others closes.
        let own: Vec<f64> = (0..4000).map(|row| if (row / TOGETHER).is_multiple_of(2) { 1.0 } else { -1.0 }).collect();
        assert!(closed_by_cells(&own, &halves, &cells, 24) < 0.0);
    }

    /// A body that turns round while a pump comes and goes.
    fn pumping() -> Scene {
        let course = |of: &dyn Fn(f64) -> f64| (0..4000).map(|row| of(f64::from(row))).collect::<Vec<f64>>();
        let [pump, cx] = [course(&|row| (row / 37.0).sin()), course(&|row| (row / 11.0).cos())];
        let [cy, cz] = [course(&|row| (row / 11.0).sin()), course(&|row| 0.1 * (row / 5.0).sin())];
        Scene::with([("pump_A", pump), ("cx", cx), ("cy", cy), ("cz", cz)], std::iter::once(0..4000).collect())
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
        let at = |line: &[Option<_>], column: usize| line[column].map(|cell: CurvePoint| cell.left_nt);
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
