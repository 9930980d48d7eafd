//! Blocks, the noise, and the fit without any effect.

/// Background of a block: one Legendre polynomial for so many seconds, and so many more, because a polynomial over few
/// periods follows the slowest of them badly. Takes what is below 0.02 Hz, passes what is above about 0.06 Hz. Set by hand
/// on geology and diurnal change below 0.018 Hz, as `host-sim trial` draws them.
pub(crate) const BACKGROUND_TERM_S: f64 = 10.0;
pub(crate) const BACKGROUND_EXTRA_TERMS: usize = 3;
/// Shortest and longest block, s. Set by hand.
pub(crate) const BLOCK_LENGTHS_S: [f64; 2] = [25.0, 100.0];
/// Blocks that a recording should have at least. Set by hand. With fewer the background takes less of what is slow: in blocks of 100 s
/// 24 of 26 single effects of strength 1 were found on half of `host-sim trial --setting tuning --recordings 400 --minutes 4 --seed
/// 821`, in blocks of 30 s 23; but then twice as many targets are invented; on seed 841 blocks of 80 s made 9 false names of 2.
pub(crate) const BLOCKS_WANTED: f64 = 8.0;
/// Rows at each end of a stretch that no block has: there the direction is known from one side only. Set by hand.
pub(crate) const STRETCH_END_ROWS: usize = 10;
/// A shorter block has too few rows for its background. Set by hand.
pub(crate) const BLOCK_LEAST_ROWS: usize = 60;
/// Share of missing rows above which a block is left out. Set by hand.
pub(crate) const BLOCK_MOST_MISSING: f64 = 0.6;
/// Missing rows one after the other from which the rows before them and behind them are whitened each by themselves. Set by hand: the
/// noise of that long ago says little that the rows between did not.
pub(crate) const LONG_RUN_ROWS: usize = 8;
/// Share of missing rows of a stretch, those of long runs not counted, above which its blocks are as short as may be: each is a nuisance
/// column of its own, and many of them cost less in short blocks. Set by hand.
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
/// Standard deviations of a prediction error from which the rest of it is an event: a normal one is larger once in 2,000.
/// Set by hand.
pub(crate) const EVENT_SIGMAS: f64 = 3.5;
/// Share of the power of the prediction errors that events must have to be looked at. Set by hand: of Student's t with 4 degrees of
/// freedom they have 0.17, with 3 0.36.
pub(crate) const EVENT_LEAST_SHARE: f64 = 0.2;
/// Variance of the middle of the prediction errors from which noise without events is told as too quiet, 1 being right. Set by hand.
pub(crate) const EVENT_MOST_VARIANCE: f64 = 1.5;
/// Samples for each column of the motion that is taken out of what noise is told from. Set by hand.
pub(crate) const MOTION_SAMPLES_PER_COLUMN: usize = 20;
/// Largest power density of noise over the smallest. Derived: that of the reddest noise that a sensor has, AR(1) of 0.9, is 361;
/// three times that, as both are estimates.
pub(crate) const SPECTRUM_MOST_RATIO: f64 = 1000.0;
/// How much steeper than flat the spectrum of a sensor's noise falls at most, in powers of the frequency: that of a random walk, the
/// reddest noise there is of what only follows itself.
pub(crate) const SPECTRUM_STEEPEST: f64 = 2.0;
/// Standard errors by which a band must stand out of what the others allow it, and what the levels of two are off by beside their
/// errors, as a logarithm. Set by hand.
pub(crate) const SPECTRUM_SHAPE_SIGMAS: f64 = 3.0;
pub(crate) const SPECTRUM_SHAPE_ERROR: f64 = 0.15;
/// Share of the power of a band from which on the noise of the direction matters there: below, the shape of a sensor's noise holds for all
/// of it. Set by hand.
pub(crate) const SPECTRUM_DIRECTION_LEAST: f64 = 0.3;
/// Share of the power of its draws that a residual has at least where the noise of the direction is in it. Set by hand: on four recordings
/// that have it 0.85 to 1.1.
pub(crate) const SPECTRUM_DIRECTION_PRESENT: f64 = 0.5;
/// What the power of the noise of the direction is off by, as its draws have it, as a share, and the share of the power of a band that a
/// sensor has at least beside it. Set by hand: how white the fluxgate's noise is, and how equal in its components, is not known well.
pub(crate) const SPECTRUM_DIRECTION_ERROR: f64 = 0.3;
pub(crate) const SPECTRUM_LEAST_REST: f64 = 0.05;
/// Variance of the noise that smoothing leaves in the direction, over that of its draws, at most: their size is known, but
/// for how white the fluxgate's noise is and how equal in its components. Set by hand: more would hide a dead zone.
pub(crate) const DIRECTION_MOST: f64 = 3.0;
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

/// Twice the log likelihood that exact repeats must gain over chance to be an effect: one recording in 5e8, chi-squared
/// with one degree of freedom, because many recorders repeat readings for reasons of their own.
pub(crate) const REPEATS_GLRT: f64 = 36.0;
/// The scalar's field is subtracted from the fluxgate's magnitude where that leaves at most this share of its power: where
/// it does not, its noise is more than what the two share.
pub(crate) const COMMON_FIELD: f64 = 0.8;
/// Samples that a diagnosis needs at least, in stretches without long gaps: half a minute.
pub(crate) const LEAST_SAMPLES: usize = 300;
