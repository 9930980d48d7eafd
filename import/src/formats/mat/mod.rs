//! MATLAB files of version 5 to 7 (7.3 is HDF5): "MAT-File Format", The MathWorks, 2023.
//!
//! A reader of its own: the crates that read MAT files know no structs, in which MagNav keeps a flight, or believe what a damaged
//! file claims of its sizes.

mod element;
mod variable;

use self::element::{Fault, Order};
use self::variable::{Content, Variable};
use super::fields::{self, Field, Part};
use super::format::{Input, SourceFormat};
use super::memory::Budget;
use crate::error::ImportError;
use crate::source::{Source, SourceTable, Values};

/// Reader of MATLAB's files.
pub(super) struct Mat;

/// A line of text, then two bytes for the version and two that tell the order of bytes.
const HEADER_BYTES: usize = 128;

impl SourceFormat for Mat {
    fn name(&self) -> &'static str {
        "MATLAB 5"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        first.starts_with(b"MATLAB 5.0") || (first.starts_with(b"MATLAB") && order(first).is_some())
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let refused = |fault: Fault| ImportError::file(input.file, fault.to_string());
        let order = order(input.bytes).ok_or(Fault::Cut("its header")).map_err(refused)?;
        let mut budget = Budget::of(input.bytes.len());
        let body = input.bytes.get(HEADER_BYTES..).unwrap_or_default();
        let variables = variable::all(body, order, &mut budget).map_err(refused)?;
        let (part, mut notes) = fields::choose(input.file, parts(variables), input.part)?;
        let mut table = table(part);
        notes.append(&mut table.notes);
        Ok(Source { file: input.file.into(), format: self.name(), tables: vec![SourceTable { notes, ..table }] })
    }
}

/// As the header tells it, if it is one of version 5.
fn order(header: &[u8]) -> Option<Order> {
    match header.get(124..HEADER_BYTES)? {
        [0x00, 0x01, b'I', b'M'] => Some(Order::Little),
        [0x01, 0x00, b'M', b'I'] => Some(Order::Big),
        _ => None,
    }
}

/// The file's own variables, then each of its structs.
fn parts(variables: Vec<Variable>) -> Vec<Part<Values>> {
    let mut parts = vec![Part { name: String::new(), fields: Vec::new() }];
    for variable in variables {
        match variable.content {
            Content::Structs(structs) => {
                let many = structs.len() > 1;
                parts.extend(structs.into_iter().enumerate().map(|(index, fields)| {
                    let name = if many { format!("{}({})", variable.name, index + 1) } else { variable.name.clone() };
                    Part { name, fields: flat(fields, "") }
                }));
            }
            content => parts[0].fields.extend(flat(vec![Variable { content, ..variable }], "")),
        }
    }
    parts
}

/// Fields of structs within structs get the names of both.
fn flat(variables: Vec<Variable>, prefix: &str) -> Vec<Field<Values>> {
    let mut fields = Vec::new();
    for Variable { name, sizes, content } in variables {
        match content {
            Content::Values(values) => fields.push(Field::new(format!("{prefix}{name}"), sizes.into_iter(), values)),
            Content::Structs(structs) if structs.len() == 1 => {
                fields.extend(structs.into_iter().flat_map(|fields| flat(fields, &fields::prefix(prefix, &name))));
            }
            Content::Structs(_) | Content::Other => {}
        }
    }
    fields
}

fn table(part: Part<Values>) -> SourceTable {
    let single = |name: &str| {
        let field = part.fields.iter().find(|field| field.name == name && field.is_single())?;
        match &field.data {
            Values::Numbers(numbers) => numbers.first().copied(),
            Values::Text(_) | Values::Times(_) => None,
        }
    };
    let (told, interval_s) = (single("N").map(|rows| rows as usize), single("dt"));
    let rows = fields::rows(&part.fields, told);
    let (taken, left_out) = fields::of_length(part.fields, rows);
    let mut columns = Vec::new();
    for mut field in taken {
        let values = std::mem::replace(&mut field.data, Values::Numbers(Vec::new()));
        columns.extend(field.columns(values, rows));
    }
    fields::table(part.name, rows, fields::with_known_units(columns), interval_s, &left_out)
}

#[cfg(test)]
mod tests;
