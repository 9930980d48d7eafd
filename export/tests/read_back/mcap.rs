//! MCAP, read by its crate; `readers.py` reads it by another one.

use ::mcap::{MessageStream, Summary};
use serde_json::{Value, json};
use towmag_export::{Format, Options, encode, read_from};

use super::{FLAGS, LABELS, cells, encoded, expected_number};

/// Topic, time in nanoseconds, and the message.
fn messages(bytes: &[u8]) -> Vec<(String, u64, Value)> {
    let message = |message: ::mcap::Message<'_>| {
        assert_eq!(message.channel.message_encoding, "json");
        assert_eq!(message.channel.schema.as_ref().unwrap().encoding, "jsonschema");
        (message.channel.topic.clone(), message.log_time, serde_json::from_slice(&message.data).unwrap())
    };
    MessageStream::new(bytes).unwrap().map(Result::unwrap).map(message).collect()
}

#[test]
fn a_row_is_a_message() {
    let bytes = encoded(Format::Mcap);
    let (header, rows) = cells();
    let found = messages(&bytes);
    let magnetometer: Vec<_> = found.iter().filter(|(topic, ..)| topic == "/magnetometer").collect();
    assert_eq!(magnetometer.len(), rows.len());
    for (number, ((_, time_ns, message), row)) in magnetometer.iter().zip(&rows).enumerate() {
        // UTC, also in the third row, which has none of its own.
        assert_eq!(*time_ns, 1_700_000_000_000_000_000 + 100_000_000 * number as u64);
        for (name, field) in header.iter().zip(row) {
            let expected = match name.as_str() {
                _ if field.is_empty() || field == "rubbish" => None,
                name if LABELS.contains(&name) => Some(json!(field)),
                name if FLAGS.contains(&name) => Some(json!(field == "1")),
                _ => expected_number(field).map(|number| json!(number)),
            };
            assert_eq!(message.get(name), expected.as_ref(), "{name}");
        }
    }
}

#[test]
fn the_body_is_on_the_map() {
    let found = messages(&encoded(Format::Mcap));
    let fixes: Vec<&Value> = found.iter().filter(|(topic, ..)| topic == "/location").map(|(.., fix)| fix).collect();
    assert_eq!(fixes.len(), 6);
    let unknown = [0.0; 9];
    assert_eq!(
        *fixes[0],
        json!({
            "timestamp": {"sec": 1_700_000_000_u64, "nsec": 0}, "frame_id": "body", "latitude": -33.5,
            "longitude": 179.9998, "altitude": -12.5, "position_covariance": unknown, "position_covariance_type": 0
        })
    );
    assert_eq!((&fixes[2]["altitude"], &fixes[5]["longitude"]), (&json!(0.0), &json!(-179.9995)));
}

#[test]
fn the_summary_counts_and_describes() {
    let bytes = encoded(Format::Mcap);
    let summary = Summary::read(&bytes).unwrap().unwrap();
    let stats = summary.stats.unwrap();
    assert_eq!((stats.message_count, stats.channel_count, stats.schema_count), (13, 2, 2));
    assert_eq!(stats.message_end_time - stats.message_start_time, 600_000_000);
    assert_eq!(summary.chunk_indexes.len(), 1);
    let schema = |name: &str| -> Value {
        let schema = summary.schemas.values().find(|schema| schema.name == name).unwrap();
        serde_json::from_slice(&schema.data).unwrap()
    };
    let magnetometer = schema("towmag.Magnetometer");
    assert_eq!(magnetometer["properties"]["scalar_nT"], json!({"type": "number", "description": "nT"}));
    assert_eq!(magnetometer["properties"]["note"], json!({"type": "string"}));
    assert_eq!(schema("foxglove.LocationFix")["required"].as_array().unwrap().len(), 7);
}

#[test]
fn without_position_there_is_no_location() {
    let table = read_from("t.csv", b"time_s,a\n5.0,1\n5.1,2\n".as_slice()).unwrap();
    let found = messages(&encode(&table, Format::Mcap, &Options::default()).unwrap());
    let expected = [(0, json!({"time_s": 5.0, "a": 1.0})), (100_000_000, json!({"time_s": 5.1, "a": 2.0}))];
    assert_eq!(found, expected.map(|(time_ns, message)| ("/magnetometer".to_string(), time_ns, message)));
}
