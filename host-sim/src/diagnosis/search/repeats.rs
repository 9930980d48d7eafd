//! Scalar readings that repeat the one before more often than rounding makes them: no fit is needed, they are equal.

use super::chance::{Change, Spread};
use crate::diagnosis::policy::REPEAT_LEAST_CHANGES;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::simulator::signals::LONGEST_STEP_S;

/// Iterations of the likeliest probability of a repeat.
const ITERATIONS: usize = 200;

/// Repeated scalar readings.
#[derive(Clone, Debug)]
pub(crate) struct Repeats {
    /// Rows that repeat the one before, and more likely so than by chance.
    pub(crate) rows: Vec<usize>,
    /// Probability of a repeat.
    pub(crate) probability: f64,
    /// Rows that could have been one, as far as rounding lets a repeat be told from chance.
    pub(crate) chances: f64,
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

    /// One more row that could be a repeat, the power of a repeat there, nT^2, and the probability that it is one.
    fn count(&mut self, power: f64, repeated: f64) {
        self.chances += 1.0;
        self.power += power;
        self.repeats += repeated;
        self.repeated_power += repeated * power;
    }
}

/// Repeats of the scalar, held against how often a reading comes out the same by chance: at each row `expected_nt` is the
/// change that the model expects over the row before, and `steps_nt` what the reading is rounded to. Of the rows that `is_known`
/// says the model knows.
pub(crate) fn repeats(table: &Prepared, steps_nt: &[f64], expected_nt: &[f64], is_known: &[bool]) -> Repeats {
    let rows = successive(table, is_known);
    let expected_nt = since_fresh(table, &rows, expected_nt);
    let change = |(&row, expected_nt): (&usize, f64)| Change {
        read_nt: table.scalar_nt[row] - table.scalar_nt[row - 1],
        expected_nt,
        step_nt: steps_nt[row].max(steps_nt[row - 1]),
    };
    let changes: Vec<Change> = rows.iter().zip(expected_nt).map(change).collect();
    let repeated = changes.iter().filter(|change| change.read_nt == 0.0).count();
    if repeated == 0 || changes.len() - repeated < REPEAT_LEAST_CHANGES {
        let chances = changes.len() as f64;
        return Repeats { rows: Vec::new(), probability: 0.0, chances, glrt: 0.0, halves: [Half::default(); 2] };
    }
    counted(&rows, &changes)
}

/// Of rows that changed, and of some that did not.
fn counted(rows: &[usize], changes: &[Change]) -> Repeats {
    let spread = Spread::of(changes);
    let by_chance: Vec<Option<f64>> =
        changes.iter().map(|change| (change.read_nt == 0.0).then(|| spread.chance_of_repeat(change))).collect();
    let likeliest = Likeliest::of(&by_chance.iter().flatten().copied().collect::<Vec<_>>(), changes.len() as f64);
    let repeated = |at: usize| by_chance[at].map_or(0.0, |chance| likeliest.repeated(chance));
    let mut halves = [Half::default(); 2];
    for (at, change) in changes.iter().enumerate() {
        let power = change.expected_nt.powi(2) + spread.std_nt.powi(2);
        halves[usize::from(2 * at >= changes.len())].count(power, repeated(at));
    }
    Repeats {
        rows: (0..rows.len()).filter(|&at| repeated(at) > 0.5).map(|at| rows[at]).collect(),
        probability: likeliest.probability,
        chances: likeliest.chances,
        glrt: likeliest.glrt,
        halves,
    }
}

/// What the model expects of each of some rows over the last reading that was another one, nT: of readings that repeat in a row each is as
/// old as the first.
fn since_fresh(table: &Prepared, rows: &[usize], expected_nt: &[f64]) -> Vec<f64> {
    let mut since = 0.0;
    let mut last = None;
    let of_row = |&row: &usize| {
        let is_run = row >= 2 && last == Some(row - 1) && table.scalar_nt[row - 1] == table.scalar_nt[row - 2];
        since = if is_run { since + expected_nt[row] } else { expected_nt[row] };
        last = Some(row);
        since
    };
    rows.iter().map(of_row).collect()
}

/// Known rows that follow a known one without a gap.
fn successive(table: &Prepared, is_known: &[bool]) -> Vec<usize> {
    let follows = |row: usize| table.time_s[row] - table.time_s[row - 1] <= LONGEST_STEP_S + 1e-6;
    (1..table.len()).filter(|&row| is_known[row] && is_known[row - 1] && follows(row)).collect()
}

/// The likeliest probability of a repeat.
struct Likeliest {
    probability: f64,
    /// Rows without chance repeats that would tell it as well.
    chances: f64,
    /// Twice the log likelihood ratio over chance alone.
    glrt: f64,
}

impl Likeliest {
    /// By expectation maximisation. `by_chance` is the chance of each repeat that was seen, among `rows`.
    fn of(by_chance: &[f64], rows: f64) -> Self {
        let others = rows - by_chance.len() as f64;
        let mut likeliest = Self { probability: by_chance.len() as f64 / rows, chances: rows, glrt: 0.0 };
        for _ in 0..ITERATIONS {
            let repeated: f64 = by_chance.iter().map(|&chance| likeliest.repeated(chance)).sum();
            likeliest.probability = (repeated / rows).clamp(1e-9, 0.999);
        }
        let p = likeliest.probability;
        let gain = |q: &f64| (p + (1.0 - p) * q).ln() - q.ln();
        likeliest.glrt = 2.0 * (others * (1.0 - p).ln() + by_chance.iter().map(gain).sum::<f64>());
        // The information about it, as that of so many rows of which each is a repeat or not.
        let of_repeat = |q: &f64| ((1.0 - q) / (p + (1.0 - p) * q)).powi(2);
        let information = others / (1.0 - p).powi(2) + by_chance.iter().map(of_repeat).sum::<f64>();
        likeliest.chances = information * p * (1.0 - p);
        likeliest
    }

    /// That a reading repeats the one before and does not come out the same by chance.
    fn repeated(&self, by_chance: f64) -> f64 {
        self.probability / (self.probability + (1.0 - self.probability) * by_chance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::policy::REPEATS_GLRT;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    const ROWS: usize = 4000;

    /// What is found in a reading at 10 Hz, of a recorder with this step, where the model expects `clean_nt` of each row.
    fn of_reading(scalar_nt: Vec<f64>, step_nt: f64, clean_nt: impl Fn(usize) -> f64) -> Repeats {
        let table = Prepared {
            time_s: (0..ROWS).map(|k| 0.1 * k as f64).collect(),
            scalar_nt,
            usable: vec![true; ROWS],
            ..Prepared::default()
        };
        let expected_nt: Vec<f64> =
            (0..ROWS).map(|row| if row == 0 { 0.0 } else { clean_nt(row) - clean_nt(row - 1) }).collect();
        repeats(&table, &[step_nt; ROWS], &expected_nt, &[true; ROWS])
    }

    /// What is found in a reading that swings by 20 nT in 7 s, of a recorder with this step, of which this share of the rows
    /// repeats the one before.
    fn found(step_nt: f64, noise_nt: f64, share: f64, seed: u64) -> (Repeats, usize) {
        let draw = &mut ChaCha8Rng::seed_from_u64(seed);
        let clean_nt: Vec<f64> = (0..ROWS).map(|k| 20.0 * (0.09 * k as f64).sin()).collect();
        let noise = Normal::new(50_000.0, noise_nt).unwrap();
        let mut scalar_nt: Vec<f64> =
            clean_nt.iter().map(|nt| ((nt + noise.sample(draw)) / step_nt).round() * step_nt).collect();
        let mut repeated = 0;
        for row in 1..ROWS {
            if draw.random::<f64>() < share {
                scalar_nt[row] = scalar_nt[row - 1];
                repeated += 1;
            }
        }
        (of_reading(scalar_nt, step_nt, |row| clean_nt[row]), repeated)
    }

    #[test]
    fn what_rounding_repeats_is_no_finding() {
        for (seed, step_nt) in [0.001, 0.01, 0.03, 0.1, 0.3].into_iter().enumerate() {
            for noise_nt in [0.02, 0.1] {
                let (repeats, _) = found(step_nt, noise_nt, 0.0, seed as u64);
                assert!(repeats.glrt < 0.3 * REPEATS_GLRT, "{step_nt} {noise_nt}: {repeats:?}");
            }
        }
    }

    #[test]
    fn what_is_repeated_beyond_it_is_found_with_its_probability() {
        for (seed, step_nt) in [0.001, 0.01, 0.03].into_iter().enumerate() {
            let (repeats, repeated) = found(step_nt, 0.05, 0.03, 10 + seed as u64);
            assert!(repeats.glrt > 10.0 * REPEATS_GLRT, "{step_nt}: {}", repeats.glrt);
            let error = (0.03 * 0.97 / repeats.chances).sqrt();
            assert!((repeats.probability - 0.03).abs() < 3.0 * error, "{step_nt}: {}", repeats.probability);
            assert!(repeats.rows.len().abs_diff(repeated) < repeated / 5, "{} {repeated}", repeats.rows.len());
            assert!(repeats.chances <= ROWS as f64);
        }
    }

    #[test]
    fn of_readings_that_repeat_in_a_row_each_is_as_old_as_the_first() {
        // By 1 nT a row, then none from row to row: the second repeat is told by the age of the reading alone.
        let clean_nt = |row: usize| if row % 20 < 10 { (row % 20) as f64 } else { 10.0 };
        let mut scalar_nt: Vec<f64> =
            (0..ROWS).map(|row| 50_000.0 + clean_nt(row) + 0.001 * ((row * row) % 17) as f64).collect();
        (10..ROWS).step_by(200).for_each(|row| (row..row + 3).for_each(|row| scalar_nt[row] = scalar_nt[row - 1]));
        let found = of_reading(scalar_nt, 0.001, clean_nt);
        let expected: Vec<usize> = (10..ROWS).step_by(200).flat_map(|row| row..row + 3).collect();
        assert_eq!(found.rows, expected);
    }
}
