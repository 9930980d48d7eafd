//! The columns of a table in the units of the recording, under the names that they will have.

use std::sync::Arc;

use towmag_recording::{Column, ColumnKind};

use crate::draft::{Draft, DraftColumn, DraftValues};
use crate::meaning::{Meaning, Times};
use crate::source::{SourceTable, Values};

/// The columns in the units of the recording.
pub(crate) fn draft(table: &SourceTable, times: &Times, meaning: &Meaning) -> Draft {
    let mut columns: Vec<DraftColumn> = Vec::new();
    for (target, assigned) in &meaning.columns {
        let known = Column::named(target);
        let is_label = known.is_some_and(|known| known.spec().kind == ColumnKind::Label);
        let (factor, offset) = (assigned.factor, assigned.offset);
        let is_made = factor != 1.0 || offset != 0.0;
        let values = match &table.columns[assigned.at].values {
            Values::Numbers(numbers) | Values::Times(numbers) if is_label => {
                DraftValues::Labels(numbers.iter().map(|number| label(*number)).collect())
            }
            Values::Numbers(numbers) | Values::Times(numbers) if is_made => {
                DraftValues::Numbers(numbers.iter().map(|number| number * factor + offset).collect())
            }
            values => carried(values),
        };
        columns.push(DraftColumn { name: target.clone(), known, values, is_made });
    }
    for &at in &meaning.carried {
        let column = &table.columns[at];
        let name = free_name(&column.name, &columns);
        columns.push(DraftColumn { name, known: None, values: carried(&column.values), is_made: false });
    }
    let time_s = times.seconds.clone();
    Draft { invalid: vec![false; time_s.len()], time_s, is_utc: times.is_utc, is_clock: times.is_clock, columns }
}

fn carried(values: &Values) -> DraftValues {
    match values {
        Values::Numbers(numbers) | Values::Times(numbers) => DraftValues::Numbers(numbers.clone()),
        Values::Text(texts) => DraftValues::Labels(texts.clone()),
    }
}

fn label(number: f64) -> Arc<str> {
    if number.is_finite() { format!("{number}").into() } else { "".into() }
}

/// A name that neither the recording's own columns nor another one has.
pub(crate) fn free_name(name: &str, columns: &[DraftColumn]) -> String {
    let is_taken = |name: &str| {
        Column::named(name).is_some()
            || towmag_recording::load_of(name).is_some()
            || columns.iter().any(|column| column.name == name)
    };
    if !is_taken(name) {
        return name.to_string();
    }
    let numbered =
        (1..).map(|number| if number == 1 { format!("{name}_source") } else { format!("{name}_source{number}") });
    numbered.into_iter().find(|free| !is_taken(free)).unwrap_or_default()
}
