//! Every constant of the diagnosis that decides something, with what it decides and where it comes from.
//!
//! "By trial" stands for: set by hand while looking at `host-sim trial --recordings 200 --minutes 10` with seeds 101 to 110,
//! and then left alone; figures that were seen while tuning are no evidence, which is why the trial has fresh seeds.

// --- Noise model ---

/// No sensor is quieter, nT: keeps the whitening of a reading without noise finite. A hundredth of the noise of the best
/// scalar sensors at 10 Hz.
pub(crate) const LEAST_NOISE_NT: f64 = 5e-4;
/// Whitened noise is never quieter than this variance: less is a reading without noise, of which nothing can be said.
pub(crate) const LEAST_VARIANCE: f64 = 0.05;
/// How many times denser than white noise the noise of the direction may be where it is let through. By trial.
pub(crate) const NOISE_DENSITY_RATIO: f64 = 5.0;
/// How many times the coefficient of variation of the direction's noise its model may have wrong for a while. By trial.
pub(crate) const VARIANCE_MODEL_ERROR: f64 = 4.0;

// --- Base fit, before any effect ---

/// Twice the log likelihood that exact repeats must gain over chance to be an effect: one recording in 5e8, chi-squared
/// with one degree of freedom, because many recorders repeat readings for reasons of their own.
pub(crate) const REPEATS_GLRT: f64 = 36.0;
/// The scalar's field is subtracted from the fluxgate's magnitude where that leaves at most this share of its power: where
/// it does not, its noise is more than what the two share.
pub(crate) const COMMON_FIELD: f64 = 0.8;
/// Samples that a diagnosis needs at least, in stretches without long gaps: half a minute.
pub(crate) const LEAST_SAMPLES: usize = 300;

// --- Selection ---

/// Effects in a channel at most: more of them are rather pieces of one that is not known.
pub(crate) const MOST_EFFECTS: usize = 6;
/// Second looks at what was found, at most. A third one changed nothing on any recording of the trial.
pub(crate) const REVIEWS: usize = 2;
/// Logarithm of the chance to name any one effect that is not there: with twenty of them, one clean recording in 20,000.
/// On estimated noise models it is several times that.
pub(crate) const LOG_FALSE_ALARM: f64 = -13.0;
/// Share of what was found already that one more effect must explain at least: less may be the imperfection of that.
/// By trial.
pub(crate) const SMALL: f64 = 0.003;
/// The same where one of the two is random. By trial.
pub(crate) const SMALL_RANDOM: f64 = 0.01;
/// The same where both are: one colour stands for the noise and a random effect, and what that misses looks like another
/// one. By trial.
pub(crate) const SMALL_BOTH_RANDOM: f64 = 0.2;
/// GLRT above which no held-out check is needed.
pub(crate) const BEYOND_DOUBT: f64 = 1000.0;
/// Share of its GLRT that an effect that can be bent to fit a few rows must explain on held-out blocks too. By trial.
pub(crate) const LEAST_HELD_OUT: f64 = 0.1;
/// How near to the edge of an effect's band a periodic effect is the cut itself, Hz: twice the resolution of a minute.
pub(crate) const BAND_EDGE_HZ: f64 = 0.02;
/// Evidence within which candidates are fitted jointly before the best is chosen, and how many of them.
pub(crate) const REFINED_MARGIN: Margin = Margin { absolute: 25.0, share: 0.35 };
/// How many candidates are fitted jointly at most.
pub(crate) const MOST_REFINED: usize = 6;
/// Evidence within which another effect is fitted in the place of one.
pub(crate) const RIVAL_MARGIN: Margin = REFINED_MARGIN;
/// Evidence by which another effect must be better to take the place of one.
pub(crate) const BETTER: f64 = 0.5;
/// Correlation of what two effects add below which they cancel. By trial.
pub(crate) const OPPOSITE: f64 = -0.85;
/// Two effects whose evidence differs by less are not told apart: odds of 150 to 1.
pub(crate) const INDISTINGUISHABLE: f64 = 10.0;
/// A linear parameter beyond this many times what is plausible is no finding.
pub(crate) const BEYOND_PLAUSIBLE: f64 = 20.0;
/// A noise model that is not quite right makes another variance fit a little better: as if so many had been tried.
pub(crate) const TRIALS_PER_VARIANCE: f64 = 2.0;
/// Growth of the variance that a noise model may miss by itself, where it grows most. By trial.
pub(crate) const LEAST_GROWTH: f64 = 0.25;

// --- Intervals ---

/// A parameter whose 95 % interval is wider than this many times its plausible range is not identified.
pub(crate) const NOT_IDENTIFIED: f64 = 8.0;
/// What errors are larger than the fit says, which knows neither the errors of the direction nor those of the noise model:
/// five trials of 200 recordings, so that the intervals hold 95 %.
pub(crate) const INFLATION: f64 = 1.45;

// --- Verdict ---

/// Chance of a finding without a cause, both channels and all tests together.
pub(crate) const FALSE_ALARM: f64 = 0.002;
/// Tests of the residual, both channels together.
pub(crate) const TESTS: f64 = 12.0;
/// Tries that the p-value of the whole gap counts: effects, and tests of the residual.
pub(crate) const TRIES: f64 = 50.0;
/// Logarithm of a chance at which what goes with the attitude is no imperfection of what was found. By trial.
pub(crate) const LOG_BY_ATTITUDE: f64 = -34.0;
/// Share of the excess that may stay significant without the verdict being partial, and without a doubt about the names.
pub(crate) const SMALL_REST: f64 = 0.08;
/// Effects in a channel from which on none of it may stay, or they are rather pieces of one that is not known. By trial.
pub(crate) const MANY: usize = 3;
/// What counts as left over then, at least. By trial.
pub(crate) const PIECED: f64 = 0.5;
/// Share of the excess that the best of the named effects closes on held-out blocks at least, or the gap is not explained
/// even though no test finds what is left.
pub(crate) const LEAST_CLOSED: f64 = 0.5;
/// Effects that are listed as indistinguishable at most: the format's.
pub(crate) const MOST_RIVALS: usize = 5;

// --- Probabilities ---

/// Evidence (twice a logarithm) that counts for one unit of log odds, twice: fitted on recordings of the trial.
pub(crate) const EVIDENCE_PER_NAT: f64 = 3.0;
/// Probability that an effect far above its rivals and its threshold is the right one. Fitted on recordings of the trial.
pub(crate) const SUREST: f64 = 0.992;
/// The same with something significant left that it does not explain. Fitted on recordings of the trial.
pub(crate) const SUREST_WITH_REST: f64 = 0.7;
/// Probability of `none` when nothing is named and nothing is left: the rest are effects too weak to show.
pub(crate) const SUREST_OF_NONE: f64 = 0.97;
/// The main cause is the strongest: how sharply the ratio of two strengths says so. Fitted on recordings of the trial.
pub(crate) const SHARPNESS: i32 = 16;

/// A difference in evidence that counts as near: the larger of the two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    pub(crate) absolute: f64,
    /// Of the size of the evidence.
    pub(crate) share: f64,
}

impl Margin {
    /// About so much evidence.
    pub(crate) fn of(&self, evidence: f64) -> f64 {
        self.absolute.max(self.share * evidence.abs())
    }
}
