//! GeoJSON, read as JSON.

use serde_json::{Value, json};
use towmag_export::{Format, Options, encode};

use super::{FLAGS, LABELS, cells, encoded, expected_number, sample};

fn features(bytes: &[u8]) -> Vec<Value> {
    let file: Value = serde_json::from_slice(bytes).unwrap();
    assert_eq!(file["type"], "FeatureCollection");
    file["features"].as_array().unwrap().clone()
}

#[test]
fn a_leg_is_a_feature() {
    let features = features(&encoded(Format::Geojson));
    assert!(features.iter().all(|feature| feature["type"] == "Feature"));
    let lines: Vec<&Value> = features.iter().map(|feature| &feature["properties"]["line"]).collect();
    assert_eq!(lines, [&json!("101"), &Value::Null, &json!("box 2"), &json!("102")]);
    // The first goes over the meridian, halfway between its second and third row.
    assert_eq!(features[0]["geometry"]["type"], "MultiLineString");
    let parts = features[0]["geometry"]["coordinates"].as_array().unwrap();
    assert_eq!(parts[0].as_array().unwrap()[..2], [json!([179.9998, -33.5]), json!([179.9999, -33.4])]);
    assert_eq!((&parts[0][2][0], &parts[1][0][0]), (&json!(180.0), &json!(-180.0)));
    assert!((parts[0][2][1].as_f64().unwrap() + 33.35).abs() < 1e-9, "{parts:?}");
    assert_eq!(parts[1][1], json!([-179.9999, -33.3]));
    assert_eq!(features[1]["geometry"], Value::Null);
    assert_eq!(
        features[2]["geometry"],
        json!({"type": "LineString", "coordinates": [[-179.9997, -33.1], [-179.9996, -33.0]]})
    );
    assert_eq!(features[3]["geometry"], json!({"type": "Point", "coordinates": [-179.9995, -32.9]}));
    assert_eq!(
        features[2]["properties"],
        json!({
            "line": "box 2", "start_time_s": 10.4, "end_time_s": 10.5,
            "start_utc_s": 1700000000.4, "end_utc_s": 1700000000.5, "n": 2
        })
    );
}

#[test]
fn points_have_all_columns() {
    let bytes = encode(&sample(), Format::Geojson, &Options { points: true, every_s: None }).unwrap();
    let features = features(&bytes);
    let is_row = |feature: &&Value| feature["properties"].get("time_s").is_some();
    let mut points = features.iter().filter(is_row);
    let (header, rows) = cells();
    let place = |row: &[String], name: &str| row[header.iter().position(|other| other == name).unwrap()].clone();
    for row in rows.iter().filter(|row| !place(row, "latitude_deg").is_empty()) {
        let point = points.next().unwrap();
        let at = |name: &str| expected_number(&place(row, name)).unwrap();
        assert_eq!(point["geometry"]["coordinates"], json!([at("longitude_deg"), at("latitude_deg")]));
        for (name, field) in header.iter().zip(row) {
            let expected = match name.as_str() {
                name if LABELS.contains(&name) => json!(Some(field).filter(|field| !field.is_empty())),
                name if FLAGS.contains(&name) => json!(expected_number(field).map(|flag| flag == 1.0)),
                _ => json!(expected_number(field)),
            };
            assert_eq!(point["properties"][name], expected, "{name}");
        }
    }
    assert_eq!(points.next(), None);
}

#[test]
fn fewer_points_keep_the_ends() {
    let times = |every_s: f64| -> Vec<f64> {
        let options = Options { points: true, every_s: Some(every_s) };
        let features = features(&encode(&sample(), Format::Geojson, &options).unwrap());
        features.iter().filter_map(|feature| feature["properties"]["time_s"].as_f64()).collect()
    };
    assert_eq!(times(0.2), [10.0, 10.2, 10.4, 10.5, 10.6]);
    assert_eq!(times(0.1), [10.0, 10.1, 10.2, 10.4, 10.5, 10.6]);
    assert_eq!(times(5.0), [10.0, 10.2, 10.4, 10.5, 10.6]);
}
