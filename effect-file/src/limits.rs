//! What a file may hold. Far more than an effect that a person can read has, and as much as a proposal of fitted shapes needs; they keep time and memory bounded.

/// Bytes of a file.
pub const LARGEST_FILE: usize = 65_536;
/// Characters of a formula.
pub const LONGEST_FORMULA: usize = 8000;
/// Parentheses within each other, those of functions included.
pub const MOST_DEPTH: usize = 32;
/// Names of one formula.
pub const MOST_NAMES: usize = 64;
/// Parameters of an effect.
pub const MOST_PARAMETERS: usize = 16;
/// Inputs of an effect.
pub const MOST_INPUTS: usize = 48;
/// Characters of the name of an effect, a parameter, an input or a column.
pub const LONGEST_NAME: usize = 40;
/// Characters of a title or a unit.
pub(crate) const LONGEST_TITLE: usize = 80;
/// Longest time of a filter, s: longer than any recording.
pub(crate) const LONGEST_TIME_S: f64 = 1e9;
/// Largest value of a bound: beyond, squares of it are no numbers any more.
pub(crate) const LARGEST_BOUND: f64 = 1e100;
