//! Reconstruction of the motion, and the steps of recorders.

/// Missing rows in a row that are bridged, of the direction and within a block. Set by hand: across more,
/// a direction is a guess.
pub(crate) const BRIDGED_ROWS: usize = 4;
/// Longer pauses count as this long, s: nothing acts across them, and the dense grid must stay small. Set by hand.
pub(crate) const LONGEST_PAUSE_S: f64 = 3600.0;
/// Moving average of a temperature, rows: no sensor in a housing follows faster than in 15 s. Set by hand.
pub(crate) const TEMPERATURE_ROWS: usize = 150;
/// What a coefficient of the 18 terms may be before anything is fitted, nT rms in a field of their unit (nT s of eddy currents), where
/// the field is told from the body's own. Set by hand: a loud body has hundreds, and a fit to few headings may have ten times the field.
pub(crate) const COEFFICIENT_PRIOR_NT: f64 = 1000.0;
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
/// Power over that of the noise from which a moment has motion at a frequency. Set by hand: eleven powers with that
/// taper are about five independent ones, of which noise alone exceeds it once in 100,000.
pub(crate) const MOMENT_LEAST_RATIO: f64 = 4.0;
/// The same of that frequency and the next ones alone, which the power beside it has no part in. Set by hand: of noise, one in ten.
pub(crate) const MOMENT_LEAST_RATIO_NEAR: f64 = 2.0;
/// Above this motion is told moment by moment, Hz: a moment of 9.6 s does not tell slower motion. Set by hand.
pub(crate) const MOMENT_SLOWEST_HZ: f64 = 0.4;
/// Mean square of the smoothing's residual near a row, over that of noise, below which the smoothed value stays, and from
/// which the reading counts alone. Set by hand.
pub(crate) const READING_TRUSTED_RATIOS: [f64; 2] = [4.0, 9.0];

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
