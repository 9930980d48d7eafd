//! Recorded columns that may carry a gap.

/// Share of what 18 terms and background leave that a recorded column must explain, how many times as much as it does turned
/// round in time, and in how many ways it is turned. Set by hand: turned round it has its own course and colour, but nothing
/// to do with the reading.
pub(crate) const COLUMN_LEAST_SHARE: f64 = 0.12;
pub(crate) const COLUMN_BEYOND_TURNED: f64 = 1.5;
pub(crate) const COLUMN_TURNS: usize = 60;
/// Share that three directions must close over one, for them to be told. Set by hand.
pub(crate) const COLUMN_DIRECTED_GAIN: f64 = 0.02;
/// Lengths of the blocks that have a background of their own there, s: an edge of a block may take an event that is near it.
pub(crate) const COLUMN_LENGTHS_S: [f64; 4] = [55.0, 65.0, 75.0, 90.0];
/// Time constants by which the field may follow the current that was recorded, s. Set by hand.
pub(crate) const COLUMN_LAGS_S: [f64; 3] = [0.0, 0.2, 0.5];
/// Rows by which the column may be written later than the reading: two logs, or a reading that is averaged. Set by hand.
pub(crate) const COLUMN_SHIFTS_ROWS: [i32; 5] = [-2, -1, 0, 1, 2];
/// No scalar sensor has more noise, nT^2/Hz: 0.22 nT in 1 Hz, that of a proton magnetometer. What is more is no noise.
pub(crate) const MOST_NOISE_NT2_PER_HZ: f64 = 0.05;
/// The same of a column that a user asked for: -2 to 2 s, without a low-pass.
pub(crate) const ASKED_SHIFT_ROWS: i32 = 20;
