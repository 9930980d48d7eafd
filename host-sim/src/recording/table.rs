//! A whole recording in memory, column by column: for what needs more than a row at a time.

use std::sync::Arc;

use super::bad_rows::BadRows;
use super::error::RecordingError;
use super::reader::RecordingReader;
use super::row::RecordingRow;
use super::schema::Schema;
use super::stamps;
use towmag_import::standing_still;
use towmag_recording::{Column, ColumnKind, LOAD_UNIT, load_of};

/// The known columns of a recording, all of the same length. Columns that are not known are left out unless asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    file: String,
    usable: Vec<bool>,
    columns: Vec<TableColumn>,
    bad_rows: BadRows,
}

/// A column of a [`Table`].
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// As in the header.
    pub name: String,
    /// Unit of its numbers; empty where there is none.
    pub unit: &'static str,
    /// One value a row.
    pub values: ColumnValues,
    /// The smallest step with which its numbers are written in the usable rows, in its unit; `None` when none is there.
    pub resolution: Option<f64>,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnValues {
    /// NaN where the value is missing.
    Numbers(Vec<f64>),
    /// `None` where the value is missing.
    Flags(Vec<Option<bool>>),
    /// Empty where the value is missing.
    Labels(Vec<Arc<str>>),
}

impl Table {
    /// Everything that a reader still has. Stamps that jitter where the samples are even are made even.
    ///
    /// # Errors
    ///
    /// Those of the reader.
    pub fn read(reader: &mut dyn RecordingReader) -> Result<Self, RecordingError> {
        Self::read_with(reader, &[])
    }

    /// The same, and columns that are not known as numbers, of those of these names that are there.
    ///
    /// # Errors
    ///
    /// Those of the reader.
    pub fn read_with(reader: &mut dyn RecordingReader, others: &[String]) -> Result<Self, RecordingError> {
        let schema = reader.schema().clone();
        let sources = sources(&schema);
        let mut others = Others::of(&schema, others);
        let mut columns: Vec<TableColumn> = sources.iter().map(|(source, _)| source.column(&schema)).collect();
        let (mut usable, mut steps) = (Vec::new(), vec![None; schema.len()]);
        let mut row = RecordingRow::default();
        while reader.read_row(&mut row)? {
            usable.push(row.is_usable());
            others.push(reader, &row);
            for (column, (source, _)) in columns.iter_mut().zip(&sources) {
                source.push(&row, &mut column.values);
            }
            if row.is_usable() {
                reader.update_steps(&row, &mut steps);
            }
        }
        for (column, (_, position)) in columns.iter_mut().zip(&sources) {
            column.resolution = steps[*position].filter(|_| matches!(column.values, ColumnValues::Numbers(_)));
        }
        columns.extend(others.columns);
        let bad_rows = reader.bad_rows().cloned().unwrap_or_default();
        let mut table = Self { file: reader.file().into(), usable, columns, bad_rows };
        table.even_stamps();
        table.bad_rows.standing_still =
            table.numbers(Column::Time).map_or_else(Vec::new, |s| standing_still(s, |column| table.numbers(column)));
        Ok(table)
    }

    /// Stamps that jitter beside even samples become even.
    fn even_stamps(&mut self) {
        let Some(time_s) = self.numbers(Column::Time) else { return };
        let channels: Vec<&[f64]> = Column::FLUX.iter().filter_map(|axis| self.numbers(*axis)).collect();
        let Some(even_s) = stamps::evened(time_s, &channels) else { return };
        if let Some(time) = self.columns.iter_mut().find(|column| column.name == Column::Time.name()) {
            time.values = ColumnValues::Numbers(even_s);
        }
    }

    /// The file as the user named it.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The rows that were no good.
    pub fn bad_rows(&self) -> &BadRows {
        &self.bad_rows
    }

    /// How many rows.
    pub fn len(&self) -> usize {
        self.usable.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.usable.is_empty()
    }

    /// Whether each row may be used: see [`RecordingRow::is_usable`].
    pub fn usable(&self) -> &[bool] {
        &self.usable
    }

    /// The columns: the known ones in the order of [`Column`], then the loads in the order of the recording, then what was
    /// asked for beside them.
    pub fn columns(&self) -> &[TableColumn] {
        &self.columns
    }

    /// A known column, if it is there.
    pub fn column(&self, column: Column) -> Option<&TableColumn> {
        self.columns.iter().find(|there| there.name == column.name())
    }

    /// The values of a column of numbers, if it is there; NaN where one is missing.
    pub fn numbers(&self, column: Column) -> Option<&[f64]> {
        self.column(column).and_then(TableColumn::numbers)
    }

    /// The values of a column of numbers or flags by its name, if it is there; NaN where one is missing.
    pub fn numbers_named(&self, name: &str) -> Option<Vec<f64>> {
        match &self.columns.iter().find(|column| column.name == name)?.values {
            ColumnValues::Numbers(numbers) => Some(numbers.clone()),
            ColumnValues::Flags(flags) => {
                Some(flags.iter().map(|flag| flag.map_or(f64::NAN, |is_set| f64::from(u8::from(is_set)))).collect())
            }
            ColumnValues::Labels(_) => None,
        }
    }

    /// The smallest step with which a column of numbers is written, in its unit.
    pub fn resolution(&self, column: Column) -> Option<f64> {
        self.column(column)?.resolution
    }

    /// Name and current of each load, A; NaN where a value is missing.
    pub fn currents_a(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.columns.iter().filter_map(|column| Some((load_of(&column.name)?, column.numbers()?)))
    }
}

impl TableColumn {
    /// Its values, if they are numbers.
    pub fn numbers(&self) -> Option<&[f64]> {
        match &self.values {
            ColumnValues::Numbers(numbers) => Some(numbers),
            ColumnValues::Flags(_) | ColumnValues::Labels(_) => None,
        }
    }
}

/// Where in a row the values of a column come from.
#[derive(Clone, Copy)]
enum Source {
    Known(Column),
    /// The current of a load, by its place among them.
    Load(usize),
}

/// What the columns of a table are made from, and where each is in the recording.
fn sources(schema: &Schema) -> Vec<(Source, usize)> {
    let known = Column::all().filter_map(|column| Some((Source::Known(column), schema.position(column)?)));
    let loads = schema.loads().iter().enumerate().map(|(at, load)| (Source::Load(at), load.position));
    known.chain(loads).collect()
}

impl Source {
    fn column(self, schema: &Schema) -> TableColumn {
        let (name, unit, kind) = match self {
            Self::Known(column) => {
                let spec = column.spec();
                (spec.name.into(), spec.unit, spec.kind)
            }
            Self::Load(at) => (format!("current_{}_A", schema.loads()[at].load), LOAD_UNIT, ColumnKind::Number),
        };
        let values = match kind {
            ColumnKind::Number => ColumnValues::Numbers(Vec::new()),
            ColumnKind::Flag => ColumnValues::Flags(Vec::new()),
            ColumnKind::Label => ColumnValues::Labels(Vec::new()),
        };
        TableColumn { name, unit, values, resolution: None }
    }

    fn push(self, row: &RecordingRow, values: &mut ColumnValues) {
        match (self, values) {
            (Self::Known(column), ColumnValues::Numbers(numbers)) => {
                numbers.push(row.number(column).unwrap_or(f64::NAN));
            }
            (Self::Load(at), ColumnValues::Numbers(numbers)) => {
                numbers.push(row.currents_a.get(at).copied().flatten().unwrap_or(f64::NAN));
            }
            (Self::Known(column), ColumnValues::Flags(flags)) => flags.push(row.flag(column)),
            (_, ColumnValues::Labels(labels)) => labels.push(label(row, labels.last())),
            (Self::Load(_), ColumnValues::Flags(_)) => unreachable!("a current is a number"),
        }
    }
}

/// Columns that are not known, read as numbers.
struct Others {
    positions: Vec<usize>,
    columns: Vec<TableColumn>,
}

impl Others {
    fn of(schema: &Schema, names: &[String]) -> Self {
        let is_known = |name: &str| Column::named(name).is_some() || load_of(name).is_some();
        let mut found: Vec<(usize, String)> = Vec::new();
        for name in names.iter().filter(|name| !is_known(name)) {
            let place = schema.names().position(|there| there == name.as_bytes());
            found.extend(place.map(|place| (place, name.clone())));
        }
        let column = |(_, name): &(usize, String)| TableColumn {
            name: name.clone(),
            unit: "",
            values: ColumnValues::Numbers(Vec::new()),
            resolution: None,
        };
        Self { columns: found.iter().map(column).collect(), positions: found.iter().map(|(at, _)| *at).collect() }
    }

    fn push(&mut self, reader: &dyn RecordingReader, row: &RecordingRow) {
        if self.positions.is_empty() {
            return;
        }
        let mut numbers = Vec::with_capacity(self.positions.len());
        let mut take = |field: &[u8]| {
            let number = std::str::from_utf8(field).ok().and_then(|text| text.trim().parse::<f64>().ok());
            numbers.push(number.filter(|number| number.is_finite()).unwrap_or(f64::NAN));
            Ok(())
        };
        // It only fails where the sink does.
        let _ = reader.write_fields(row, &self.positions, &mut take);
        for (at, column) in self.columns.iter_mut().enumerate() {
            if let ColumnValues::Numbers(values) = &mut column.values {
                values.push(numbers.get(at).copied().unwrap_or(f64::NAN));
            }
        }
    }
}

/// Rows of a leg share their label.
fn label(row: &RecordingRow, before: Option<&Arc<str>>) -> Arc<str> {
    before.filter(|before| ***before == *row.line).cloned().unwrap_or_else(|| row.line.as_str().into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::CsvReader;

    const TEXT: &str = "note,time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,line,current_pump_A,scalar_valid,depth_m\n\
                        a,0.0,50000.25,20000.5,0,45000,leg1,0.5,1,3.10\n\
                        b,0.1,50000.125,20000.5,0,,leg1,,0,3.125\n\
                        c,,50000,20000.50,0,45000,turn1,1,,\n";

    fn table() -> Table {
        Table::read(&mut CsvReader::from_reader("rec.csv", TEXT.as_bytes()).unwrap()).unwrap()
    }

    #[test]
    fn columns_are_named_and_typed_and_have_a_unit() {
        let table = table();
        let names: Vec<_> = table.columns().iter().map(|column| (column.name.as_str(), column.unit)).collect();
        let flux = [("flux_x_nT", "nT"), ("flux_y_nT", "nT"), ("flux_z_nT", "nT")];
        assert_eq!(names[..2], [("time_s", "s"), ("scalar_nT", "nT")]);
        assert_eq!(names[2..5], flux);
        assert_eq!(names[5..], [("scalar_valid", ""), ("depth_m", "m"), ("line", ""), ("current_pump_A", "A")]);
        assert_eq!(
            table.column(Column::ScalarValid).unwrap().values,
            ColumnValues::Flags(vec![Some(true), Some(false), None])
        );
        let ColumnValues::Labels(lines) = &table.column(Column::Line).unwrap().values else { panic!() };
        assert_eq!(lines.iter().map(|line| &**line).collect::<Vec<_>>(), ["leg1", "leg1", "turn1"]);
        assert!(Arc::ptr_eq(&lines[0], &lines[1]));
    }

    #[test]
    fn missing_numbers_are_no_numbers() {
        let table = table();
        assert_eq!((table.file(), table.len(), table.usable()), ("rec.csv", 3, &[true, false, false][..]));
        assert!(table.numbers(Column::Time).unwrap()[2].is_nan() && table.numbers(Column::FluxZ).unwrap()[1].is_nan());
        assert_eq!(table.numbers(Column::Scalar).unwrap(), [50000.25, 50000.125, 50000.0]);
        let (load, current_a) = table.currents_a().next().unwrap();
        assert!((load, current_a[0], current_a[2]) == ("pump", 0.5, 1.0) && current_a[1].is_nan());
        assert_eq!(table.numbers(Column::Altitude), None);
    }

    #[test]
    fn other_columns_are_numbers_where_they_are_asked_for() {
        let text = TEXT.replace("a,0.0", " 7.5 ,0.0").replace("\nb,", "\n-1e-1,");
        let names = ["note", "depth_m", "absent"].map(String::from);
        let table = Table::read_with(&mut CsvReader::from_reader("rec.csv", text.as_bytes()).unwrap(), &names).unwrap();
        let note = table.numbers_named("note").unwrap();
        assert!(note[..2] == [7.5, -0.1] && note[2].is_nan());
        assert_eq!(table.numbers_named("scalar_valid").unwrap()[..2], [1.0, 0.0]);
        assert!(table.numbers_named("absent").is_none() && table.numbers_named("line").is_none());
        assert_eq!(table.columns().len(), 10);
    }

    #[test]
    fn the_resolution_is_that_of_the_usable_rows() {
        let table = table();
        let steps = [Column::Scalar, Column::FluxX, Column::FluxY, Column::Depth].map(|c| table.resolution(c).unwrap());
        assert_eq!(steps, [0.01, 0.1, 1.0, 0.01]);
        assert_eq!([Column::Line, Column::ScalarValid, Column::Heading].map(|c| table.resolution(c)), [None; 3]);
    }
}
