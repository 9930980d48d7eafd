//! MCAP with JSON messages and JSON Schemas: <https://mcap.dev/spec/registry>.
//!
//! PlotJuggler and Foxglove open it without a plugin. Missing values are left out of a message: its schema
//! says number, and null is none.

use std::collections::BTreeMap;
use std::io::Cursor;

use ::mcap::records::MessageHeader;
use ::mcap::{McapResult, WriteOptions, Writer};
use serde_json::{Map, Value, json};

use super::json;
use crate::error::ExportError;
use crate::position::Position;
use crate::table::{Table, Values};

mod location;
mod times;

type McapFile = Writer<Cursor<Vec<u8>>>;

/// The table as a file.
pub(crate) fn encode(table: &Table) -> Result<Vec<u8>, ExportError> {
    let position = Position::on_earth(table)?;
    let times_ns = times::log_times_ns(table)?;
    write(table, position, &times_ns).map_err(ExportError::encoding("mcap"))
}

fn write(table: &Table, position: Option<Position<'_>>, times_ns: &[Option<u64>]) -> McapResult<Vec<u8>> {
    let options = WriteOptions::new().library(concat!("towmag-export ", env!("CARGO_PKG_VERSION")));
    let mut writer = options.create(Cursor::new(Vec::new()))?;
    let magnetometer = channel(&mut writer, "/magnetometer", "towmag.Magnetometer", &schema(table))?;
    let location = match position {
        Some(_) => Some(channel(&mut writer, "/location", location::SCHEMA, &location::schema())?),
        None => None,
    };
    for (row, time_ns) in times_ns.iter().enumerate() {
        let Some(time_ns) = *time_ns else { continue };
        write_message(&mut writer, magnetometer, row, time_ns, &message(table, row))?;
        let fix = position.and_then(|position| location::message(table, &position, row, time_ns));
        if let Some((channel, fix)) = location.zip(fix) {
            write_message(&mut writer, channel, row, time_ns, &fix)?;
        }
    }
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}

fn channel(writer: &mut McapFile, topic: &str, name: &str, schema: &Value) -> McapResult<u16> {
    let schema = writer.add_schema(name, "jsonschema", schema.to_string().as_bytes())?;
    writer.add_channel(schema, topic, "json", &BTreeMap::new())
}

fn write_message(writer: &mut McapFile, channel_id: u16, row: usize, time_ns: u64, message: &Value) -> McapResult<()> {
    // The sequence is the row, whose number wraps after thirteen years.
    let sequence = row as u32;
    let header = MessageHeader { channel_id, sequence, log_time: time_ns, publish_time: time_ns };
    writer.write_to_known_channel(&header, message.to_string().as_bytes())
}

fn schema(table: &Table) -> Value {
    let property = |values: &Values, unit: &str| match values {
        Values::Number(_) if unit.is_empty() => json!({"type": "number"}),
        Values::Number(_) => json!({"type": "number", "description": unit}),
        Values::Flag(_) => json!({"type": "boolean"}),
        Values::Label(_) => json!({"type": "string"}),
    };
    let properties: Map<String, Value> =
        table.columns.iter().map(|column| (column.name.clone(), property(&column.values, column.unit))).collect();
    json!({"title": "towmag.Magnetometer", "type": "object", "properties": properties})
}

fn message(table: &Table, row: usize) -> Value {
    Value::Object(json::row(table, row).filter(|(_, value)| !value.is_null()).collect())
}
