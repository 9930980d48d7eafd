//! The course in time of what no input drives, and the recorded column that it looks like most.

use super::left::Left;
use super::scene::Scene;
use crate::diagnosis::numerics::median;
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::result::ColumnMatch;

/// Rows about one whose middle value is its course: a switch keeps its edges, and a single bad row does not show.
const MIDDLE_OF_ROWS: usize = 5;
/// Turns of a column in time that say how well any course of its kind would match.
const TURNS: usize = 199;

/// The course, nT, one value a row that is used.
pub(super) fn recovered(left: &Left<'_, '_>) -> Vec<Option<f64>> {
    let residual_nt = left.problem.residual_nt(&left.fit);
    let mut course = vec![None; residual_nt.len()];
    for block in left.problem.whitening.blocks() {
        let used: Vec<usize> = block.rows.clone().filter(|row| residual_nt[*row].is_finite()).collect();
        let values: Vec<f64> = used.iter().map(|&row| residual_nt[row]).collect();
        let level = slow_line(&used, &values);
        for (k, &row) in used.iter().enumerate() {
            let (from, to) = (k.saturating_sub(MIDDLE_OF_ROWS / 2), (k + MIDDLE_OF_ROWS / 2 + 1).min(values.len()));
            course[row] = Some(median(values[from..to].to_vec()) - level(row));
        }
    }
    course
}

/// A straight line through some values.
fn slow_line(rows: &[usize], values: &[f64]) -> impl Fn(usize) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / n;
    let (middle, level) = (mean(&mut rows.iter().map(|&row| row as f64)), mean(&mut values.iter().copied()));
    let away = |row: usize| row as f64 - middle;
    let (product, square) = rows
        .iter()
        .zip(values)
        .fold((0.0, 0.0), |(p, s), (&row, value)| (p + away(row) * (value - level), s + away(row).powi(2)));
    let slope = if square > 0.0 { product / square } else { 0.0 };
    move |row| level + slope * (row as f64 - middle)
}

/// The column that goes with a course most; its chance counts how many were tried, and how well they do turned round in time.
pub(super) fn matched(course: &[Option<f64>], scene: &Scene) -> Option<ColumnMatch> {
    let used: Vec<usize> = (0..course.len()).filter(|&row| course[row].is_some()).collect();
    let own = centred(used.iter().filter_map(|&row| course[row]).collect());
    let columns: Vec<(&str, Vec<f64>)> = ["depth", "temperature"]
        .into_iter()
        .chain(scene.columns.iter().map(String::as_str))
        .filter_map(|name| {
            Some((name, centred(used.iter().map(|&row| scene.variable(name).map(|v| v[row])).collect::<Option<_>>()?)))
        })
        .collect();
    let best = columns.iter().max_by(|a, b| dot(&own, &a.1).abs().total_cmp(&dot(&own, &b.1).abs()))?;
    let correlation = dot(&own, &best.1);
    let as_good = (1..=TURNS).filter(|turn| {
        let by = own.len() * turn / (TURNS + 1);
        columns.iter().any(|(_, column)| {
            let mut turned = column.clone();
            turned.rotate_left(by);
            dot(&own, &turned).abs() >= correlation.abs()
        })
    });
    let p_value = (1 + as_good.count()) as f64 / (TURNS + 1) as f64;
    Some(ColumnMatch { column: best.0.into(), correlation, p_value, tried: columns.len() })
}

/// Of mean 0 and norm 1.
fn centred(values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let norm = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    values.into_iter().map(|x| (x - mean) / norm).collect()
}
