//! Columns without names: what they are by their values alone.

use crate::field::EARTH_NT;
use crate::finding::Finding;
use crate::source::{FindingKind, SourceTable};
use crate::statistics::median;

/// Magnitude and total field agree within this part.
const AGREES: f64 = 0.1;
/// A time's steps are its median within this part, for nine rows in ten.
const EVEN: f64 = 0.5;

/// The channel that goes with a reading has four digits.
const SIGNAL: std::ops::RangeInclusive<f64> = 0.0..=9999.0;

/// Names the columns of a table that has no names, where the values leave no doubt.
pub(crate) fn name(table: &mut SourceTable) -> Option<Finding> {
    let time = (0..table.columns.len()).find(|&at| numbers(table, at).is_some_and(goes_on));
    match time {
        Some(time) => with_time(table, time),
        None => readings(table),
    }
}

/// Time, scalar and fluxgate: a column that goes on evenly, one of the size of the Earth's field, and three in a row whose
/// magnitude is that one.
fn with_time(table: &mut SourceTable, time: usize) -> Option<Finding> {
    let scalars: Vec<usize> = (0..table.columns.len()).filter(|&at| at != time && is_field(table, at)).collect();
    let found = scalars.into_iter().find_map(|scalar| Some((scalar, vector(table, scalar, time)?)))?;
    let (scalar, [x, y, z]) = found;
    rename(table, &[(time, "time"), (scalar, "scalar"), (x, "flux_x"), (y, "flux_y"), (z, "flux_z")]);
    let [time, scalar, x, z] = [time, scalar, x, z].map(|at| at + 1);
    let text = format!(
        "the columns have no names; by their values {time} is the time, {scalar} the scalar, {x} to {z} are the fluxgate"
    );
    Some(Finding::new(FindingKind::Choice, text).with("--time, --scalar and --flux with column_N"))
}

/// What a counter writes by itself, `$ 49895.131,1249`: the field, and the four digits of its signal.
fn readings(table: &mut SourceTable) -> Option<Finding> {
    let is_signal = |number: &f64| SIGNAL.contains(number) && number.fract() == 0.0;
    let signal = table.columns.get(1).and_then(|column| column.as_numbers())?;
    if !is_field(table, 0) || !signal.iter().filter(|number| !number.is_nan()).all(is_signal) {
        return None;
    }
    rename(table, &[(0, "scalar"), (1, "signal")]);
    let text = "the columns have no names; by their values 1 is the scalar and 2 its signal";
    Some(Finding::new(FindingKind::Choice, text).with("--scalar column_N"))
}

fn rename(table: &mut SourceTable, names: &[(usize, &str)]) {
    for (at, name) in names {
        table.columns[*at].name = (*name).into();
    }
}

fn numbers(table: &SourceTable, at: usize) -> Option<&[f64]> {
    table.columns[at].as_numbers()
}

/// Increases by even steps.
fn goes_on(numbers: &[f64]) -> bool {
    let steps: Vec<f64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite()).collect();
    if steps.len() < 10 {
        return false;
    }
    let usual = median(steps.clone()).unwrap_or(0.0);
    let even = steps.iter().filter(|step| (*step / usual - 1.0).abs() < EVEN).count();
    usual > 0.0 && even * 10 >= steps.len() * 9
}

fn is_field(table: &SourceTable, at: usize) -> bool {
    let Some(numbers) = numbers(table, at) else { return false };
    let inside = numbers.iter().filter(|number| EARTH_NT.contains(*number)).count();
    inside * 10 >= numbers.len() * 9
}

/// Three columns in a row, none of them scalar or time, whose magnitude is the scalar's.
fn vector(table: &SourceTable, scalar: usize, time: usize) -> Option<[usize; 3]> {
    let total = numbers(table, scalar)?;
    (0..table.columns.len().saturating_sub(2)).map(|at| [at, at + 1, at + 2]).find(|axes| {
        let parts: Vec<&[f64]> = axes.iter().filter_map(|&at| numbers(table, at)).collect();
        let [x, y, z] = parts.as_slice() else { return false };
        let agrees = |row: &usize| {
            let size = (x[*row].powi(2) + y[*row].powi(2) + z[*row].powi(2)).sqrt();
            (size / total[*row] - 1.0).abs() < AGREES
        };
        let agreeing = (0..table.rows).filter(agrees).count();
        !axes.contains(&scalar) && !axes.contains(&time) && agreeing * 10 >= table.rows * 9
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceColumn;

    fn table(columns: Vec<Vec<f64>>) -> SourceTable {
        let rows = columns[0].len();
        let column = |(at, numbers)| SourceColumn::numbers(format!("column_{}", at + 1), numbers);
        SourceTable { rows, columns: columns.into_iter().enumerate().map(column).collect(), ..SourceTable::default() }
    }

    fn names(table: &SourceTable) -> Vec<&str> {
        table.columns.iter().map(|column| column.name.as_str()).collect()
    }

    fn rows(value: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..40).map(|row| value(f64::from(row))).collect()
    }

    #[test]
    fn time_scalar_and_fluxgate_are_known_by_their_values() {
        let scalar = rows(|row| 50_000.0 + row.sin());
        let axes = [0.6, 0.0, 0.8].map(|part| rows(|row| part * (50_000.0 + row.sin())));
        let [x, y, z] = axes;
        let mut table = table(vec![rows(|_| 7.0), rows(|row| 0.1 * row), scalar, rows(|row| row.cos()), x, y, z]);
        let finding = name(&mut table).unwrap();
        assert_eq!(names(&table), ["column_1", "time", "scalar", "column_4", "flux_x", "flux_y", "flux_z"]);
        assert!(finding.text.contains("2 is the time, 3 the scalar, 5 to 7"), "{}", finding.text);
    }

    #[test]
    fn a_counter_alone_writes_its_field_and_its_signal() {
        let mut table = table(vec![rows(|row| 49_895.0 + row.sin()), rows(|row| 1249.0 + (row % 3.0))]);
        assert!(name(&mut table).is_some());
        assert_eq!(names(&table), ["scalar", "signal"]);
    }

    #[test]
    fn where_there_is_doubt_nothing_is_named() {
        let decimals = rows(|row| row.sin() + 0.25);
        let mut doubtful = [
            table(vec![rows(|row| 0.1 * row), rows(|row| 50_000.0 + row.sin())]),
            table(vec![rows(|row| 49_895.0 + row.sin()), decimals]),
            table(vec![rows(|row| 3.0 + row.sin()), rows(|_| 1249.0)]),
        ];
        for table in &mut doubtful {
            assert_eq!(name(table), None);
            assert!(names(table).iter().all(|name| name.starts_with("column_")));
        }
    }
}
