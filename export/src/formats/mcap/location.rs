//! Where the body was, as Foxglove's map draws it: <https://docs.foxglove.dev/docs/sdk/schemas/location-fix>.

use serde_json::{Value, json};
use towmag_recording::Column;

use crate::position::Position;
use crate::table::Table;

/// Its name, which the map looks for.
pub(super) const SCHEMA: &str = "foxglove.LocationFix";

/// It is not known how good the position is.
const COVARIANCE_UNKNOWN: u8 = 0;

/// Which is written as zeros.
const COVARIANCE_M2: [f64; 9] = [0.0; 9];

const NS_PER_S: u64 = 1_000_000_000;

/// What a fix has.
pub(super) fn schema() -> Value {
    let number = |unit: &str| json!({"type": "number", "description": unit});
    json!({
        "title": SCHEMA,
        "type": "object",
        "properties": {
            "timestamp": {
                "type": "object",
                "title": "time",
                "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}
            },
            "frame_id": {"type": "string"},
            "latitude": number("deg"),
            "longitude": number("deg"),
            "altitude": number("m"),
            "position_covariance": {"type": "array", "items": {"type": "number"}, "minItems": 9, "maxItems": 9},
            "position_covariance_type": {"type": "integer"}
        },
        "required": [
            "timestamp", "frame_id", "latitude", "longitude", "altitude", "position_covariance",
            "position_covariance_type"
        ]
    })
}

/// A fix; the altitude is the depth turned round, or that of the surface.
pub(super) fn message(table: &Table, position: &Position<'_>, row: usize, time_ns: u64) -> Option<Value> {
    let [longitude, latitude] = position.at(row)?;
    let depth_m = table.numbers(Column::Depth.name()).map(|depth_m| depth_m[row]).filter(|depth_m| !depth_m.is_nan());
    Some(json!({
        "timestamp": {"sec": time_ns / NS_PER_S, "nsec": time_ns % NS_PER_S},
        "frame_id": "body",
        "latitude": latitude,
        "longitude": longitude,
        "altitude": 0.0 - depth_m.unwrap_or(0.0),
        "position_covariance": COVARIANCE_M2,
        "position_covariance_type": COVARIANCE_UNKNOWN,
    }))
}
