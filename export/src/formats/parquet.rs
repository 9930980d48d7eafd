//! Apache Parquet: the columns as they are, missing values as nulls, units in the file's own metadata.

use std::sync::Arc;

use ::parquet::basic::{LogicalType, Repetition, Type as Physical};
use ::parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType};
use ::parquet::errors::Result;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use ::parquet::schema::types::Type;

use crate::error::ExportError;
use crate::table::{Table, TableColumn, Values};

/// In front of a column's name in the metadata, where its unit stands.
const UNIT: &str = "unit:";

/// Rows that a reader takes at once: some three hours at 10 Hz.
const ROWS_PER_GROUP: usize = 1 << 17;

/// The table as a file.
pub(crate) fn encode(table: &Table) -> std::result::Result<Vec<u8>, ExportError> {
    write(table).map_err(ExportError::encoding("parquet"))
}

fn write(table: &Table) -> Result<Vec<u8>> {
    let fields = table.columns.iter().map(|column| Ok(Arc::new(field(column)?))).collect::<Result<_>>()?;
    let schema = Type::group_type_builder("towmag").with_fields(fields).build()?;
    let properties = WriterProperties::builder().set_key_value_metadata(Some(metadata(table))).build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    for start in (0..table.len()).step_by(ROWS_PER_GROUP) {
        let end = table.len().min(start + ROWS_PER_GROUP);
        let mut group = writer.next_row_group()?;
        for column in &table.columns {
            if let Some(mut chunk) = group.next_column()? {
                write_column(&mut chunk, &column.values, start, end)?;
                chunk.close()?;
            }
        }
        group.close()?;
    }
    writer.into_inner()
}

fn field(column: &TableColumn) -> Result<Type> {
    let (physical, logical) = match column.values {
        Values::Number(_) => (Physical::DOUBLE, None),
        Values::Flag(_) => (Physical::BOOLEAN, None),
        Values::Label(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    Type::primitive_type_builder(&column.name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical)
        .build()
}

fn metadata(table: &Table) -> Vec<KeyValue> {
    let source = KeyValue::new("source".to_string(), table.file_name().to_string());
    let with_unit = table.columns.iter().filter(|column| !column.unit.is_empty());
    let units = with_unit.map(|column| KeyValue::new(format!("{UNIT}{}", column.name), column.unit.to_string()));
    std::iter::once(source).chain(units).collect()
}

fn write_column(chunk: &mut SerializedColumnWriter<'_>, values: &Values, start: usize, end: usize) -> Result<()> {
    match values {
        Values::Number(numbers) => {
            let known = |number: &f64| Some(*number).filter(|number| !number.is_nan());
            write_values::<DoubleType>(chunk, numbers[start..end].iter().map(known))
        }
        Values::Flag(flags) => write_values::<BoolType>(chunk, flags[start..end].iter().copied()),
        Values::Label(labels) => {
            let bytes = |label: &Option<String>| label.as_deref().map(ByteArray::from);
            write_values::<ByteArrayType>(chunk, labels[start..end].iter().map(bytes))
        }
    }
}

/// Those that are there, and a level for each row that says whether it has one.
fn write_values<T: DataType>(
    chunk: &mut SerializedColumnWriter<'_>,
    values: impl Iterator<Item = Option<T::T>> + Clone,
) -> Result<()> {
    let levels: Vec<i16> = values.clone().map(|value| value.is_some().into()).collect();
    let known: Vec<T::T> = values.flatten().collect();
    chunk.typed::<T>().write_batch(&known, Some(&levels), None)?;
    Ok(())
}
