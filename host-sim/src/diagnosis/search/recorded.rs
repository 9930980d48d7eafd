//! Recorded columns that may carry a gap: the currents of loads. Each is tried in full, without whitening: what a model of
//! the noise takes for its colour may be what a load does all the time, and an edge that is a row late has nothing of its
//! whitened self. Whether a column explains more than chance is told by the column itself, turned round in time.

use crate::diagnosis::evidence::folds::{Part, parts, training};
use crate::diagnosis::evidence::interval::TWO_SIGMA;
use crate::diagnosis::evidence::shrink::{GapClosed, share as excess_share};
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::low_pass;
use crate::diagnosis::policy::{
    ASKED_SHIFT_ROWS, COLUMN_BEYOND_TURNED, COLUMN_DIRECTED_GAIN, COLUMN_LAGS_S, COLUMN_LEAST_SHARE, COLUMN_LENGTHS_S,
    COLUMN_SHIFTS_ROWS, COLUMN_TURNS, EPOCH_S, HELD_OUT_FOLDS, MOST_NOISE_NT2_PER_HZ, RATE_HZ,
};
use crate::diagnosis::regression::problem::{RegressionProblem, solve};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::result::{ColumnForm, ColumnWay};
use crate::effects::{Recorded, RecordedForm};

/// How much the errors of such a fit are larger than those of white noise: what is left of it is anything but white. Set by
/// hand.
const ERRORS: f64 = 3.0;

/// Samples of the parts that a fold holds out: a second, as switches may be on for a few. With one size or three that are
/// fitted, neighbours that are alike do no harm.
const PART_SAMPLES: usize = 10;

/// A recorded column that explains a part of the gap.
#[derive(Clone, Debug)]
pub(crate) struct RecordedColumn {
    pub(crate) term: Term,
    pub(crate) way: ColumnWay,
    /// Half of the 95 % interval of each coordinate.
    pub(crate) half_widths: Vec<f64>,
    pub(crate) closed: GapClosed,
    /// What it adds at each row, nT.
    pub(crate) column_nt: Vec<f64>,
    /// Root of what it explains over what it leaves, per sample, and their number: standard deviations.
    pub(crate) strength: f64,
}

/// The column that explains most of what the 18 terms leave of the scalar, if it is more than chance; `known_nt` is taken off
/// before. `effects` are those that a recorded column drives; `noise_nt` is the rms of the noise.
pub(crate) fn recorded_column(
    problem: &RegressionProblem<'_>,
    effects: &[usize],
    known_nt: &[f64],
    noise_nt: f64,
) -> Option<RecordedColumn> {
    if effects.is_empty() {
        return None;
    }
    let plains = COLUMN_LENGTHS_S.map(|length_s| Plain::new(problem, known_nt, length_s, noise_nt));
    let tried = effects.iter().flat_map(|&effect| plains.iter().map(move |plain| (effect, plain)));
    let tried = tried.flat_map(|(effect, plain)| {
        ways(problem, effect).into_iter().map(move |(lag_s, rows)| (effect, plain, lag_s, rows))
    });
    let best = tried
        .filter_map(|(effect, plain, lag_s, rows)| {
            let at = vec![0.0; problem.library[effect].spec().parameters.len()];
            let raw = regressors(&*problem.library[effect], &problem.signals, &at);
            let raw: Vec<Vec<f64>> = raw.iter().map(|column| late(&shifted(column, rows), lag_s)).collect();
            let lateness_s = [f64::from(rows) * EPOCH_S, lag_s];
            Some((plain.share(&raw, 0)?, plain.likelier(problem, effect, &raw, lateness_s), plain, raw))
        })
        .max_by(|a, b| a.1.closed.fraction.total_cmp(&b.1.closed.fraction))?;
    let (share, found, plain, raw) = best;
    let rows = problem.signals.len();
    let turned = (1..COLUMN_TURNS).filter_map(|turn| plain.share(&raw, rows * turn / COLUMN_TURNS)).fold(0.0, f64::max);
    let is_found = share.min(found.closed.fraction) >= COLUMN_LEAST_SHARE && share >= COLUMN_BEYOND_TURNED * turned;
    is_found.then_some(found)
}

/// Low-passes, s, and shifts, rows, with which a column is tried.
fn ways(problem: &RegressionProblem<'_>, effect: usize) -> Vec<(f64, i32)> {
    match problem.library[effect].recorded() {
        Some(Recorded { is_asked: true, .. }) => {
            (-ASKED_SHIFT_ROWS..=ASKED_SHIFT_ROWS).map(|rows| (0.0, rows)).collect()
        }
        _ => COLUMN_LAGS_S.into_iter().flat_map(|lag_s| COLUMN_SHIFTS_ROWS.map(move |rows| (lag_s, rows))).collect(),
    }
}

/// The effect of the same column that adds whatever the attitude, if it is one of its own.
fn additive_of(problem: &RegressionProblem<'_>, effect: usize) -> Option<usize> {
    let column = problem.library[effect].recorded()?.column;
    let is_it = |other: &Recorded| other.form == RecordedForm::Additive && other.column == column;
    problem.library.iter().position(|other| other.recorded().as_ref().is_some_and(is_it))
}

/// A column so many rows later; what stands at an end goes on beyond it.
fn shifted(column: &[f64], rows: i32) -> Vec<f64> {
    let last = column.len().saturating_sub(1) as i64;
    (0..=last).map(|row| column[(row - i64::from(rows)).clamp(0, last) as usize]).collect()
}

/// A column as it comes through a first-order low-pass of this time constant, s.
fn late(column: &[f64], lag_s: f64) -> Vec<f64> {
    let keep = if lag_s > 0.0 { (-1.0 / (RATE_HZ * lag_s)).exp() } else { 0.0 };
    low_pass(column.iter().copied(), keep)
}

fn identity() -> [Vec<f64>; 3] {
    [vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0]]
}

/// The course of a current as it adds to the field whatever the attitude, for a unit along the mean direction, and the moment
/// that this stands for.
fn along_mean(problem: &RegressionProblem<'_>, raw: &[Vec<f64>]) -> (Vec<f64>, [f64; 3]) {
    let directions = &problem.signals.rows().direction;
    let mean = [0, 1, 2].map(|i| directions.iter().map(|c| c[i]).sum::<f64>() / directions.len().max(1) as f64);
    let square: f64 = mean.iter().map(|x| x * x).sum::<f64>().max(f64::MIN_POSITIVE);
    // What the current adds along each axis is it times a cosine, and the cosines' squares sum up to 1.
    let course = |row: usize| (0..3).map(|i| raw[i][row] * directions[row][i]).sum::<f64>();
    ((0..directions.len()).map(course).collect(), mean.map(|x| x / square))
}

/// The scalar without background and 18 terms, as it is.
struct Plain {
    whitening: Whitening,
    terms: Projection,
    left: Vec<f64>,
    /// Variance of the sensor's noise, nT^2.
    noise_nt2: f64,
}

impl Plain {
    fn new(problem: &RegressionProblem<'_>, known_nt: &[f64], length_s: f64, noise_nt: f64) -> Self {
        let blocks = recut(problem.whitening.blocks(), (length_s * RATE_HZ) as usize);
        let whitening = Whitening::new(&blocks, Predictor::white(1.0), None);
        let terms = problem.nuisance_columns.iter().map(|column| whitening.apply(column)).collect::<Vec<_>>();
        let terms = Projection::of(&terms);
        let reading: Vec<f64> = problem.reading_nt().iter().zip(known_nt).map(|(nt, known)| nt - known).collect();
        let mut left = whitening.apply(&reading);
        terms.project_out(&mut left);
        Self { whitening, terms, left, noise_nt2: (noise_nt * noise_nt).min(MOST_NOISE_NT2_PER_HZ * 0.5 * RATE_HZ) }
    }

    /// Columns turned round by some rows, as they are left by background and 18 terms.
    fn projected(&self, raw: &[Vec<f64>], by: usize) -> Vec<Vec<f64>> {
        let one = |column: &Vec<f64>| {
            let mut turned = column.clone();
            turned.rotate_right(by);
            let mut projected = self.whitening.apply(&turned);
            self.terms.project_out(&mut projected);
            projected
        };
        raw.iter().map(one).collect()
    }

    /// Share of what is left that columns explain; none where there is nothing.
    fn share(&self, raw: &[Vec<f64>], by: usize) -> Option<f64> {
        let all = dot(&self.left, &self.left);
        let (explained, _, rank) = solve(&self.projected(raw, by), &self.left);
        (rank > 0 && all > 0.0).then(|| explained / all)
    }

    /// As it adds along the field's direction, or as it adds to the field whatever the attitude: a moment in three directions is
    /// told only where the body turned while the current changed.
    /// `raw` is that late and through that low-pass, s.
    fn likelier(
        &self,
        problem: &RegressionProblem<'_>,
        effect: usize,
        raw: &[Vec<f64>],
        [delay_s, time_constant_s]: [f64; 2],
    ) -> RecordedColumn {
        let way = |form| ColumnWay { form, delay_s, time_constant_s };
        let directed = self.found(effect, raw, &identity(), way(ColumnForm::AlongField));
        let (along, mean) = along_mean(problem, raw);
        let additive = match additive_of(problem, effect) {
            Some(additive) => self.found(additive, &[along], &[vec![1.0]], way(ColumnForm::Additive)),
            None => self.found(effect, &[along], &[mean.to_vec()], way(ColumnForm::Additive)),
        };
        if directed.closed.fraction > additive.closed.fraction + COLUMN_DIRECTED_GAIN { directed } else { additive }
    }

    /// Each column is a unit of one of these moments: as many numbers as the effect has linear parameters.
    fn found(&self, effect: usize, raw: &[Vec<f64>], moments: &[Vec<f64>], way: ColumnWay) -> RecordedColumn {
        let columns = self.projected(raw, 0);
        let projection = Projection::of(&columns);
        let coordinates = projection.solve(&self.left);
        let sum = |columns: &[Vec<f64>], k: usize| columns.iter().zip(&coordinates).map(|(c, x)| c[k] * x).sum::<f64>();
        let left: f64 = (0..self.left.len()).map(|k| (self.left[k] - sum(&columns, k)).powi(2)).sum();
        let mean_square = left / self.left.len() as f64;
        let errors = projection.covariance().diagonal() * mean_square;
        let explained = dot(&self.left, &self.left) - left;
        let moment = |i: usize| coordinates.iter().zip(moments).map(|(size, moment)| size * moment[i]).sum::<f64>();
        let square =
            |i: usize| errors.iter().zip(moments).map(|(error, moment)| error * moment[i] * moment[i]).sum::<f64>();
        RecordedColumn {
            way,
            half_widths: (0..moments[0].len()).map(|i| ERRORS * TWO_SIGMA * square(i).sqrt()).collect(),
            closed: self.closed(&columns),
            column_nt: (0..raw[0].len()).map(|row| sum(raw, row)).collect(),
            strength: (explained / mean_square.max(f64::MIN_POSITIVE)).sqrt() / ERRORS,
            term: Term {
                effect,
                at: vec![0.0; moments[0].len()],
                coordinates: (0..moments[0].len()).map(moment).collect(),
            },
        }
    }

    /// Share of the excess over the noise of a sensor that columns close on parts that they are not fitted to.
    fn closed(&self, columns: &[Vec<f64>]) -> GapClosed {
        let all = 0..self.left.len();
        let parts = parts(std::slice::from_ref(&all), PART_SAMPLES);
        let folds: Vec<f64> = (0..HELD_OUT_FOLDS).map(|fold| self.after(columns, &parts, fold)).collect();
        let before = dot(&self.left, &self.left);
        let noise = self.noise_nt2 * self.whitening.dof();
        let total: f64 = folds.iter().sum();
        // The parts that a fold holds out stand for all: their spread is the doubt.
        let mean = total / HELD_OUT_FOLDS as f64;
        let spread =
            (folds.iter().map(|after| (after - mean).powi(2)).sum::<f64>() / (HELD_OUT_FOLDS - 1) as f64).sqrt();
        let half = TWO_SIGMA * spread * (HELD_OUT_FOLDS as f64).sqrt() / before.max(f64::MIN_POSITIVE);
        let fraction = excess_share(before - total, before - noise);
        GapClosed { fraction, ci95: [fraction - half * fraction, (fraction + half).min(1.0)], held_out: true }
    }

    /// Sum of the squares that columns leave of the parts of a fold, fitted to the others.
    fn after(&self, columns: &[Vec<f64>], parts: &[Part], fold: usize) -> f64 {
        let training = |column: &[f64]| training(parts, column, fold);
        let fitted = Projection::of(&columns.iter().map(|column| training(column)).collect::<Vec<_>>());
        let sizes = fitted.solve(&training(&self.left));
        let off =
            |k: usize| self.left[k] - columns.iter().zip(&sizes).map(|(column, size)| column[k] * size).sum::<f64>();
        let out = parts.iter().filter(|part| part.fold == fold);
        out.flat_map(|part| part.samples.clone()).map(|k| off(k).powi(2)).sum()
    }
}

/// Blocks of about another length in the same rows.
fn recut(blocks: &[Block], length: usize) -> Vec<Block> {
    let mut stretches: Vec<Block> = Vec::new();
    for block in blocks {
        match stretches.last_mut() {
            Some(last) if last.rows.end == block.rows.start && block.targets.is_empty() && last.targets.is_empty() => {
                let before = last.len();
                last.missing.extend(block.missing.iter().map(|at| at + before));
                last.rows.end = block.rows.end;
            }
            _ => stretches.push(block.clone()),
        }
    }
    let cut = |stretch: &Block| -> Vec<Block> {
        let parts = if stretch.targets.is_empty() { (stretch.len() / length).max(1) } else { 1 };
        let edge = |part: usize| stretch.len() * part / parts;
        let part = |part: usize| Block {
            rows: stretch.rows.start + edge(part)..stretch.rows.start + edge(part + 1),
            missing: stretch
                .missing
                .iter()
                .filter(|at| (edge(part)..edge(part + 1)).contains(*at))
                .map(|at| at - edge(part))
                .collect(),
            targets: if parts == 1 { stretch.targets.clone() } else { Vec::new() },
        };
        (0..parts).map(part).collect()
    };
    stretches.iter().flat_map(cut).collect()
}
