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
/// Share of a course's power that the reading shows, from which on the course is drawn whole. Derived: an amplitude that is told from a
/// tenth of itself is one that the shape of the effect tells, not the recording.
const LEAST_SEEN: f64 = 0.01;
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

/// What is left, and the course of a proposed effect in it, nT, one value a row that is used. Beside 18 terms and background the
/// reading shows less of a course than there is, so it is drawn whole; but where they take nearly all of it, how large it is says
/// nothing that they could not say as well, and both are drawn as the reading shows them.
pub(super) fn with_proposed(left: &Left<'_>, course_nt: &[f64]) -> (Vec<Option<f64>>, Vec<Option<f64>>) {
    whole_or_shown(course_nt, without_level(left, course_nt), without_level(left, &[]))
}

/// Of what is left with the course taken off the reading before, and without.
fn whole_or_shown(
    course_nt: &[f64],
    taken_off: Vec<Option<f64>>,
    shown: Vec<Option<f64>>,
) -> (Vec<Option<f64>>, Vec<Option<f64>>) {
    let seen: Vec<Option<f64>> = shown.iter().zip(&taken_off).map(|(a, b)| Some((*a)? - (*b)?)).collect();
    let used = || course_nt.iter().zip(&seen).filter_map(|(nt, seen)| Some((*nt, (*seen)?)));
    let n = used().count().max(1) as f64;
    let mean = used().map(|(nt, _)| nt).sum::<f64>() / n;
    let whole = used().map(|(nt, _)| (nt - mean).powi(2)).sum::<f64>();
    if used().map(|(_, seen)| seen * seen).sum::<f64>() < LEAST_SEEN * whole {
        return (shown, seen);
    }
    let left_nt = taken_off.iter().zip(course_nt).map(|(left, nt)| left.map(|left| left + nt - mean));
    (left_nt.collect(), course_nt.iter().copied().map(Some).collect())
}

/// The residual of a plain fit without its background, nT, one value a row that is used; with a course taken off the reading before.
fn without_level(left: &Left<'_>, taken_nt: &[f64]) -> Vec<Option<f64>> {
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
    fn what_the_18_terms_take_nearly_all_of_is_drawn_as_the_reading_shows_it() {
        // Ten periods.
        let course: Vec<f64> = (0..628).map(|row| 40.0 * (0.1 * f64::from(row)).sin() + 7.0).collect();
        let noise: Vec<Option<f64>> =
            (0..628).map(|row| (row % 50 > 0).then(|| 0.1 * (2.3 * f64::from(row)).sin())).collect();
        let showing = |share: f64| -> Vec<Option<f64>> {
            noise.iter().zip(&course).map(|(noise, nt)| noise.map(|noise| noise + share * (nt - 7.0))).collect()
        };
        let most = |values: &[Option<f64>]| values.iter().flatten().fold(0.0_f64, |most, nt| most.max(nt.abs()));
        let (left, fitted) = whole_or_shown(&course, noise.clone(), showing(0.02));
        assert!(most(&left) < 1.0 && most(&fitted) < 0.85, "{} {}", most(&left), most(&fitted));
        let (left, fitted) = whole_or_shown(&course, noise.clone(), showing(0.5));
        assert!((most(&left) - 40.0).abs() < 1.0 && most(&fitted) > 46.0, "{} {}", most(&left), most(&fitted));
    }

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
