//! What needs no fit: readings that repeat exactly, and readings that are exact multiples of a step.

use super::input::Table;
use super::span::dot;

/// Multiples are looked for up to this many of the least differences between values.
const LEAST_STEPS: f64 = 4.0;
/// Share of the readings that must be multiples: all but what a damaged row holds.
const SHARE: f64 = 0.995;

/// Repeated scalar readings.
#[derive(Clone, Debug)]
pub(super) struct Repeats {
    /// Rows that repeat the one before.
    pub(super) rows: Vec<usize>,
    /// Probability of a repeat.
    pub(super) probability: f64,
    /// Rows that could have been one.
    pub(super) chances: usize,
    /// Twice the gain in log likelihood over chance.
    pub(super) gain: f64,
}

/// Repeats of the scalar, held against how often a reading comes out the same by chance: `change_nt` is what the model
/// expects of each row over the one before.
pub(super) fn repeats(table: &Table, change_nt: &[f64]) -> Repeats {
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
        return Repeats { rows, probability: 0.0, chances, gain: 0.0 };
    }
    let middle = sizes.len() / 2;
    let std_nt =
        (*sizes.select_nth_unstable_by(middle, f64::total_cmp).1 / 0.6745).max(0.3 * table.scalar_resolution_nt);
    // Chance that two readings come out the same where the model expects a change of so much.
    let by_chance = |row: usize| {
        let x = change_nt[row] / std_nt;
        (table.scalar_resolution_nt / std_nt * (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt())
            .clamp(1e-12, 0.9)
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
    let gain = 2.0 * (log_likelihood(probability) - none);
    Repeats { rows, probability, chances, gain }
}

/// The step of which all fluxgate components are multiples, nT, if it is much coarser than what they are written with.
pub(super) fn step_nt(table: &Table) -> Option<f64> {
    let mut values: Vec<f64> =
        (0..table.len()).filter(|&row| table.usable[row]).flat_map(|row| table.flux_nt[row]).collect();
    values.sort_by(f64::total_cmp);
    let written_nt = table.flux_resolution_nt;
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
    let multiples =
        values.iter().filter(|value| (*value / step - (*value / step).round()).abs() * step <= 1.01 * written_nt);
    (multiples.count() as f64 >= SHARE * values.len() as f64).then_some(step)
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
