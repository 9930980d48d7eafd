//! Least squares, and where each effect is looked for.

/// Eigenvalue of the columns' correlations, over the largest, up to which a combination of them counts as dependent on
/// the others. Numerical: rounding leaves about 1e-15 of a dependent one.
pub(crate) const DEPENDENT_EIGENVALUE: f64 = 1e-9;
/// Norm up to which a whitened column counts as empty. Numerical.
pub(crate) const EMPTY_COLUMN_NORM: f64 = 1e-12;
/// The two for the few columns of one effect, whose products are small differences of large ones: eigenvalue over the
/// largest, and norm of a column over the largest norm. Numerical.
pub(crate) const UNEXPLAINED_EIGENVALUE: f64 = 1e-8;
pub(crate) const EMPTY_COLUMN_SHARE: f64 = 1e-9;

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

/// Points at which an effect is tried of which only the ranges are known: along one parameter, and over several. Set by hand: a
/// heading error's axis needs 400 over half a sphere for its neighbours to look alike.
pub(crate) const RANGE_POINTS_OF_ONE: usize = 200;
pub(crate) const RANGE_POINTS: usize = 400;
/// The best of them, which are followed uphill, and how often their step is halved. Set by hand; the joint fit goes on.
pub(crate) const RANGE_CLIMBED: usize = 3;
pub(crate) const RANGE_HALVINGS: usize = 5;
/// Positive values over a wider range than this are tried by ratio: a time constant of 0.1 to 10 s. Set by hand.
pub(crate) const RANGE_WIDE_RATIO: f64 = 20.0;
