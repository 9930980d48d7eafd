//! What is left: tests that know no effect.

/// What the noise model may be off by, of its variance, and so much more over the root of the samples that it was made
/// from. Set by hand.
pub(crate) const NOISE_MODEL_TOLERANCE: f64 = 0.12;
pub(crate) const NOISE_MODEL_TOLERANCE_SAMPLES: f64 = 4.0;
/// How much of that may come and go in time, or with the motion. Counted on 240 recordings that hide nothing (`host-sim trial --setting
/// tuning`, seeds 532 and 533): with it the lowest chance of such a test is e^-6.5, but for one recording with a target that was not found.
pub(crate) const TOLERANCE_THAT_CHANGES: f64 = 0.25;
/// Windows in which a residual is held against the motion, samples, and how many it takes.
pub(crate) const COHERENCE_WINDOWS: [usize; 3] = [50, 100, 300];
pub(crate) const COHERENCE_LEAST_WINDOWS: usize = 6;
/// Power of a motion over that of the direction's noise, as if that were white, from which it is one. Derived: of less than a
/// thirtieth of a direction's residual the noise is in it, which has no say beside what is tested.
pub(crate) const COHERENCE_MOTION_RATIO: f64 = 30.0;
/// Degrees of freedom of Student's distribution that heavy tails of noise may have, and how much likelier they must be than
/// normal ones, in logarithms. Set by hand: fewer than three have no variance to speak of, more than twelve are normal.
pub(crate) const TAIL_DEGREES: [f64; 7] = [3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 12.0];
pub(crate) const HEAVY_TAILS_LEAST_GAIN: f64 = 6.0;
/// How much likelier than heavy tails, in logarithms, two kinds of values must be. Derived: one recording in 20,000.
pub(crate) const TWO_KINDS_LEAST_GAIN: f64 = 10.0;
/// Trials factor of windows that overlap: for each that does not. Set by hand.
pub(crate) const WINDOW_OVERLAP_TRIALS: f64 = 3.0;
/// Squares, of variance 1, above which a sample counts to the excess: of impulses (3 sigma), and of bursts. Set by hand;
/// they move the size of a finding, not its chance.
pub(crate) const LARGE_SAMPLE_SQUARES: [f64; 2] = [9.0, 12.0];
/// What the noise of the direction leaves in doubt of a sample's variance, as a share of it: so many times the coefficient of variation
/// of all variances by it, and no more than so many times what of the sample is noise of the direction. Bursts, lines, a
/// variance that wanders, loudness that goes with the motion, impulses. The second of each counted on 332 recordings that hide nothing
/// (`host-sim trial --setting tuning`, seeds 802, 803 and 811), 69 of them with such noise: the lowest chance of such a test on those is
/// e^-7.7, but for three that were alarms before.
pub(crate) const BURSTS_DOUBT: [f64; 2] = [4.0, 6.0];
pub(crate) const LINES_DOUBT: [f64; 2] = [2.0, 5.0];
pub(crate) const SLOW_VARIANCE_DOUBT: [f64; 2] = [1.0, 1.5];
pub(crate) const LOUDNESS_DOUBT: [f64; 2] = [0.5, 0.5];
pub(crate) const IMPULSES_DOUBT: [f64; 2] = [2.0, 2.0];
/// Below this the background has taken what a line is measured against, Hz. Set by hand.
pub(crate) const LINES_LOWEST_HZ: f64 = 0.04;
/// Rhythms of the noise's variance that are slower than this may be those of the motion, Hz. Derived: a body does not move twice a
/// second, and its variance has at most twice that.
pub(crate) const RHYTHM_LOWEST_HZ: f64 = 2.5;
/// Parts of 5 s that a recording must have for a variance that wanders. Set by hand.
pub(crate) const SLOW_VARIANCE_LEAST_PARTS: f64 = 8.0;
/// Variance of their mean squares over that of white normal noise. Set by hand: whitening is not perfect.
pub(crate) const SLOW_VARIANCE_SPREAD: f64 = 1.1;
/// Coefficient that a smooth function of the direction may have, nT: one that would not show with it is the noise of the
/// direction. Set by hand.
pub(crate) const COLUMN_LARGEST_NT: f64 = 100.0;
