//! Columns that can be a scalar sensor's.

use super::columns::told_unit;
use super::names::{normalised, stem};
use crate::field::EARTH_NT;
use crate::source::SourceColumn;
use crate::statistics::median;
use crate::units::Dimension;

/// A column that can be the total field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    /// Where it is.
    pub(super) at: usize,
    /// How likely; more is likelier.
    pub(super) score: u32,
    /// To nT.
    pub(super) factor: f64,
    /// The file says its unit, or it is nT by size.
    pub(super) is_sure: bool,
}

/// Words of names of what is made from a total field, or goes with it.
const DERIVED: [&str; 22] = [
    "igrf",
    "diurnal",
    "base",
    "grad",
    "res",
    "anom",
    "valid",
    "std",
    "lev",
    "lag",
    "dc",
    "rmi",
    "rmf",
    "final",
    "noise",
    "signal",
    "quality",
    "interference",
    "age",
    "deriv",
    "diff",
    "year",
];
const NAMES: [&str; 30] = [
    "scalar",
    "mag_1_uc",
    "mag1",
    "mag_1",
    "mag",
    "magnetometer",
    "mag_raw",
    "raw_mag",
    "rawmag",
    "mag_uc",
    "tmi",
    "total_field",
    "totalfield",
    "total",
    "field",
    "f",
    "mag_tot",
    "tfield",
    "mag_top",
    "b_total",
    "btotal",
    "magfield",
    "mag_field",
    "magnetic_field",
    "reading",
    "gamma",
    "gammas",
    "n_t",
    "reading_1",
    "reading_2",
];

/// The candidates, the likeliest first; of equals the first in the file.
pub(super) fn candidates(columns: &[SourceColumn], taken: &[usize]) -> Vec<Candidate> {
    let mut found: Vec<Candidate> = columns
        .iter()
        .enumerate()
        .filter(|(at, _)| !taken.contains(at))
        .filter_map(|(at, column)| candidate(at, column))
        .collect();
    found.sort_by_key(|candidate| std::cmp::Reverse(candidate.score));
    found
}

fn candidate(at: usize, column: &SourceColumn) -> Option<Candidate> {
    let numbers = column.as_numbers()?;
    let name = normalised(&column.name);
    let by_name = by_name(&column.name, &name)?;
    let unit = told_unit(column);
    if unit.is_some_and(|unit| !matches!(unit.dimension, Dimension::Field | Dimension::Number)) {
        return None;
    }
    let told = unit.filter(|unit| unit.dimension == Dimension::Field).map(|unit| unit.factor);
    let (median, present) = median_of_size(numbers)?;
    let factor = told.filter(|factor| EARTH_NT.contains(&(median * factor))).or_else(|| factor_by_size(median))?;
    let is_sure = told == Some(factor) || factor == 1.0;
    // A name alone, or a unit alone, or a value as the Earth's in nT: one of the three must speak for it.
    let score = by_name + u32::from(told.is_some()) * 40 + u32::from(factor == 1.0) * 20;
    let complete = if present >= 0.9 { 30 } else { 0 };
    (score >= 40).then_some(Candidate { at, score: score + complete, factor, is_sure })
}

fn by_name(given: &str, name: &str) -> Option<u32> {
    if given == "scalar_nT" {
        return Some(1000);
    }
    let stem = stem(name);
    let stem = stem.strip_suffix("_n").unwrap_or(stem);
    if DERIVED.iter().any(|word| stem.split('_').any(|token| token.starts_with(word))) {
        return None;
    }
    let raw = stem.split('_').any(|token| token == "uc" || token == "raw");
    let compensated = stem.ends_with("_c") || stem.contains("comp");
    let exact = NAMES.contains(&stem);
    let keyword = ["mag", "tmi", "scalar", "field", "rb", "cs", "rdg"].iter().any(|word| stem.contains(word));
    let score = match () {
        () if compensated => 25,
        () if raw => 95,
        () if exact => 90,
        () if keyword => 50,
        () => 0,
    };
    Some(score)
}

/// The median of the sizes that are not zero, and the part of the rows that have a value.
pub(super) fn median_of_size(numbers: &[f64]) -> Option<(f64, f64)> {
    let stride = (numbers.len() / 4096).max(1);
    let looked_at = numbers.len().div_ceil(stride);
    let sizes: Vec<f64> =
        numbers.iter().step_by(stride).filter(|value| value.is_finite() && **value != 0.0).map(|v| v.abs()).collect();
    let present = sizes.len() as f64 / looked_at as f64;
    Some((median(sizes)?, present))
}

/// The factor to nT that makes a size one of the Earth's field: of units that are in use.
pub(super) fn factor_by_size(median: f64) -> Option<f64> {
    [1.0, 1e3, 1e5, 1e2, 1e-3, 1e9].into_iter().find(|factor| EARTH_NT.contains(&(median * factor)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(columns: &[(&str, f64)]) -> Vec<String> {
        let columns: Vec<_> =
            columns.iter().map(|(name, value)| SourceColumn::numbers(*name, vec![*value; 10])).collect();
        candidates(&columns, &[]).iter().map(|candidate| columns[candidate.at].name.clone()).collect()
    }

    #[test]
    fn what_is_raw_comes_before_what_is_made_of_it() {
        let columns = [("mag_1_c", 5e4), ("mag_1_lag", 5e4), ("mag_1_uc", 5e4), ("mag_2_uc", 5e4), ("mag_1_igrf", 3.0)];
        assert_eq!(order(&columns), ["mag_1_uc", "mag_2_uc", "mag_1_c"]);
        assert_eq!(order(&[("TMI", 5e4), ("Mag_Filt", 5e4), ("Mag_Raw", 5e4)])[0], "Mag_Raw");
        assert_eq!(order(&[("depth", 3.0), ("b", 4.9e4)]), [""; 0]);
    }

    #[test]
    fn units_by_size() {
        for (median, factor) in
            [(51.3, 1e3), (0.513, 1e5), (513.0, 1e2), (51_300.0, 1.0), (5.13e7, 1e-3), (5.13e-5, 1e9)]
        {
            assert_eq!(factor_by_size(median), Some(factor), "{median}");
        }
        assert_eq!(factor_by_size(3.0), None);
    }
}
