//! The rows of a calibration on the desk: band-passed without delay, so that the settling of the filter costs none.

use towmag::filter::{BandPass, BandPassDesign, BandPassError, BandPassState};
use towmag::model::{Row, TERMS, TermVector};
use towmag::{Epoch, FrontEnd, FrontEndState, Observation};

/// One channel per term, and the scalar last.
const CHANNELS: usize = TERMS + 1;

type Sample = [f32; CHANNELS];

/// Share of its start to which the slowest transient has decayed within what an end is continued by, as in the core.
const DECAYED: f64 = 1e-3;

/// Longest dropout, s, that is bridged, as in the core: the background moves little in that time.
const LONGEST_DROPOUT_S: f64 = 1.0;

/// The core's own band-pass, forward and then backward over each stretch without a long dropout. Twice through it
/// squares its magnitude: -6 dB at the edges of the band.
pub(super) struct ZeroPhase {
    front_end: FrontEnd,
    state: FrontEndState,
    /// Samples by which an end is continued at most.
    reach: usize,
    /// Samples of the shortest stretch that counts: one period of the lower edge. A shorter one shows nothing in the band.
    least: usize,
    longest_dropout: usize,
    stretch: Option<Stretch>,
}

/// Samples one after another on the grid.
struct Stretch {
    last_tick: u32,
    reference_pt: i32,
    samples: Vec<Sample>,
    /// Whether a sample was measured, and not put into a dropout.
    is_measured: Vec<bool>,
}

impl ZeroPhase {
    pub(super) fn new(design: BandPassDesign) -> Result<Self, BandPassError> {
        let front_end = FrontEnd::new(design)?;
        Ok(Self {
            front_end,
            state: FrontEndState::default(),
            reach: front_end.band_pass().settling_samples(DECAYED) as usize,
            least: (design.sample_rate_hz / design.low_hz).ceil() as usize,
            longest_dropout: (LONGEST_DROPOUT_S * design.sample_rate_hz).round() as usize,
            stretch: None,
        })
    }

    /// One epoch. When it ends a stretch by the dropout before it, `take` gets the rows of that.
    pub(super) fn step(&mut self, epoch: &Epoch, take: impl FnMut(&Row)) {
        let Ok(observation) = self.front_end.step(&mut self.state, epoch) else { return };
        let missed = |stretch: &Stretch| epoch.tick.wrapping_sub(stretch.last_tick).wrapping_sub(1) as usize;
        if self.stretch.as_ref().is_some_and(|stretch| missed(stretch) > self.longest_dropout) {
            self.finish(take);
        }
        let stretch = self.stretch.get_or_insert_with(|| Stretch::before(epoch.tick, observation.scalar_pt));
        stretch.bridge(missed(stretch), &observation);
        stretch.last_tick = epoch.tick;
    }

    /// The end of the recording, or of a stretch: `take` gets the rows that are left.
    pub(super) fn finish(&mut self, mut take: impl FnMut(&Row)) {
        let Some(stretch) = self.stretch.take().filter(|stretch| stretch.samples.len() >= self.least) else { return };
        let filtered = band_passed(self.front_end.band_pass(), &stretch.samples, self.reach);
        for (sample, _) in filtered.iter().zip(&stretch.is_measured).filter(|(_, is_measured)| **is_measured) {
            take(&Row { terms: TermVector::from_fn(|i, _| sample[i]), scalar_nt: sample[TERMS] });
        }
    }
}

impl Stretch {
    /// One whose first sample is that of `tick`.
    fn before(tick: u32, reference_pt: i32) -> Self {
        Self { last_tick: tick.wrapping_sub(1), reference_pt, samples: Vec::new(), is_measured: Vec::new() }
    }

    /// The next measured sample after `missed` missing ones, in whose place goes the straight line. It is the same line
    /// for the scalar and the columns, so that eq. (6) goes on holding between them.
    fn bridge(&mut self, missed: usize, observation: &Observation) {
        // Integers until the reference is subtracted: an f32 in between would cost 0.004 nT.
        let mut sample = [(observation.scalar_pt - self.reference_pt) as f32 / 1000.0; CHANNELS];
        sample[..TERMS].copy_from_slice(observation.terms.as_slice());
        if let Some(last) = self.samples.last().copied() {
            let share = |k: usize| k as f32 / (missed + 1) as f32;
            let between = |k: usize| std::array::from_fn(|i| last[i] + share(k) * (sample[i] - last[i]));
            self.samples.extend((1..=missed).map(between));
            self.is_measured.extend((1..=missed).map(|_| false));
        }
        self.samples.push(sample);
        self.is_measured.push(true);
    }
}

/// Band-passed forward and backward. Each end is continued by its point reflection: a background that goes straight goes
/// on straight, and as the scalar and the columns are reflected alike, eq. (6) holds up to the ends.
fn band_passed(band_pass: &BandPass, samples: &[Sample], reach: usize) -> Vec<Sample> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Vec::new() };
    let reach = reach.min(samples.len() - 1);
    let before = samples[1..=reach].iter().rev().map(|sample| reflected(first, sample));
    let after = samples[samples.len() - 1 - reach..].iter().rev().skip(1).map(|sample| reflected(last, sample));
    let mut whole: Vec<Sample> = before.chain(samples.iter().copied()).chain(after).collect();
    run(band_pass, whole.iter_mut());
    run(band_pass, whole.iter_mut().rev());
    whole.drain(..reach);
    whole.truncate(samples.len());
    whole
}

fn reflected(end: &Sample, sample: &Sample) -> Sample {
    std::array::from_fn(|i| 2.0 * end[i] - sample[i])
}

/// Through the filter once, from a standstill at the first sample.
fn run<'a>(band_pass: &BandPass, samples: impl Iterator<Item = &'a mut Sample>) {
    let mut state = None;
    for sample in samples {
        let state = state.get_or_insert_with(|| BandPassState::steady(sample));
        *sample = band_pass.step(state, sample);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELD_NT: f64 = 50_000.0;
    const PERMANENT_NT: f64 = 100.0;

    /// A body that rolls through the band, with a permanent moment along x and a background that rises all the time.
    fn epoch(tick: u32) -> Epoch {
        let time_s = f64::from(tick) / 10.0;
        let angle = 0.3 * (std::f64::consts::TAU * 0.3 * time_s).sin();
        let flux_nt = [angle.sin(), angle.cos(), 0.2].map(|part| (FIELD_NT * part / 1.04_f64.sqrt()) as f32);
        let scalar_nt = FIELD_NT + PERMANENT_NT * angle.sin() / 1.04_f64.sqrt() + 0.02 * time_s;
        Epoch { tick, scalar_pt: Some((scalar_nt * 1000.0).round() as i32), flux_nt: Some(flux_nt) }
    }

    fn rows(ticks: impl Iterator<Item = u32>) -> Vec<Row> {
        let (mut zero_phase, mut rows) = (ZeroPhase::new(BandPassDesign::default()).unwrap(), Vec::new());
        ticks.for_each(|tick| zero_phase.step(&epoch(tick), |row| rows.push(*row)));
        zero_phase.finish(|row| rows.push(*row));
        rows
    }

    /// Largest error of the interference in nT, and of what is left of the signal.
    fn worst_nt(rows: &[Row]) -> f32 {
        rows.iter().map(|row| (row.scalar_nt - PERMANENT_NT as f32 * row.terms[0]).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn no_row_is_lost_to_settling_and_each_holds_the_interference() {
        let rows = rows(0..1000);
        // The first epoch has no derivative.
        assert_eq!(rows.len(), 999);
        assert!(worst_nt(&rows) < 0.01, "{}", worst_nt(&rows));
    }

    #[test]
    fn a_dropout_costs_its_rows_and_the_one_after_it_alone() {
        let rows = rows((0..1000).filter(|tick| !(500..508).contains(tick)));
        assert_eq!(rows.len(), 999 - 8 - 1);
        assert!(worst_nt(&rows) < 0.01, "{}", worst_nt(&rows));
    }

    #[test]
    fn a_gap_ends_a_stretch_and_a_short_stretch_does_not_count() {
        let rows = rows((0..1000).chain(2000..2090).chain(3000..4000));
        assert_eq!(rows.len(), 2 * 999);
        assert!(worst_nt(&rows) < 0.01, "{}", worst_nt(&rows));
    }

    #[test]
    fn there_is_no_delay() {
        let rows = rows(0..3000);
        // In the middle of the band the gain is 1, so that what comes out is what went in.
        let roll = |tick: u32| epoch(tick).flux_nt.unwrap()[0] / FIELD_NT as f32;
        let worst = (1000..2000).map(|tick| (rows[tick as usize - 1].terms[0] - roll(tick)).abs()).fold(0.0, f32::max);
        assert!(worst < 0.01, "{worst}");
    }
}
