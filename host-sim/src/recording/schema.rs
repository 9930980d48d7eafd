//! The columns of one recording: which known ones there are and where, and the names of all.

use super::error::BadInput;
use crate::message::shortened;
use towmag_recording::{Column, ColumnKind, load_of};

/// Longest rendering of the whole header in a message.
const LONGEST_HEADER: usize = 120;

/// The columns of a recording. Positions are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schema {
    names: Vec<Vec<u8>>,
    positions: [Option<usize>; Column::COUNT],
    /// Time, scalar and the three axes of the fluxgate.
    required: [usize; 5],
    /// Columns of numbers, in the order of [`Column`].
    numbers: Vec<(Column, usize)>,
    /// Columns of flags, in the order of [`Column`].
    flags: Vec<(Column, usize)>,
    loads: Vec<LoadColumn>,
}

/// A `current_<load>_A` column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadColumn {
    /// `<load>`.
    pub load: String,
    /// Where it is.
    pub position: usize,
}

impl Schema {
    /// From the names of the columns, without blanks around them. They need not be UTF-8.
    ///
    /// # Errors
    ///
    /// When a required column is missing, or a known one is there twice.
    pub fn new(names: impl IntoIterator<Item = impl Into<Vec<u8>>>) -> Result<Self, BadInput> {
        let names: Vec<Vec<u8>> = names.into_iter().map(Into::into).collect();
        let mut positions = [None; Column::COUNT];
        let mut loads: Vec<LoadColumn> = Vec::new();
        for (position, name) in names.iter().enumerate() {
            // Known names are ASCII: one that is not even UTF-8 is none of them.
            let Ok(name) = std::str::from_utf8(name) else { continue };
            if let Some(column) = Column::named(name) {
                if positions[column as usize].replace(position).is_some() {
                    return Err(twice(name));
                }
            } else if let Some(load) = load_of(name) {
                if loads.iter().any(|known| known.load == load) {
                    return Err(twice(name));
                }
                loads.push(LoadColumn { load: load.into(), position });
            }
        }
        let [Some(t), Some(s), Some(x), Some(y), Some(z)] = Column::REQUIRED.map(|column| positions[column as usize])
        else {
            return Err(missing(&positions, &names));
        };
        let [numbers, flags] = [ColumnKind::Number, ColumnKind::Flag].map(|kind| of_kind(&positions, kind));
        Ok(Self { names, positions, required: [t, s, x, y, z], numbers, flags, loads })
    }

    /// The names of all columns, in the order of the recording.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        self.names.iter().map(Vec::as_slice)
    }

    /// The name of a column.
    pub fn name(&self, position: usize) -> &[u8] {
        &self.names[position]
    }

    /// How many columns there are.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there are none, which no recording is.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Where a known column is, if it is there.
    pub fn position(&self, column: Column) -> Option<usize> {
        self.positions[column as usize]
    }

    /// Whether a known column is there.
    pub fn has(&self, column: Column) -> bool {
        self.position(column).is_some()
    }

    /// Where time, scalar and the three axes of the fluxgate are.
    pub fn required(&self) -> [usize; 5] {
        self.required
    }

    /// The known columns of numbers and where they are, in the order of [`Column`].
    pub fn numbers(&self) -> &[(Column, usize)] {
        &self.numbers
    }

    /// The known columns of flags and where they are, in the order of [`Column`].
    pub fn flags(&self) -> &[(Column, usize)] {
        &self.flags
    }

    /// The currents of loads, in the order of the recording.
    pub fn loads(&self) -> &[LoadColumn] {
        &self.loads
    }
}

fn of_kind(positions: &[Option<usize>; Column::COUNT], kind: ColumnKind) -> Vec<(Column, usize)> {
    let of = Column::all().filter(|column| column.spec().kind == kind);
    of.filter_map(|column| Some((column, positions[column as usize]?))).collect()
}

fn twice(name: &str) -> BadInput {
    BadInput::of(name.as_bytes(), "is there twice: rename or remove one of the two columns".into())
}

fn missing(positions: &[Option<usize>; Column::COUNT], names: &[Vec<u8>]) -> BadInput {
    let missing = Column::REQUIRED.into_iter().filter(|&column| positions[column as usize].is_none());
    let missing: Vec<_> = missing.map(Column::name).collect();
    let there = shortened(&names.join(&b", "[..]), LONGEST_HEADER);
    BadInput::of_line(format!(
        "required columns are missing: {}; the header has: {there}; `host-sim import` reads files of other recorders",
        missing.join(", ")
    ))
}
