//! What needs no fit: readings that repeat exactly, and readings that are exact multiples of a step.

use crate::diagnosis::reconstruct::prepared::Table;
use crate::diagnosis::regression::projection::dot;

/// Multiples are looked for up to this many of the least differences between values.
const LEAST_STEPS: f64 = 4.0;
/// Share of the readings that must be multiples: all but what a damaged row holds.
const SHARE: f64 = 0.995;

/// Repeated scalar readings.
#[derive(Clone, Debug)]
pub(crate) struct Repeats {
    /// Rows that repeat the one before.
    pub(crate) rows: Vec<usize>,
    /// Probability of a repeat.
    pub(crate) probability: f64,
    /// Rows that could have been one.
    pub(crate) chances: usize,
    /// Twice the gain in log likelihood over chance.
    pub(crate) glrt: f64,
    /// The two halves of the recording.
    pub(crate) halves: [Half; 2],
}

/// Repeats of one half of a recording.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Half {
    pub(crate) chances: f64,
    pub(crate) repeats: f64,
    /// Power that repeats of all rows would make, and that the repeats there are have made, nT^2.
    pub(crate) power: f64,
    pub(crate) repeated_power: f64,
}

impl Half {
    /// Repeats over rows that could have been one.
    pub(crate) fn share(&self) -> f64 {
        self.repeats / self.chances.max(1.0)
    }
}

/// Repeats of the scalar, held against how often a reading comes out the same by chance: `change_nt` is what the model
/// expects of each row over the one before.
pub(crate) fn repeats(table: &Table, change_nt: &[f64]) -> Repeats {
    let pairs: Vec<usize> = (1..table.len())
        .filter(|&row| {
            table.usable[row] && table.usable[row - 1] && table.time_s[row] - table.time_s[row - 1] <= 0.15 + 1e-6
        })
        .collect();
    let is_repeat = |row: usize| table.scalar_nt[row] == table.scalar_nt[row - 1];
    let off = |row: usize| table.scalar_nt[row] - table.scalar_nt[row - 1] - change_nt[row];
    let mut sizes: Vec<f64> = pairs.iter().filter(|&&row| !is_repeat(row)).map(|&row| off(row).abs()).collect();
    let rows: Vec<usize> = pairs.iter().copied().filter(|&row| is_repeat(row)).collect();
    let chances = pairs.len();
    if rows.is_empty() || sizes.len() < 20 {
        return Repeats { rows, probability: 0.0, chances, glrt: 0.0, halves: [Half::default(); 2] };
    }
    let middle = sizes.len() / 2;
    let std_nt =
        (*sizes.select_nth_unstable_by(middle, f64::total_cmp).1 / 0.6745).max(0.3 * table.scalar_resolution_nt);
    // Chance that two readings come out the same where the model expects a change of so much.
    let by_chance = |row: usize| {
        let x = change_nt[row] / std_nt;
        (table.scalar_resolution_nt / std_nt * (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt())
            .clamp(1e-5, 0.9)
    };
    let chance: Vec<f64> = rows.iter().map(|&row| by_chance(row)).collect();
    let others = (chances - rows.len()) as f64;
    let log_likelihood =
        |p: f64| others * (1.0 - p).ln() + chance.iter().map(|q| (p + (1.0 - p) * q).ln()).sum::<f64>();
    let none: f64 = chance.iter().map(|q| q.ln()).sum();
    let mut probability = rows.len() as f64 / chances as f64;
    for _ in 0..200 {
        let repeated: f64 = chance.iter().map(|q| probability / (probability + (1.0 - probability) * q)).sum();
        probability = (repeated / chances as f64).clamp(1e-9, 0.999);
    }
    let glrt = 2.0 * (log_likelihood(probability) - none);
    let mut halves = [Half::default(); 2];
    for (at, &row) in pairs.iter().enumerate() {
        let half = &mut halves[usize::from(2 * at >= pairs.len())];
        let power = change_nt[row].powi(2) + std_nt.powi(2);
        half.chances += 1.0;
        half.power += power;
        if is_repeat(row) {
            half.repeats += 1.0;
            half.repeated_power += power;
        }
    }
    Repeats { rows, probability, chances, glrt, halves }
}

/// The grid that the fluxgate's components lie on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub(crate) step_nt: f64,
    /// Share of the values of the second half that lie on the grid of the first, and how many they are.
    pub(crate) held_out: f64,
    pub(crate) values: usize,
}

/// The step of which all fluxgate components are multiples, if it is much coarser than what they are written with.
pub(crate) fn grid(table: &Table) -> Option<Grid> {
    let written_nt = table.flux_resolution_nt;
    let values: Vec<f64> =
        (0..table.len()).filter(|&row| table.usable[row]).flat_map(|row| table.flux_nt[row]).collect();
    let step_nt = step_of(values.clone(), written_nt)?;
    let (first, second) = values.split_at(values.len() / 2);
    let held_out = step_of(first.to_vec(), written_nt).map_or(0.0, |step| on_grid(second, step, written_nt));
    Some(Grid { step_nt, held_out, values: second.len() })
}

/// Share of values that are multiples of a step.
fn on_grid(values: &[f64], step: f64, written_nt: f64) -> f64 {
    let off = |value: &f64| (value / step - (value / step).round()).abs() * step;
    values.iter().filter(|value| off(value) <= 1.01 * written_nt).count() as f64 / values.len().max(1) as f64
}

fn step_of(mut values: Vec<f64>, written_nt: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let mut differences: Vec<f64> =
        values.windows(2).map(|pair| pair[1] - pair[0]).filter(|d| *d > 0.5 * written_nt).collect();
    if differences.len() < 50 {
        return None;
    }
    differences.sort_by(f64::total_cmp);
    let least = differences[0];
    if least < LEAST_STEPS * written_nt {
        return None;
    }
    let step = refined(&values, least, written_nt)?;
    (on_grid(&values, step, written_nt) >= SHARE).then_some(step)
}

/// A step from differences of neighbours, then of ever larger values.
fn refined(values: &[f64], least: f64, written_nt: f64) -> Option<f64> {
    let mut step = least;
    let mut reach = least;
    // Each time, values so large that the step is known to a quarter of a multiple.
    for _ in 0..60 {
        let uncertainty = written_nt / reach * step;
        let limit = 0.2 * step * step / uncertainty.max(1e-15);
        let used: Vec<f64> = differences_up_to(values, limit);
        if used.is_empty() {
            return None;
        }
        let counts: Vec<f64> = used.iter().map(|value| (value / step).round()).collect();
        let next = dot(&used, &counts) / dot(&counts, &counts).max(1.0);
        let furthest = used.iter().copied().fold(0.0, f64::max);
        if (next - step).abs() < 1e-12 * step && furthest <= reach {
            return Some(next);
        }
        step = next;
        if furthest <= reach {
            return Some(step);
        }
        reach = furthest;
    }
    Some(step)
}

/// Sizes of values, or of their distances from the first, up to a limit.
fn differences_up_to(values: &[f64], limit: f64) -> Vec<f64> {
    let near: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|d| *d > 0.0 && *d <= limit).collect();
    let own: Vec<f64> =
        values.iter().map(|value| value.abs()).filter(|value| *value > 0.0 && *value <= limit).collect();
    near.into_iter().chain(own).collect()
}
