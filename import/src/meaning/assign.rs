//! Which column of a source becomes which column of the recording.

use towmag_recording::Column;

use super::asked;
use super::assigned::Meaning;
use super::magnetic::{assign_flux, assign_scalars};
use super::others::assign_others;
use crate::error::ImportError;
use crate::options::Options;
use crate::source::{SourceColumn, SourceTable, Values};

/// What each column of a table means; `used` are those of the times.
///
/// # Errors
///
/// When a column is asked for that is not there, or holds no numbers.
pub(crate) fn assign(
    file: &str,
    table: &SourceTable,
    used: &[usize],
    options: &Options,
) -> Result<Meaning, ImportError> {
    let mut meaning = Meaning::default();
    asked::assign(file, table, options, &mut meaning)?;
    assign_flux(table, used, &mut meaning);
    assign_scalars(table, used, &mut meaning);
    assign_others(table, used, &mut meaning);
    if let Some(factor) = meaning.field_factor {
        let sensors = Column::FLUX.into_iter().chain([Column::Scalar, Column::Scalar2]);
        for column in sensors {
            if let Some(assigned) = meaning.columns.get_mut(column.name()) {
                (assigned.factor, assigned.is_told) = (factor, true);
            }
        }
    }
    for axis in Column::FLUX {
        if let Some((assigned, factor)) = meaning.columns.get_mut(axis.name()).zip(options.flux_factor) {
            (assigned.factor, assigned.is_told) = (factor, true);
        }
    }
    let taken = meaning.taken();
    let is_left = |at: &usize| !taken.contains(at) && !used.contains(at) && !is_empty(&table.columns[*at]);
    meaning.carried = (0..table.columns.len()).filter(is_left).collect();
    Ok(meaning)
}

/// A column without a name in which nothing stands: a delimiter at the end of each line.
fn is_empty(column: &SourceColumn) -> bool {
    column.name.starts_with("column_")
        && match &column.values {
            Values::Numbers(numbers) | Values::Times(numbers) => numbers.iter().all(|number| number.is_nan()),
            Values::Text(texts) => texts.iter().all(|text| text.is_empty()),
        }
}
