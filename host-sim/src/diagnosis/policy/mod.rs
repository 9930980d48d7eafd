//! Constants that decide something in a diagnosis, by stage: thresholds, limits, trials factors, tolerances.
//!
//! Sizes of a search, orders of an algorithm and physical constants stand where they are used. A whitened residual has
//! noise of variance 1; a GLRT is twice the log likelihood ratio, and so in units of that variance.
//!
//! Each constant says where it comes from: *derived*, by the sentence beside it; *counted*, on recordings of `host-sim
//! trial`; or *set by hand*, while the diagnosis was made on such recordings: then nothing but `host-sim trial` on other
//! seeds says how good it is, and that only for what the trial draws.

mod columns;
mod targets;

pub(crate) use columns::*;
pub(crate) use targets::*;

/// Rows per second of a recording, and the time from row to row, s.
pub(crate) use crate::recording::{EPOCH_S, RATE_HZ};

// --- reconstruction -------------------------------------------------------------------------------------------------

/// Missing rows in a row that are bridged, of the direction and within a block. Set by hand: across more,
/// a direction is a guess.
pub(crate) const BRIDGED_ROWS: usize = 4;
/// Longer pauses count as this long, s: nothing acts across them, and the dense grid must stay small. Set by hand.
pub(crate) const LONGEST_PAUSE_S: f64 = 3600.0;
/// Moving average of a temperature, rows: no sensor in a housing follows faster than in 15 s. Set by hand.
pub(crate) const TEMPERATURE_ROWS: usize = 150;
/// Moving average, taken twice, that parts the slow field from motion, rows: 10 s. Set by hand.
pub(crate) const SLOW_FIELD_ROWS: usize = 100;
/// The same of the slow direction, about which the angles are smoothed, rows. Set by hand.
pub(crate) const SLOW_DIRECTION_ROWS: usize = 100;
/// Above this a spectrum of the fluxgate is noise alone, Hz: a towed body does not move that fast. Set by hand.
pub(crate) const MOTION_HIGHEST_HZ: f64 = 3.5;
/// Power over that of the noise from which motion is let through all the time. Set by hand: of less, noise is a
/// good part, and would be let in all the time.
pub(crate) const MOTION_LEAST_RATIO: f64 = 4.0;
/// Noise that the Wiener filter subtracts, over the floor that was measured: over-subtraction for a floor that is itself
/// uncertain. Set by hand.
pub(crate) const NOISE_FLOOR_MARGIN: f64 = 1.3;
/// Power over that of the noise from which a moment has motion at a frequency. Set by hand: were the seven powers of
/// an average independent, noise alone would exceed it once in 1.7 million.
pub(crate) const MOMENT_LEAST_RATIO: f64 = 4.0;
/// Below this a moment of 12.8 s does not tell motion that comes and goes from motion that lasts, Hz. Set by hand.
pub(crate) const MOMENT_SLOWEST_HZ: f64 = 0.4;
/// Windows that a series must fill for "in most moments" to mean anything. Set by hand.
pub(crate) const MOMENTS_FOR_A_MAJORITY: usize = 4;
/// Mean square of the smoothing's residual near a row, over that of noise, below which the smoothed value stays, and from
/// which the reading counts alone. Set by hand.
pub(crate) const READING_TRUSTED_RATIOS: [f64; 2] = [4.0, 9.0];

// --- rounding -------------------------------------------------------------------------------------------------------

/// Differences of neighbouring values that a step is looked for in: the smallest, at least and at most. Set by hand; the
/// rate of false alarms is tested, in `rounding/`.
pub(crate) const LATTICE_LEAST_DIFFERENCES: usize = 12;
pub(crate) const LATTICE_DIFFERENCES: usize = 64;
/// The finest step, over the last digit, that is told from it: two digits are, whatever the rounding of their errors.
pub(crate) const LATTICE_LEAST_DIGITS: f64 = 1.9;
/// The finest step under the largest of those differences. Set by hand: bounds the work; what is finer adds nothing to
/// any noise.
pub(crate) const LATTICE_MOST_STEPS: f64 = 2000.0;
/// Mean cosine of the differences at a step from which it is looked at more closely. Derived: that of the smallest
/// step that is three last digits, on a point of the periodogram; chance gives 0.31 over all its points.
pub(crate) const LATTICE_LEAST_SCORE: f64 = 0.5;
/// Mean resultant length of the values on their step. Derived: 0.83 where the step is three last digits; values without a
/// step have the inverse of the root of their number.
pub(crate) const LATTICE_LEAST_CONCENTRATION: f64 = 0.8;
/// Share of the values by which a stretch of one step goes on: all but those of damaged rows. Set by hand.
pub(crate) const LATTICE_LEAST_ON: f64 = 0.9;
/// Steps that differ by less than this share are the same: far more than their errors. Set by hand.
pub(crate) const SAME_STEP_SHARE: f64 = 1e-3;
/// Rows of a stretch of one step at least where a recording is halved, and how often it is. Set by hand.
pub(crate) const STRETCH_LEAST_ROWS: usize = 600;
pub(crate) const STRETCH_MOST_HALVINGS: u32 = 3;
/// Rows by which the end of a stretch is found. Set by hand: two seconds.
pub(crate) const STRETCH_BORDER_ROWS: usize = 20;

// --- noise model ----------------------------------------------------------------------------------------------------

/// Background of a block: one Legendre polynomial for so many seconds, and so many more, because a polynomial over few
/// periods follows the slowest of them badly. Takes what is below 0.02 Hz, passes what is above about 0.06 Hz. Set by hand
/// on geology and diurnal change below 0.018 Hz, as `host-sim trial` draws them.
pub(crate) const BACKGROUND_TERM_S: f64 = 10.0;
pub(crate) const BACKGROUND_EXTRA_TERMS: usize = 3;
/// Shortest and longest block, s. Set by hand.
pub(crate) const BLOCK_LENGTHS_S: [f64; 2] = [25.0, 100.0];
/// Blocks that a recording should have at least: two for each of the four folds of the cross-validation. Set by hand.
pub(crate) const BLOCKS_WANTED: f64 = 8.0;
/// Rows at each end of a stretch that no block has: there the direction is known from one side only. Set by hand.
pub(crate) const STRETCH_END_ROWS: usize = 10;
/// A shorter block has too few rows for its background. Set by hand.
pub(crate) const BLOCK_LEAST_ROWS: usize = 60;
/// Share of missing rows above which a block is left out. Set by hand.
pub(crate) const BLOCK_MOST_MISSING: f64 = 0.6;
/// Share of missing rows of a stretch above which its blocks are as short as may be: each missing row is a nuisance column
/// of its own, and many of them cost less in short blocks. Set by hand.
pub(crate) const SHORT_BLOCK_MISSING: f64 = 0.08;
/// Below this the background has taken power away, Hz: there the spectrum is extrapolated. Set by hand.
pub(crate) const SPECTRUM_LOWEST_HZ: f64 = 0.075;
/// Share of the powers of a band, from the lowest, that its level is taken from: lines and bursts may be in the others.
/// Set by hand.
pub(crate) const SPECTRUM_TRUSTED_SHARE: f64 = 0.7;
/// Powers that the level of a band is taken from at least. Set by hand.
pub(crate) const SPECTRUM_LEAST_POWERS: usize = 8;
/// Share of the power of noise at a frequency that columns of the motion must leave for it to be told there. Set by hand.
pub(crate) const SPECTRUM_LEAST_LEFT: f64 = 0.5;
/// Power in a band over that without what follows the motion, from which the latter is the noise. Set by hand: more than the
/// errors of the two together.
pub(crate) const SPECTRUM_FAR_ABOVE: f64 = 4.0;
/// Samples for each column of the motion that is taken out of what noise is told from. Set by hand.
pub(crate) const MOTION_SAMPLES_PER_COLUMN: usize = 20;
/// Largest power density of noise over the smallest. Derived: that of the reddest noise that a sensor has, AR(1) of 0.9, is 361;
/// three times that, as both are estimates.
pub(crate) const SPECTRUM_MOST_RATIO: f64 = 1000.0;
/// Error of the smoothed direction, and of its rate (1/s), over the noise of the recorded direction, at most. Smoothing
/// leaves less than the noise of the one and passes little above 2 Hz of the other (1.2 and 8), but errs by more where a
/// motion sets in. Set by hand: more would hide a dead zone.
pub(crate) const DIRECTION_ERROR_MOST: f64 = 3.0;
pub(crate) const DIRECTION_RATE_ERROR_MOST_PER_S: f64 = 20.0;
/// Error of the rate over the size of the direction's sixth difference, 1/s, at most. Set by hand.
pub(crate) const BETWEEN_ROWS_MOST_PER_S: f64 = 1.0;
/// GLRT that the direction's noise must have to be part of the noise model. Set by hand.
pub(crate) const DIRECTION_LEAST_GLRT: f64 = 6.0;
/// Squares count no more than this, in units of their median, when a variance is fitted: one spike is no variance. Where
/// a variance is known to have grown the limit grows with it (without that, a dead zone of 2 nT was found as one of 0.7).
/// Set by hand.
pub(crate) const SPIKE_SQUARES: f64 = 300.0;

/// No sensor is quieter, nT: keeps the whitening of a reading without noise finite. A hundredth of the noise of the best
/// scalar sensors at 10 Hz.
pub(crate) const LEAST_NOISE_NT: f64 = 5e-4;
/// Whitened noise is never quieter than this variance: less is a reading without noise, of which nothing can be said.
pub(crate) const LEAST_VARIANCE: f64 = 0.05;
/// How many times denser than white noise the noise of the direction may be where it is let through. Set by hand.
pub(crate) const NOISE_DENSITY_RATIO: f64 = 5.0;
/// How many times the coefficient of variation of the direction's noise its model may have wrong for a while. Set by hand.
pub(crate) const VARIANCE_MODEL_ERROR: f64 = 4.0;

// --- regression -----------------------------------------------------------------------------------------------------

/// Eigenvalue of the columns' correlations, over the largest, up to which a combination of them counts as dependent on
/// the others. Numerical: rounding leaves about 1e-15 of a dependent one.
pub(crate) const DEPENDENT_EIGENVALUE: f64 = 1e-9;
/// Norm up to which a whitened column counts as empty. Numerical.
pub(crate) const EMPTY_COLUMN_NORM: f64 = 1e-12;
/// The two for the few columns of one effect, whose products are small differences of large ones: eigenvalue over the
/// largest, and norm of a column over the largest norm. Numerical.
pub(crate) const UNEXPLAINED_EIGENVALUE: f64 = 1e-8;
pub(crate) const EMPTY_COLUMN_SHARE: f64 = 1e-9;

// --- search ---------------------------------------------------------------------------------------------------------

/// Share of its power that a linear effect must keep beside everything fitted: less is rounding. Numerical.
pub(crate) const REGRESSOR_LEAST_SHARE: f64 = 1e-7;
/// The same of columns that begin at a moment, from products of which that is a difference. Numerical.
pub(crate) const PROJECTED_LEAST_SHARE: f64 = 1e-6;
/// Trials factor of an axis: independent ones over half a sphere, for cubic and quartic polynomials. Set by hand.
pub(crate) const AXIS_TRIALS: f64 = 8.0;
/// Trials factor of a tone, for each step of 1 / duration in frequency: one, and one for the frequencies between. Set by
/// hand.
pub(crate) const TONES_PER_RESOLUTION: f64 = 2.0;
/// Trials factor of a moment: one for so many seconds. Counted: with it, half of 130 clean recordings have a best chance
/// below one half.
pub(crate) const ONSET_INDEPENDENT_S: f64 = 0.8;
/// Rows at the ends of the recording where nothing is taken to begin: a few rows would be an event of their own. Set by
/// hand.
pub(crate) const ONSET_END_ROWS: usize = 200;
/// Trials factor of a pulse train, for each row of the recording. Counted as [`ONSET_INDEPENDENT_S`].
pub(crate) const PULSE_TRIALS_PER_ROW: f64 = 2000.0;
/// Rows in pulses, and between them, at least: fewer can be met by chance with anything. Set by hand.
pub(crate) const PULSE_LEAST_ROWS: f64 = 20.0;
/// Periods that are looked for, s, and how many of them the recording must hold. Set by hand.
pub(crate) const PULSE_PERIODS_S: [f64; 2] = [1.0, 300.0];
pub(crate) const PULSE_PERIODS_WITHIN: f64 = 3.0;
/// Up to this frequency, Hz, the background leaves this share of a harmonic's power. Set by hand: only the order in which
/// folds are fitted depends on it.
pub(crate) const BACKGROUND_HIGHEST_HZ: f64 = 0.05;
pub(crate) const BACKGROUND_PASSED_SHARE: f64 = 0.02;
/// Growth of the variance that a noise model may miss by itself, where it grows most. Set by hand.
pub(crate) const VARIANCE_LEAST_GROWTH: f64 = 0.25;
/// Trials factor of a cone: independent ones, as far as a whitened residual that is not quite normal tells them apart. Set
/// by hand.
pub(crate) const CONE_TRIALS: f64 = 4000.0;
/// Samples that a cone must hold, and must leave. Set by hand.
pub(crate) const CONE_LEAST_SAMPLES: f64 = 30.0;
/// Widest half angle of a cone that is looked for, degrees: the widest that `dead_zone` calls plausible.
pub(crate) const CONE_WIDEST_DEG: f64 = 45.0;
/// GLRT of the coarse search from which a cone is looked at more closely. Set by hand, below what acceptance
/// asks of the final one (39: 11 nats and the trials factor, with two degrees of freedom), as the coarse one is less.
pub(crate) const CONE_LEAST_GLRT: f64 = 25.0;
/// GLRT that a cone must have in each half of the time: what is there once is no dead zone. Set by hand.
pub(crate) const CONE_HALF_LEAST_GLRT: f64 = 5.0;
/// GLRT of noise in proportion to a slope of the interference, within the cone, from which it is noise of the direction
/// and no dead zone: the larger of this and of a share of the cone's. Set by hand.
pub(crate) const CONE_SLOPES_MOST_GLRT: f64 = 12.0;
pub(crate) const CONE_SLOPES_MOST_SHARE: f64 = 0.02;
/// Readings that change, at least, for repeats to be held against them. Set by hand.
pub(crate) const REPEAT_LEAST_CHANGES: usize = 20;
/// Least standard deviation of a change, over the step of the reading, that the fit of it starts from: about that of
/// rounding alone (0.29, the root of one twelfth).
pub(crate) const REPEAT_LEAST_STEP_SHARE: f64 = 0.3;
/// Bounds of the chance that a reading repeats by itself. Set by hand, so that the likelihood does not hang
/// on one row.
pub(crate) const CHANCE_OF_REPEAT: [f64; 2] = [1e-5, 0.9999];
/// What steps may add to the noise power of their sensor and be those of a recorder as there are many: the contract's.
pub(crate) const ROUNDING_MOST_ADDED: f64 = 0.02;

/// A noise model that is not quite right makes another variance fit a little better: as if so many had been tried.
pub(crate) const TRIALS_PER_VARIANCE: f64 = 2.0;

// --- base fit, before any effect --------------------------------------------------------------------------------------

/// Twice the log likelihood that exact repeats must gain over chance to be an effect: one recording in 5e8, chi-squared
/// with one degree of freedom, because many recorders repeat readings for reasons of their own.
pub(crate) const REPEATS_GLRT: f64 = 36.0;
/// The scalar's field is subtracted from the fluxgate's magnitude where that leaves at most this share of its power: where
/// it does not, its noise is more than what the two share.
pub(crate) const COMMON_FIELD: f64 = 0.8;
/// Samples that a diagnosis needs at least, in stretches without long gaps: half a minute.
pub(crate) const LEAST_SAMPLES: usize = 300;

// --- selection --------------------------------------------------------------------------------------------------------

/// Effects in a channel at most: more of them are rather pieces of one that is not known.
pub(crate) const MOST_EFFECTS: usize = 4;
/// Times that all effects are looked for in a channel before the search ends with what it has. Three effects that are there
/// take eight. Set by hand: bounds the work.
pub(crate) const MOST_SCANS: usize = 10;
/// Second looks at what was found, at most. A third one changed nothing on any recording of the trial.
pub(crate) const REVIEWS: usize = 2;
/// Logarithm of the chance to name any one effect that is not there: with twenty of them, one clean recording in 3,000.
/// On estimated noise models it is several times that.
pub(crate) const LOG_FALSE_ALARM: f64 = -11.0;
/// The same of a moment, a period or a frequency that is looked for: somewhere in a recording such a shape meets what models of
/// noise and targets have wrong. Counted on 360 recordings of `host-sim trial --setting tuning`, seeds 504 to 506: of what was
/// between the two, two of three were not there.
pub(crate) const LOG_FALSE_ALARM_SEARCHED: f64 = -40.0;
/// Share of what was found already that one more effect must explain at least: less may be the imperfection of that.
/// Set by hand.
pub(crate) const SMALL: f64 = 0.003;
/// The same where one of the two is random. Set by hand.
pub(crate) const SMALL_RANDOM: f64 = 0.01;
/// The same where both are: one colour stands for the noise and a random effect, and what that misses looks like another
/// one. Set by hand.
pub(crate) const SMALL_BOTH_RANDOM: f64 = 0.2;
/// GLRT above which no held-out check is needed.
pub(crate) const BEYOND_DOUBT: f64 = 1000.0;
/// Share of its GLRT that an effect that can be bent to fit a few rows must explain on held-out blocks too. Set by hand.
pub(crate) const LEAST_HELD_OUT: f64 = 0.1;
/// Share of the excess that an effect must close on parts held out, with its interval above zero; and one whose column was
/// recorded, which has no shape that could be bent. Counted on `host-sim trial --setting tuning`, seeds 505 to 507: of what was
/// named below 0.4, half was not there.
pub(crate) const LEAST_CLOSED_SHARE: f64 = 0.3;
pub(crate) const LEAST_CLOSED_BY_COLUMN: f64 = 0.1;
/// Share of the excess that the model of a random effect must account for on parts held out. Set by hand.
pub(crate) const LEAST_ACCOUNTED: f64 = 0.5;
/// How near to the edge of an effect's band a periodic effect is the cut itself, Hz: twice the resolution of a minute.
pub(crate) const BAND_EDGE_HZ: f64 = 0.02;
/// Evidence within which candidates are fitted jointly before the best is chosen, and how many of them.
pub(crate) const REFINED_MARGIN: Margin = Margin { absolute: 25.0, share: 0.35 };
/// How many candidates are fitted jointly at most.
pub(crate) const MOST_REFINED: usize = 4;
/// Evidence within which another effect is fitted in the place of one.
pub(crate) const RIVAL_MARGIN: Margin = REFINED_MARGIN;
/// Evidence by which another effect must be better to take the place of one.
pub(crate) const BETTER: f64 = 0.5;
/// Correlation of what two effects add below which they cancel. Set by hand.
pub(crate) const OPPOSITE: f64 = -0.85;
/// Two effects whose evidence differs by less are not told apart: odds of 150 to 1.
pub(crate) const INDISTINGUISHABLE: f64 = 10.0;
/// A linear parameter beyond this many times what is plausible is no finding.
pub(crate) const BEYOND_PLAUSIBLE: f64 = 20.0;

// --- omnibus tests --------------------------------------------------------------------------------------------------

/// What the noise model may be off by, of its variance, and so much more over the root of the samples that it was made
/// from. Set by hand.
pub(crate) const NOISE_MODEL_TOLERANCE: f64 = 0.12;
pub(crate) const NOISE_MODEL_TOLERANCE_SAMPLES: f64 = 4.0;
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
/// Below this the background has taken what a line is measured against, Hz. Set by hand.
pub(crate) const LINES_LOWEST_HZ: f64 = 0.04;
/// Parts of 5 s that a recording must have for a variance that wanders. Set by hand.
pub(crate) const SLOW_VARIANCE_LEAST_PARTS: f64 = 8.0;
/// Variance of their mean squares over that of white normal noise. Set by hand: whitening is not perfect.
pub(crate) const SLOW_VARIANCE_SPREAD: f64 = 1.1;
/// Coefficient that a smooth function of the direction may have, nT: one that would not show with it is the noise of the
/// direction. Set by hand.
pub(crate) const COLUMN_LARGEST_NT: f64 = 100.0;

// --- evidence -------------------------------------------------------------------------------------------------------

/// Folds of the cross-validation of an effect's share of the gap, and the samples of the parts that they hold out: the first
/// is longer than the noise's memory of 3.2 s, and so short that an event of ten seconds is in more than one fold; the others
/// are for what happens at one moment. Set by hand.
pub(crate) const HELD_OUT_FOLDS: usize = 4;
pub(crate) const HELD_OUT_SAMPLES: [usize; 4] = [50, 20, 10, 4];
/// Share of the power of an effect that one fold may hold out: the others would not know of it. Set by hand: evenly spread, a
/// fold has a quarter.
pub(crate) const FOLD_MOST_OF_SIGNAL: f64 = 0.5;
/// Draws of the blocks (bootstrap) for the 95 % interval of that share. Derived: ten draws beyond each end.
pub(crate) const BOOTSTRAP_DRAWS: usize = 400;
/// GLRT on the training blocks of a fold from which an effect would have been chosen there: 3 sigma. Set by hand.
pub(crate) const FOLD_LEAST_GLRT: f64 = 9.0;

/// A parameter whose 95 % interval is wider than this many times its plausible range is not identified.
pub(crate) const NOT_IDENTIFIED: f64 = 8.0;
/// What errors are larger than the fit says, which knows neither the errors of the direction nor those of the noise model:
/// five trials of 200 recordings, so that the intervals hold 95 %.
pub(crate) const INFLATION: f64 = 1.45;

// --- verdict ----------------------------------------------------------------------------------------------------------

/// Chance of a finding without a cause, both channels and all tests together.
pub(crate) const FALSE_ALARM: f64 = 0.0002;
/// Tests of the residual, both channels together.
pub(crate) const TESTS: f64 = 12.0;
/// Tries that the p-value of the whole gap counts: effects, and tests of the residual.
pub(crate) const TRIES: f64 = 50.0;
/// Logarithm of a chance at which what goes with the attitude is no imperfection of what was found. Set by hand.
pub(crate) const LOG_BY_ATTITUDE: f64 = -34.0;
/// Share of the excess that may stay significant without the verdict being partial, and without a doubt about the names.
pub(crate) const SMALL_REST: f64 = 0.08;
/// Effects in a channel from which on none of it may stay, or they are rather pieces of one that is not known. Set by hand.
pub(crate) const MANY: usize = 3;
/// What counts as left over then, at least. Set by hand.
pub(crate) const PIECED: f64 = 0.5;
/// Share of the excess that the best of the named effects closes on held-out blocks at least, or the gap is not explained
/// even though no test finds what is left.
pub(crate) const LEAST_CLOSED: f64 = 0.5;
/// Lower end of the interval of the share that an effect closes, on parts held out and beside the others, to be named where more than
/// [`SMALL_REST`] stays: less is more likely a piece of what stays. A column that was recorded has no shape that could be bent.
/// Set by hand, on recordings of `host-sim trial --setting tuning`.
pub(crate) const NAMED_BESIDE_REST: f64 = 0.85;
pub(crate) const NAMED_COLUMN_BESIDE_REST: f64 = 0.35;
/// Effects that are listed as indistinguishable at most: the format's.
pub(crate) const MOST_RIVALS: usize = 5;

// --- probabilities ----------------------------------------------------------------------------------------------------

/// Evidence (twice a logarithm) that counts for one unit of log odds, twice: fitted on recordings of the trial.
pub(crate) const EVIDENCE_PER_NAT: f64 = 3.0;
/// Probability that an effect far above its rivals and its threshold is the right one. Counted.
pub(crate) const SUREST: f64 = 0.992;
/// The same with little left that it does not explain, with much, and of a column that was recorded. Set by hand.
pub(crate) const SUREST_WITH_LITTLE: f64 = 0.95;
pub(crate) const SUREST_WITH_REST: f64 = 0.9;
pub(crate) const SUREST_COLUMN_WITH_REST: f64 = 0.97;
/// What is left of that where the interval of the share that an effect closes begins at 0, and where it begins to be sure. Counted
/// on the same: of what began below 0.4, three of four were right, of the others nineteen of twenty.
pub(crate) const SURENESS_OF_UNPROVED: f64 = 0.7;
pub(crate) const PROVED_SHARE: f64 = 0.5;
/// Probability of `none` when nothing is named and nothing is left, by the chance of the gap: at most, less for each decade, and
/// at least; the rest are effects too weak to show. Counted on `host-sim trial --setting tuning`, seeds 505 to 507: 75 of 83
/// with a chance above 0.1 were `none`, 3 of 4 down to 0.01, half of those below.
pub(crate) const SUREST_OF_NONE: f64 = 0.9;
pub(crate) const NONE_LESS_PER_DECADE: f64 = 0.13;
pub(crate) const LEAST_OF_NONE: f64 = 0.45;
/// The main cause is the strongest: how sharply the ratio of two strengths says so. Counted.
pub(crate) const SHARPNESS: i32 = 16;

// --- manoeuvre ------------------------------------------------------------------------------------------------------

/// Least and largest time that a manoeuvre may take, minutes. Set by hand.
pub(crate) const MANOEUVRE_MINUTES: [f64; 2] = [0.5, 60.0];
/// Time on a heading from which it is worth sailing, minutes: 15 s, two periods of the rocking. Set by
/// hand.
pub(crate) const HEADING_MIN: f64 = 0.25;

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
