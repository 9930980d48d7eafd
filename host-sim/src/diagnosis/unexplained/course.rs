//! The course in time of what no input drives, and the recorded column that it looks like most.

use super::left::Left;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::median;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::result::ColumnMatch;
use crate::diagnosis::shapes::scene::Scene;

/// Rows about one whose middle value may be its course: a switch keeps its edges, and noise does not show.
const MIDDLES_OF_ROWS: [usize; 5] = [5, 9, 15, 25, 41];
/// Share of the power that may pass within a course. Derived: half.
const MOST_PASSING: f64 = 0.5;
/// Turns of a column in time that say how well any course of its kind would match.
const TURNS: usize = 199;

/// The course, nT, one value a row that is used: as smooth as leaves it half of its power, for what lasts is the course, and what
/// passes within it is not.
pub(super) fn recovered(residual_nt: &[Option<f64>]) -> Vec<Option<f64>> {
    let runs = runs(residual_nt);
    let power: f64 = runs.iter().flatten().map(|nt| nt * nt).sum();
    let lasts = |rows: &usize| runs.iter().map(|run| left_by(run, *rows)).sum::<f64>() <= MOST_PASSING * power;
    let best = MIDDLES_OF_ROWS.into_iter().rev().find(lasts).unwrap_or(MIDDLES_OF_ROWS[0]);
    let mut course = residual_nt.to_vec();
    let mut row = 0;
    for run in &runs {
        while residual_nt[row].is_none() {
            row += 1;
        }
        for k in 0..run.len() {
            course[row + k] = Some(middle(run, k, best));
        }
        row += run.len();
    }
    course
}

/// The residual of a plain fit without its background, nT, one value a row that is used; with a course taken off the reading before,
/// or else of the rows that agree with each other.
pub(super) fn without_level(left: &Left<'_>, taken_nt: Option<&[f64]>) -> Vec<Option<f64>> {
    let Some(taken_nt) = taken_nt else { return left.robust_nt().to_vec() };
    let residual_nt = left.plain_nt(taken_nt);
    let blocks = left.problem.whitening.blocks();
    let plain = Whitening::new(blocks, Predictor::white(1.0), None);
    let mut course: Vec<Option<f64>> = vec![None; residual_nt.len()];
    for (row, nt) in plain.rows().zip(plain.apply(&residual_nt)) {
        course[row] = residual_nt[row].is_finite().then_some(nt);
    }
    course
}

/// Successive rows that are used.
fn runs(course: &[Option<f64>]) -> Vec<Vec<f64>> {
    let runs = course.split(Option::is_none).filter(|run| !run.is_empty());
    runs.map(|run| run.iter().flatten().copied().collect()).collect()
}

fn about(run: &[f64], k: usize, rows: usize) -> std::ops::Range<usize> {
    k.saturating_sub(rows / 2)..(k + rows / 2 + 1).min(run.len())
}

fn middle(run: &[f64], k: usize, rows: usize) -> f64 {
    median(run[about(run, k, rows)].to_vec())
}

/// Squares of what the middle values of so many rows leave.
fn left_by(run: &[f64], rows: usize) -> f64 {
    (0..run.len()).map(|k| (run[k] - middle(run, k, rows)).powi(2)).sum()
}

/// The column that goes with a course most; its chance counts how many were tried, and how well they do turned round in time.
pub(super) fn matched(course: &[Option<f64>], scene: &Scene) -> Option<ColumnMatch> {
    let used: Vec<usize> = (0..course.len()).filter(|&row| course[row].is_some()).collect();
    let own = centred(used.iter().filter_map(|&row| course[row]).collect());
    let of = |name: &str| scene.variable(name).map(|v| centred(used.iter().map(|&row| v[row]).collect()));
    let names = ["depth", "temperature"].into_iter().chain(scene.columns.iter().map(String::as_str));
    let columns: Vec<(&str, Vec<f64>)> = names.filter_map(|name| Some((name, of(name)?))).collect();
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn a_switch_is_recovered_out_of_noise_as_large_as_itself_and_gaps_stay() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let truth = |row: usize| if (row / 70).is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let read: Vec<Option<f64>> = (0..1400).map(|row| (row % 300 > 3).then(|| truth(row) + noise())).collect();
        let course = recovered(&read);
        assert!(course.iter().zip(&read).all(|(a, b)| a.is_some() == b.is_some()));
        let off = course.iter().enumerate().filter_map(|(row, nt)| Some((nt.as_ref()? - truth(row)).powi(2)));
        let off: Vec<f64> = off.collect();
        assert!(off.iter().sum::<f64>() / (off.len() as f64) < 0.25);
    }
}
