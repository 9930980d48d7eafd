//! What follows the motion of the body, smoothly, late, or by its history: no noise, however long it lasts and however loud it
//! is. The colour of the noise is told from what such columns leave.

use std::f64::consts::PI;

use super::blocks::Block;
use super::periodogram::{Periodogram, periodograms};
use super::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::low_pass;
use crate::diagnosis::policy::{EPOCH_S, MOTION_SAMPLES_PER_COLUMN};
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::search::{CUBIC_AND_QUARTIC, monomials};
use crate::simulator::signals::{Signals, tolles_lawson};

/// Cosines of time that a permanent magnetisation or a delay may follow, half periods over the recording.
const WANDERING_DEGREES: std::ops::RangeInclusive<i32> = 1..=6;
/// Memories of the direction: share of the low-pass' state that stays from row to row (time constants of 1 and 3 s).
const MEMORIES: [f64; 2] = [0.9, 0.97];
/// Rates at which a column that follows the sense of the change saturates, 1/s: alone, and times the direction.
const SENSE_RATES_PER_S: [f64; 2] = [0.02, 0.05];

/// Anything smooth in the direction, and a permanent magnetisation that wanders.
pub(crate) fn attitude_columns(signals: &Signals) -> Vec<Vec<f64>> {
    let direction = &signals.rows().direction;
    let mut columns = monomials(direction, CUBIC_AND_QUARTIC);
    for i in 0..3 {
        columns.extend(wandering(signals, &component(direction, i)));
    }
    columns
}

/// What remembers earlier attitudes: low-passes of the direction, and the sense in which it changes.
pub(crate) fn memory_columns(signals: &Signals) -> Vec<Vec<f64>> {
    let (direction, rate) = (&signals.rows().direction, &signals.rows().direction_rate);
    let [alone_per_s, times_direction_per_s] = SENSE_RATES_PER_S;
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for i in 0..3 {
        columns.extend(MEMORIES.map(|keep| low_pass(direction.iter().map(|c| c[i]), keep)));
        columns.push(rate.iter().map(|r| (r[i] / alone_per_s).tanh()).collect());
        for j in 0..3 {
            columns
                .push(rate.iter().zip(direction).map(|(r, c)| (r[i] / times_direction_per_s).tanh() * c[j]).collect());
        }
    }
    columns
}

/// What a reading adds that is late, or smeared, all the time or for a while.
fn delay_columns(signals: &Signals) -> Vec<Vec<f64>> {
    let [rate, bend] = slope_and_bend(signals);
    let wandering = [&rate, &bend].map(|column| wandering(signals, column));
    [rate, bend].into_iter().chain(wandering.into_iter().flatten()).collect()
}

/// First and second difference of the scalar.
pub(crate) fn slope_and_bend(signals: &Signals) -> [Vec<f64>; 2] {
    let scalar_nt = signals.scalar_at_rows_nt();
    let last = scalar_nt.len() - 1;
    let beside = |row: usize| (scalar_nt[row.saturating_sub(1)], scalar_nt[(row + 1).min(last)]);
    let rate: Vec<f64> = (0..=last).map(|row| (beside(row).1 - beside(row).0) / (2.0 * EPOCH_S)).collect();
    let bend = |row: usize| beside(row).0 + beside(row).1 - 2.0 * scalar_nt[row];
    [rate, (0..=last).map(bend).collect()]
}

/// What follows the motion at once: attitude, its rate, and the reading's slope and bend, all as angles, rad, with at most the
/// noise of the attitude.
pub(crate) fn local_columns(signals: &Signals) -> Vec<Vec<f64>> {
    let rows = signals.rows();
    let attitude: Vec<Vec<f64>> = (0..3).map(|i| component(&rows.direction, i)).collect();
    // A difference over two rows has at most the noise of the attitude, over their time.
    let rates = (0..3).map(|i| scaled(&component(&rows.direction_rate, i), EPOCH_S));
    let size = |columns: &[Vec<f64>]| columns.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    let rates: Vec<Vec<f64>> = rates.collect();
    // The reading changes by as much as the attitude does, on the whole.
    let as_angle =
        |column: Vec<f64>| scaled(&column, size(&rates) / size(std::slice::from_ref(&column)).max(f64::MIN_POSITIVE));
    let slope_and_bend = slope_and_bend(signals).map(as_angle);
    attitude.into_iter().chain(rates.iter().cloned()).chain(slope_and_bend).collect()
}

fn scaled(column: &[f64], by: f64) -> Vec<f64> {
    column.iter().map(|x| by * x).collect()
}

/// The 18 terms, which the constant and quadratic parts of the direction are among.
fn term_columns(signals: &Signals) -> Vec<Vec<f64>> {
    let rows = signals.rows();
    let values = |row: usize| tolles_lawson::columns(1.0, rows.direction[row], rows.direction_rate[row]);
    let by_row: Vec<_> = (0..signals.len()).map(values).collect();
    (0..towmag::model::TERMS).map(|term| by_row.iter().map(|row| row[term]).collect()).collect()
}

fn component(vectors: &[[f64; 3]], i: usize) -> Vec<f64> {
    vectors.iter().map(|vector| vector[i]).collect()
}

/// A column times slow cosines of time.
fn wandering(signals: &Signals, column: &[f64]) -> Vec<Vec<f64>> {
    let (epochs_s, last_s) = (signals.epochs_s(), signals.epochs_s().last().copied().unwrap_or(0.0).max(1.0));
    let times = |degree: i32| {
        let cosine = |time_s: &f64| (PI * f64::from(degree) * time_s / last_s).cos();
        column.iter().zip(epochs_s).map(|(x, time_s)| x * cosine(time_s)).collect()
    };
    WANDERING_DEGREES.map(times).collect()
}

/// The space of columns that follow the motion, beside the background.
#[derive(Clone, Debug)]
pub(crate) struct MotionSpan {
    plain: Whitening,
    span: Projection,
    /// Share of the power of white noise that background and targets leave at each frequency, of each periodogram of the blocks.
    left_by_background: Vec<Vec<f64>>,
    /// The same of what the span leaves of that.
    left: Vec<Vec<f64>>,
}

impl MotionSpan {
    /// Nothing but the background.
    pub(crate) fn none(blocks: &[Block]) -> Self {
        let plain = Whitening::new(blocks, Predictor::white(1.0), None);
        let left = left_by_background(&plain);
        Self { plain, span: Projection::default(), left: left.clone(), left_by_background: left }
    }

    /// Of the motion in some blocks: as many columns as the samples bear.
    pub(crate) fn of(signals: &Signals, blocks: &[Block]) -> Self {
        let plain = Whitening::new(blocks, Predictor::white(1.0), None);
        let groups = [term_columns, delay_columns, attitude_columns, memory_columns];
        let most = plain.samples() / MOTION_SAMPLES_PER_COLUMN;
        let columns = groups.iter().flat_map(|columns| columns(signals)).take(most);
        let projected: Vec<Vec<f64>> = columns.map(|column| plain.apply(&column)).collect();
        let span = Projection::of(&projected);
        let left_by_background = left_by_background(&plain);
        let left = left_by_span(&plain, &span, signals.len(), left_by_background.clone());
        Self { plain, span, left_by_background, left }
    }

    /// What the background leaves of a residual over the rows, nT; one a sample.
    pub(super) fn beside_background(&self, residual_nt: &[f64]) -> Vec<f64> {
        self.plain.apply(residual_nt)
    }

    /// What the span leaves of that; none where there is no span.
    pub(super) fn beside(&self, left_nt: &[f64]) -> Option<Vec<f64>> {
        let mut left_nt = left_nt.to_vec();
        self.span.project_out(&mut left_nt);
        (self.span.rank() > 0).then_some(left_nt)
    }

    /// A column over the samples as one over the rows; 0 where no block is.
    pub(super) fn on_rows(&self, column: &[f64], rows: usize) -> Vec<f64> {
        on_rows(&self.plain, column, rows)
    }

    /// Share of the power of white noise that the background leaves at each frequency, of each periodogram of the blocks.
    pub(super) fn left_by_background(&self) -> &[Vec<f64>] {
        &self.left_by_background
    }

    /// The same of what the span leaves of that.
    pub(super) fn left(&self) -> &[Vec<f64>] {
        &self.left
    }
}

/// A column over the samples as one over the rows.
fn on_rows(whitening: &Whitening, column: &[f64], rows: usize) -> Vec<f64> {
    let mut on_rows = vec![0.0; rows];
    whitening.rows().zip(column).for_each(|(row, value)| on_rows[row] = *value);
    on_rows
}

/// What background and targets leave of white noise, of each periodogram of the blocks.
fn left_by_background(plain: &Whitening) -> Vec<Vec<f64>> {
    let of_block = |(index, block): (usize, &Block)| {
        let rows = block.rows.end;
        let mut left: Vec<Vec<f64>> = Vec::new();
        let mut take_out = |direction: &[f64], block: &Block| {
            let mut on_rows = vec![0.0; rows];
            on_rows[block.rows.clone()].copy_from_slice(direction);
            take(&mut left, &periodograms(&on_rows, std::slice::from_ref(block)));
        };
        plain.directions(index).for_each(|direction| take_out(direction, block));
        // What was not read is not there either.
        let whole = Block { missing: Vec::new(), ..block.clone() };
        let unit = |at: usize| (0..block.len()).map(|k| f64::from(u8::from(k == at))).collect::<Vec<f64>>();
        block.between_parts().for_each(|at| take_out(&unit(at), &whole));
        left
    };
    plain.blocks().iter().enumerate().flat_map(of_block).collect()
}

/// What the span leaves of what is left of white noise.
fn left_by_span(plain: &Whitening, span: &Projection, rows: usize, mut left: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for direction in span.basis() {
        take(&mut left, &periodograms(&on_rows(plain, direction, rows), plain.blocks()));
    }
    left
}

/// Take an orthonormal direction from what is left: of white noise of power 1 it has its own power.
fn take(left: &mut Vec<Vec<f64>>, direction: &[Periodogram]) {
    left.resize_with(direction.len(), Vec::new);
    for (left, periodogram) in left.iter_mut().zip(direction) {
        left.resize(periodogram.powers.len(), 1.0);
        let taken = periodogram.powers.iter().map(|power| power / Periodogram::WHITE_NOISE);
        left.iter_mut().zip(taken).for_each(|(left, taken)| *left -= taken);
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::diagnosis::noise::model::{IsNoise, NoiseInput, NoiseModel};
    use crate::simulator::signals::tests::{FIELD_NT, direction, signals_of, trajectory};
    use crate::simulator::signals::{Grid, Trajectory};

    const ROWS: usize = 2400;
    const NOISE_NT: f64 = 0.1;

    /// The rocking body of the tests of the effects, for four minutes.
    fn signals() -> Signals {
        let grid = Grid { rate_hz: 50.0, start_s: -5.0, len: 12_501 };
        signals_of(Trajectory {
            rate_hz: grid.rate_hz,
            field_nt: vec![FIELD_NT; grid.len],
            direction: (0..grid.len).map(|k| direction(grid.time_s(k))).collect(),
            epochs_s: (0..ROWS).map(|k| EPOCH_S * k as f64).collect(),
            depth_m: None,
            temperature_deg_c: None,
            currents_a: Vec::new(),
            ..trajectory()
        })
    }

    /// Rms of the noise that is told from white noise of 0.1 nT with something added, nT.
    fn noise_with(added: impl Fn(usize) -> f64, knows_motion: bool) -> f64 {
        noise_beside(Vec::new(), added, knows_motion)
    }

    /// The same where `targets` are fitted in each block.
    fn noise_beside(targets: Vec<Vec<f64>>, added: impl Fn(usize) -> f64, knows_motion: bool) -> f64 {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let mut residual_nt: Vec<f64> = (0..ROWS).map(|_| NOISE_NT * draw()).collect();
        (1..ROWS).for_each(|row| residual_nt[row] += added(row));
        let block = |k: usize| Block { rows: k * 600..(k + 1) * 600, missing: vec![], targets: targets.clone() };
        let (signals, blocks): (_, Vec<Block>) = (signals(), (0..4).map(block).collect());
        let motion = if knows_motion { MotionSpan::of(&signals, &blocks) } else { MotionSpan::none(&blocks) };
        let input = NoiseInput {
            residual_nt: &residual_nt,
            motion: &motion,
            signals: &signals,
            direction_noise: None,
            random_nt2: &[],
            is_noise: IsNoise::OfASensor,
            holds_terms: false,
        };
        NoiseModel::white(&blocks).estimate(&input).std_nt().expect("enough rows")
    }

    #[test]
    fn noise_alone_is_told_as_it_is() {
        for knows_motion in [false, true] {
            let told_nt = noise_with(|_| 0.0, knows_motion);
            assert!((told_nt / NOISE_NT - 1.0).abs() < 0.07, "{told_nt}");
        }
    }

    #[test]
    fn what_is_fitted_of_targets_does_not_make_the_noise_quieter() {
        // As many columns as 16 targets have, of up to 0.67 Hz.
        let column = |k: usize| (0..600).map(|row| (PI * k as f64 * (row as f64 + 0.5) / 600.0).cos()).collect();
        let columns: Vec<Vec<f64>> = (1..=80).map(column).collect();
        for knows_motion in [false, true] {
            let told_nt = noise_beside(columns.clone(), |_| 0.0, knows_motion);
            assert!((told_nt / NOISE_NT - 1.0).abs() < 0.07, "{told_nt}");
        }
    }

    #[test]
    fn a_reading_that_is_ever_later_is_no_noise_and_one_that_becomes_late_far_less() {
        let scalar_nt = signals().scalar_at_rows_nt().to_vec();
        let late = |row: usize| scalar_nt[row - 1] - scalar_nt[row];
        let told = |added: &dyn Fn(usize) -> f64| [false, true].map(|knows_motion| noise_with(added, knows_motion));
        let [swallowed_nt, told_nt] = told(&|row| late(row) * row as f64 / ROWS as f64);
        assert!(swallowed_nt > 2.0 * NOISE_NT && told_nt < 1.2 * NOISE_NT, "{swallowed_nt} {told_nt}");
        let becomes_late = |row: usize| if row > ROWS / 2 { late(row) } else { 0.0 };
        let power_nt2 = (1..ROWS).map(|row| becomes_late(row).powi(2)).sum::<f64>() / ROWS as f64;
        let [_, told_nt] = told(&becomes_late);
        assert!(told_nt < 0.7 * power_nt2.sqrt().hypot(NOISE_NT), "{power_nt2} {told_nt}");
    }
}
