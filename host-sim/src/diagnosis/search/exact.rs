//! What needs no fit: readings that repeat exactly, and readings that are exact multiples of a step.

use crate::diagnosis::numerics::median;
use crate::diagnosis::policy::{
    CHANCE_OF_REPEAT, GRID_LEAST_DIFFERENCES, GRID_LEAST_SHARE, GRID_LEAST_STEPS, REPEAT_LEAST_CHANGES,
    REPEAT_LEAST_STEP_SHARE,
};
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::projection::dot;
use crate::simulator::signals::LONGEST_STEP_S;

/// Iterations of the likeliest probability of a repeat, and of the likeliest step.
const PROBABILITY_ITERATIONS: usize = 200;
const STEP_ITERATIONS: usize = 60;

/// Repeated scalar readings.
#[derive(Clone, Debug)]
pub(crate) struct Repeats {
    /// Rows that repeat the one before.
    pub(crate) rows: Vec<usize>,
    /// Probability of a repeat.
    pub(crate) probability: f64,
    /// Rows that could have been one.
    pub(crate) chances: usize,
    /// Twice the log likelihood ratio over chance.
    pub(crate) glrt: f64,
    /// The two halves of the recording.
    pub(crate) halves: [Half; 2],
}

/// Repeats of one half of a recording.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Half {
    pub(crate) chances: f64,
    pub(crate) repeats: f64,
    /// Power that repeats of all rows would make, and that of the rows that are repeats, nT^2.
    pub(crate) power: f64,
    pub(crate) repeated_power: f64,
}

impl Half {
    /// Repeats over rows that could have been one.
    pub(crate) fn share(&self) -> f64 {
        self.repeats / self.chances.max(1.0)
    }

    /// One more row that could be a repeat, and the power of a repeat there, nT^2.
    fn count(&mut self, power: f64, is_repeat: bool) {
        self.chances += 1.0;
        self.power += power;
        if is_repeat {
            self.repeats += 1.0;
            self.repeated_power += power;
        }
    }
}

/// Repeats of the scalar, held against how often a reading comes out the same by chance: `change_nt` is what the model
/// expects of each row over the one before.
pub(crate) fn repeats(table: &Prepared, change_nt: &[f64]) -> Repeats {
    let pairs = successive(table);
    let chances = pairs.len();
    let (rows, changed): (Vec<usize>, Vec<usize>) = pairs.iter().copied().partition(|&row| is_repeat(table, row));
    if rows.is_empty() || changed.len() < REPEAT_LEAST_CHANGES {
        return Repeats { rows, probability: 0.0, chances, glrt: 0.0, halves: [Half::default(); 2] };
    }
    let std_nt = std_of_changes_nt(table, change_nt, &changed);
    let resolution = table.scalar_resolution_nt / std_nt;
    let by_chance: Vec<f64> = rows.iter().map(|&row| chance_of_repeat(change_nt[row] / std_nt, resolution)).collect();
    let (probability, glrt) = likeliest(&by_chance, chances);
    let mut halves = [Half::default(); 2];
    for (at, &row) in pairs.iter().enumerate() {
        let power = change_nt[row].powi(2) + std_nt.powi(2);
        halves[usize::from(2 * at >= chances)].count(power, is_repeat(table, row));
    }
    Repeats { rows, probability, chances, glrt, halves }
}

/// Usable rows that follow a usable one without a gap.
fn successive(table: &Prepared) -> Vec<usize> {
    let follows = |row: usize| table.time_s[row] - table.time_s[row - 1] <= LONGEST_STEP_S + 1e-6;
    (1..table.len()).filter(|&row| table.usable[row] && table.usable[row - 1] && follows(row)).collect()
}

fn is_repeat(table: &Prepared, row: usize) -> bool {
    table.scalar_nt[row] == table.scalar_nt[row - 1]
}

/// Standard deviation of the change from row to row about what the model expects, nT: from its median size, which is
/// 0.6745 of it for a normal variable.
fn std_of_changes_nt(table: &Prepared, change_nt: &[f64], rows: &[usize]) -> f64 {
    let off_nt = |&row: &usize| (table.scalar_nt[row] - table.scalar_nt[row - 1] - change_nt[row]).abs();
    let median_nt = median(rows.iter().map(off_nt).collect());
    (median_nt / 0.6745).max(REPEAT_LEAST_STEP_SHARE * table.scalar_resolution_nt)
}

/// Chance that two readings come out the same where the model expects a change of so much; change and resolution over the
/// standard deviation of the change.
fn chance_of_repeat(change: f64, resolution: f64) -> f64 {
    let density = resolution * (-0.5 * change * change).exp() / (2.0 * std::f64::consts::PI).sqrt();
    density.clamp(CHANCE_OF_REPEAT[0], CHANCE_OF_REPEAT[1])
}

/// The likeliest probability of a repeat, and twice the log likelihood ratio over chance alone: by expectation
/// maximisation. `by_chance` is the chance of each repeat that was seen, among `chances` rows.
fn likeliest(by_chance: &[f64], chances: usize) -> (f64, f64) {
    let others = (chances - by_chance.len()) as f64;
    let log_likelihood =
        |p: f64| others * (1.0 - p).ln() + by_chance.iter().map(|q| (p + (1.0 - p) * q).ln()).sum::<f64>();
    let none: f64 = by_chance.iter().map(|q| q.ln()).sum();
    let mut probability = by_chance.len() as f64 / chances as f64;
    for _ in 0..PROBABILITY_ITERATIONS {
        let repeated: f64 = by_chance.iter().map(|q| probability / (probability + (1.0 - probability) * q)).sum();
        probability = (repeated / chances as f64).clamp(1e-9, 0.999);
    }
    (probability, 2.0 * (log_likelihood(probability) - none))
}

/// The grid that the fluxgate's components lie on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuantisationGrid {
    pub(crate) step_nt: f64,
    /// Share of the values of the second half that lie on the grid of the first, and how many they are.
    pub(crate) held_out: f64,
    pub(crate) values: usize,
}

/// The step of which all fluxgate components are multiples, if it is much coarser than what they are written with.
pub(crate) fn quantisation_grid(table: &Prepared) -> Option<QuantisationGrid> {
    let resolution_nt = table.flux_resolution_nt;
    let values: Vec<f64> =
        (0..table.len()).filter(|&row| table.usable[row]).flat_map(|row| table.flux_nt[row]).collect();
    let step_nt = step_of(values.clone(), resolution_nt)?;
    let (first, second) = values.split_at(values.len() / 2);
    let held_out = step_of(first.to_vec(), resolution_nt).map_or(0.0, |step| on_grid(second, step, resolution_nt));
    Some(QuantisationGrid { step_nt, held_out, values: second.len() })
}

/// Share of values that are multiples of a step.
fn on_grid(values: &[f64], step: f64, resolution: f64) -> f64 {
    let off = |value: &f64| (value / step - (value / step).round()).abs() * step;
    values.iter().filter(|value| off(value) <= 1.01 * resolution).count() as f64 / values.len().max(1) as f64
}

/// The step of which nearly all values are multiples, if it is much coarser than their resolution.
fn step_of(mut values: Vec<f64>, resolution: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let mut differences: Vec<f64> =
        values.windows(2).map(|pair| pair[1] - pair[0]).filter(|d| *d > 0.5 * resolution).collect();
    if differences.len() < GRID_LEAST_DIFFERENCES {
        return None;
    }
    differences.sort_by(f64::total_cmp);
    let least = differences[0];
    if least < GRID_LEAST_STEPS * resolution {
        return None;
    }
    let step = refined(&values, least, resolution)?;
    (on_grid(&values, step, resolution) >= GRID_LEAST_SHARE).then_some(step)
}

/// A step that fits all sorted values, from their least difference: least squares over ever larger values, each time as
/// large as the step is known well enough to count its multiples in them.
fn refined(values: &[f64], least: f64, resolution: f64) -> Option<f64> {
    let mut step = least;
    let mut reach = least;
    for _ in 0..STEP_ITERATIONS {
        let used = sizes_up_to(values, countable_up_to(step, reach, resolution));
        if used.is_empty() {
            return None;
        }
        let counts: Vec<f64> = used.iter().map(|value| (value / step).round()).collect();
        step = dot(&used, &counts) / dot(&counts, &counts).max(1.0);
        let furthest = used.iter().copied().fold(0.0, f64::max);
        if furthest <= reach {
            break;
        }
        reach = furthest;
    }
    Some(step)
}

/// The largest value of which the number of steps is certain, to a fifth of a step, when the step was found from values
/// up to `reach`.
fn countable_up_to(step: f64, reach: f64, resolution: f64) -> f64 {
    let uncertainty = resolution / reach * step;
    0.2 * step * step / uncertainty.max(1e-15)
}

/// Differences of neighbours among sorted values, and sizes of the values themselves, up to a limit.
fn sizes_up_to(values: &[f64], limit: f64) -> Vec<f64> {
    let differences = values.windows(2).map(|pair| pair[1] - pair[0]);
    let sizes = values.iter().map(|value| value.abs());
    differences.chain(sizes).filter(|size| *size > 0.0 && *size <= limit).collect()
}
