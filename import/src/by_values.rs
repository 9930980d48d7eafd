//! Columns without names: what they are by their values alone.

use crate::finding::Finding;
use crate::source::{FindingKind, SourceTable};

/// The Earth's field with what stands near it, nT.
const EARTH_NT: std::ops::RangeInclusive<f64> = 15_000.0..=90_000.0;
/// Magnitude and total field agree within this part.
const AGREES: f64 = 0.1;
/// A time's steps are its median within this part, for nine rows in ten.
const EVEN: f64 = 0.5;

/// Name the time, the scalar and the fluxgate of a table that has no names, where the values leave no doubt: a column that
/// goes on evenly, one of the size of the Earth's field, and three in a row whose magnitude is that one.
pub(crate) fn name(table: &mut SourceTable) -> Option<Finding> {
    let time = (0..table.columns.len()).find(|&at| numbers(table, at).is_some_and(goes_on))?;
    let scalars: Vec<usize> = (0..table.columns.len()).filter(|&at| at != time && is_field(table, at)).collect();
    let found = scalars.into_iter().find_map(|scalar| Some((scalar, vector(table, scalar, time)?)))?;
    let (scalar, [x, y, z]) = found;
    for (at, name) in [(time, "time"), (scalar, "scalar"), (x, "flux_x"), (y, "flux_y"), (z, "flux_z")] {
        table.columns[at].name = name.into();
    }
    let text = format!(
        "the columns have no names; by their values {} is the time, {} the scalar, {} to {} are the fluxgate",
        time + 1,
        scalar + 1,
        x + 1,
        z + 1
    );
    Some(Finding::new(FindingKind::Choice, text).with("--time, --scalar and --flux with column_N"))
}

fn numbers(table: &SourceTable, at: usize) -> Option<&[f64]> {
    table.columns[at].as_numbers()
}

/// Increases by even steps.
fn goes_on(numbers: &[f64]) -> bool {
    let mut steps: Vec<f64> =
        numbers.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite()).collect();
    if steps.len() < 10 {
        return false;
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
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
