//! HDF5: the flights of the MagNav data sets (flat lists of equal length, with scalars `N` and `dt`), and MATLAB 7.3.

use hdf5_pure::{DType, Dataset, File, Group, VlenStringReadOptions};

use super::fields::{self, Field, Part};
use super::format::{Input, SourceFormat};
use super::memory::Budget;
use crate::error::ImportError;
use crate::source::{FindingKind, Note, Source, SourceColumn, SourceTable, Values};

/// Reader of HDF5.
pub(super) struct MagNavHdf5;

/// Every HDF5 file has it at the start, or after a block of 512, 1024, ... bytes of another program, as MATLAB's.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Groups within groups: deeper ones hold no readings, and links may lead round in circles.
const DEEPEST: usize = 3;
/// More datasets than any recording has.
const MOST_FIELDS: usize = 10_000;

impl SourceFormat for MagNavHdf5 {
    fn name(&self) -> &'static str {
        "MagNav HDF5"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        let mut places = std::iter::once(0).chain((9..).map(|power| 1_usize << power));
        places.by_ref().map_while(|place| first.get(place..)).any(|bytes| bytes.starts_with(SIGNATURE))
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let format = if input.bytes.starts_with(b"MATLAB") { "MATLAB 7.3" } else { self.name() };
        let table = read(input)?;
        Ok(Source { file: input.file.into(), format, tables: vec![table] })
    }
}

/// Why a file cannot be read.
#[derive(Debug, thiserror::Error)]
enum Fault {
    #[error("is cut or damaged ({0}): copy it again from where it was made")]
    Damaged(hdf5_pure::Error),
    #[error("is stored in a way that is not known here ({0}): write it again with `h5repack -f GZIP=6 --high=3`")]
    Unknown(hdf5_pure::Error),
    #[error(transparent)]
    TooLarge(#[from] super::memory::TooLarge),
    #[error(
        "is cut or damaged (\"{0}\" has other numbers of values than it says): copy it again from where it was made"
    )]
    Count(String),
    #[error("has more than {MOST_FIELDS} datasets: it is no recording")]
    TooMany,
}

impl From<hdf5_pure::Error> for Fault {
    fn from(error: hdf5_pure::Error) -> Self {
        use hdf5_pure::{Error, FormatError};
        match &error {
            Error::Format(
                FormatError::UnsupportedVersion(_)
                | FormatError::InvalidLayoutVersion(_)
                | FormatError::UnsupportedFilter(_)
                | FormatError::UnsupportedVirtualLayout
                | FormatError::UnsupportedExternalStorage,
            ) => Self::Unknown(error),
            _ => Self::Damaged(error),
        }
    }
}

fn read(input: &Input<'_>) -> Result<SourceTable, ImportError> {
    let refused = |fault: Fault| ImportError::file(input.file, fault.to_string());
    let parts = parts(input.bytes).map_err(refused)?;
    let (part, mut notes) = fields::choose(input.file, parts, input.part)?;
    let mut table = table(part, &mut Budget::of(input.bytes.len())).map_err(refused)?;
    notes.append(&mut table.notes);
    Ok(SourceTable { notes, ..table })
}

/// The datasets of the file itself, then those of its groups.
fn parts(bytes: &[u8]) -> Result<Vec<Part<Dataset>>, Fault> {
    let root = File::from_bytes(bytes.to_vec())?.root();
    let mut parts = vec![Part { name: String::new(), fields: Vec::new() }];
    let mut left = MOST_FIELDS;
    collect(&root, "", 0, &mut left, &mut parts[0].fields)?;
    for (name, group) in root.iter_groups()? {
        // MATLAB keeps there what cells refer to.
        if !name.starts_with('#') {
            let mut fields = Vec::new();
            collect(&group, "", DEEPEST, &mut left, &mut fields)?;
            parts.push(Part { name, fields });
        }
    }
    Ok(parts)
}

fn collect(
    group: &Group,
    prefix: &str,
    deeper: usize,
    left: &mut usize,
    fields: &mut Vec<Field<Dataset>>,
) -> Result<(), Fault> {
    for (name, dataset) in group.iter_datasets()? {
        *left = left.checked_sub(1).ok_or(Fault::TooMany)?;
        // The last dimension is the one along which values are neighbours.
        let sizes: Vec<usize> = dataset.shape()?.iter().rev().map(|size| clamped(*size)).collect();
        fields.push(Field::new(format!("{prefix}{name}"), sizes.into_iter(), dataset));
    }
    if deeper > 0 {
        for (name, group) in group.iter_groups()? {
            *left = left.checked_sub(1).ok_or(Fault::TooMany)?;
            collect(&group, &fields::prefix(prefix, &name), deeper - 1, left, fields)?;
        }
    }
    Ok(())
}

fn clamped(size: u64) -> usize {
    usize::try_from(size).unwrap_or(usize::MAX)
}

fn table(part: Part<Dataset>, budget: &mut Budget) -> Result<SourceTable, Fault> {
    let single = |name: &str| part.fields.iter().find(|field| field.name == name && field.is_single());
    let told = single("N").map(|field| number(&field.data)).transpose()?.flatten();
    let interval_s = single("dt").map(|field| number(&field.data)).transpose()?.flatten();
    let rows = fields::rows(&part.fields, told.map(|told| told as usize));
    let (taken, mut left_out) = fields::of_length(part.fields, rows);
    let mut columns = Vec::new();
    for field in &taken {
        match values(field, rows, budget)? {
            Some(values) if values.len() != field.count() => return Err(Fault::Count(field.name.clone())),
            Some(values) => columns.extend(field.columns(values, rows).into_iter().map(|c| with_unit(c, &field.data))),
            None => left_out.push(field.name.clone()),
        }
    }
    let columns: Vec<SourceColumn> = fields::with_known_units(columns);
    let mut table = fields::table(part.name, rows, columns, interval_s, &left_out);
    table.notes.extend(disagreement(told, rows));
    Ok(table)
}

/// One number.
fn number(dataset: &Dataset) -> Result<Option<f64>, Fault> {
    Ok(if is_number(&dataset.dtype()?) { dataset.read_f64()?.first().copied() } else { None })
}

fn is_number(kind: &DType) -> bool {
    use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    matches!(kind, F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64)
}

/// What the dataset holds, if it is of a sort that a table can have.
fn values(field: &Field<Dataset>, rows: usize, budget: &mut Budget) -> Result<Option<Values>, Fault> {
    let (dataset, count) = (&field.data, field.count());
    // Both are in memory at a time: what the file has, and what is made of it.
    budget.take(count, clamped(dataset.element_size()?).saturating_add(size_of::<f64>()))?;
    // A part of it, as it is stored, may be larger than all of it.
    let chunk =
        dataset.chunk_shape()?.unwrap_or_default().iter().fold(1, |n: usize, size| n.saturating_mul(clamped(*size)));
    budget.clone().take(chunk, clamped(dataset.element_size()?))?;
    Ok(match dataset.dtype()? {
        kind if is_number(&kind) => Some(Values::Numbers(dataset.read_f64()?)),
        // h5py writes what is true or false as an enumeration of one byte.
        DType::Enum(_) if count == rows && dataset.element_size()? == 1 => {
            Some(Values::Numbers(dataset.read_raw()?.into_iter().map(f64::from).collect()))
        }
        DType::String if count == rows => Some(fields::texts(dataset.read_string()?.into_iter())),
        DType::VariableLengthString if count == rows => {
            let limits = VlenStringReadOptions::new().with_max_elements(rows).with_max_payload_bytes(budget.left());
            let texts = dataset.read_vlen_strings(limits)?;
            budget.take(texts.iter().map(String::len).sum(), 1)?;
            Some(fields::texts(texts.into_iter()))
        }
        _ => None,
    })
}

/// Some writers give the unit as an attribute.
fn with_unit(column: SourceColumn, dataset: &Dataset) -> SourceColumn {
    use hdf5_pure::AttrValue::{AsciiString, String};
    let attributes = dataset.attrs().unwrap_or_default();
    match ["units", "unit"].iter().find_map(|name| attributes.get(*name)) {
        Some(String(unit) | AsciiString(unit)) => column.in_unit(unit.trim_matches(['\0', ' '])),
        _ => column,
    }
}

fn disagreement(told: Option<f64>, rows: usize) -> Option<Note> {
    let told = told.filter(|told| *told != rows as f64)?;
    let text = format!("the file says that it has {told} rows; its columns have {rows}");
    Some(Note { kind: FindingKind::Choice, text })
}

#[cfg(test)]
mod tests;
