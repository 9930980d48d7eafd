//! Milliseconds in a column of their own, beside stamps of whole seconds.

use super::super::names::normalised;
use crate::source::SourceTable;

const NAMES: [&str; 6] = ["millisec", "millisecond", "milliseconds", "msec", "ms", "millis"];

/// Add them, where there are some and the stamps are whole.
pub(super) fn add(table: &SourceTable, seconds: &mut [f64]) {
    let is_whole = seconds.iter().all(|second| !second.is_finite() || second.fract() == 0.0);
    let is_part = |numbers: &&[f64]| {
        let within = numbers.iter().all(|number| (0.0..1000.0).contains(number));
        within && numbers.iter().any(|number| *number > 0.0)
    };
    let named = table.columns.iter().filter(|column| NAMES.contains(&normalised(&column.name).as_str()));
    if let Some(parts) = named.filter_map(|column| column.as_numbers()).find(is_part).filter(|_| is_whole) {
        seconds.iter_mut().zip(parts).for_each(|(second, part)| *second += part * 1e-3);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceColumn;

    fn added(parts: &[f64], mut seconds: Vec<f64>) -> Vec<f64> {
        let columns = vec![SourceColumn::numbers("Millisec", parts.to_vec())];
        add(&SourceTable { rows: parts.len(), columns, ..SourceTable::default() }, &mut seconds);
        seconds
    }

    #[test]
    fn they_are_added_to_whole_seconds_alone() {
        assert_eq!(added(&[0.0, 500.0], vec![7.0, 7.0]), [7.0, 7.5]);
        assert_eq!(added(&[0.0, 500.0], vec![7.1, 7.6]), [7.1, 7.6]);
        assert_eq!(added(&[0.0, 5000.0], vec![7.0, 8.0]), [7.0, 8.0]);
    }
}
