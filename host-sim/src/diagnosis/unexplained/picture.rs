//! The pictures of a rest: over that course of its driver which tells most of it, and, where that tells clearly more, over a second one
//! beside it.

use super::axes::{beside, label, own_axes};
use super::drawn::{Drawn, edges, part_of};
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
        let held = self.held();
        let tells = |over: &Expr| Some((held.closed_by(&self.parts(over, PARTS)?, PARTS), over.clone()));
        // Of those that tell as much the one that comes first.
        let best =
            own.iter().filter_map(tells).reduce(|best, other| if other.0 > best.0 + 1e-3 { other } else { best });
        let Some((closed, over)) = best else { return (None, None) };
        let points = curve::curve(self, &over, PARTS);
        let [columns, lines] = map::PARTS;
        let first = self.parts(&over, columns).unwrap_or_default();
        let with = |axis: Expr| {
            let second = self.parts(&axis, lines)?;
            let cells: Vec<usize> = first.iter().zip(second).map(|(column, line)| column * lines + line).collect();
            Some((held.closed_by(&cells, columns * lines), axis))
        };
        let beside = own.into_iter().chain(beside(self.form)).filter(|axis| *axis != over).filter_map(with);
        let second = beside.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(with, _)| *with > closed + MAP_LEAST_MORE);
        let map = second.and_then(|(_, axis)| map::map(self, [&over, &axis]));
        (points.map(|points| Curve { over: label(&over), points }), map)
    }

    /// The part of an axis in which each row is.
    fn parts(&self, over: &Expr, parts: usize) -> Option<Vec<usize>> {
        let rows = self.rows(over)?;
        let edges = edges(&rows, parts);
        Some(rows.iter().map(|row| part_of(&edges, row.along)).collect())
    }

    /// What is left, ready to be held out; of noise it is the size that follows the driver.
    fn held(&self) -> Held {
        let used = self.left_nt.iter().enumerate().filter_map(|(row, nt)| Some((row, (*nt)?)));
        let value = |nt: f64| if self.form == DriverForm::Variance { nt.abs() } else { nt };
        let (values, halves) = used.map(|(row, nt)| (value(nt), row / TOGETHER % 2)).unzip();
        Held { values, halves }
    }
}

/// A value of each row, and the half of the rows that it is held out with.
struct Held {
    values: Vec<f64>,
    halves: Vec<usize>,
}

impl Held {
    /// Share of the squares that the means of one half of the rows over cells close of the other, both ways; a mean of few rows is shrunk.
    fn closed_by(&self, cells: &[usize], count: usize) -> f64 {
        let mean = self.values.iter().sum::<f64>() / self.values.len().max(1) as f64;
        let rows = || self.values.iter().map(|value| value - mean).zip(&self.halves).zip(cells);
        let mut sums = vec![[(0.0, 0.0); 2]; count];
        for ((value, half), cell) in rows() {
            let (sum, rows) = &mut sums[*cell][*half];
            *sum += value;
            *rows += 1.0;
        }
        let predicted = |cell: usize, half: usize| {
            let (sum, rows): (f64, f64) = sums[cell][1 - half];
            sum / (rows + curve::ROWS_ALIKE)
        };
        let left: f64 = rows().map(|((value, half), cell)| (value - predicted(*cell, *half)).powi(2)).sum();
        1.0 - left / rows().map(|((value, _), _)| value * value).sum::<f64>().max(f64::MIN_POSITIVE)
    }
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
        assert!(Held { values: course, halves: halves.clone() }.closed_by(&cells, 24) > 0.97);
        // What each stretch has for itself no mean of the others closes.
        let own: Vec<f64> = (0..4000).map(|row| if (row / TOGETHER).is_multiple_of(2) { 1.0 } else { -1.0 }).collect();
        assert!(Held { values: own, halves }.closed_by(&cells, 24) < 0.0);
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
