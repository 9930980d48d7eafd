//! GeoJSON, RFC 7946: the track, a feature a leg, and perhaps a point a row.

use ::geojson::{Feature, FeatureCollection, GeoJson, Geometry, JsonObject};

use super::json;
use super::track::LegFacts;
use crate::error::ExportError;
use crate::legs::{Leg, legs};
use crate::position::Position;
use crate::table::Table;

mod antimeridian;
mod decimate;

pub use antimeridian::cut as cut_at_the_antimeridian;

/// The track of the table; with `points`, its rows as well.
pub(crate) fn encode(table: &Table, every_s: Option<f64>, points: bool) -> Result<Vec<u8>, ExportError> {
    let position = Position::wgs84(table)?;
    let mut features = Vec::new();
    for leg in legs(table) {
        let rows = decimate::rows(table, &leg.rows, &position, every_s)?;
        features.push(course(table, &leg, &position, &rows));
        if points {
            features.extend(rows.into_iter().filter_map(|row| point(table, &position, row)));
        }
    }
    let mut text = GeoJson::from(FeatureCollection::new(features)).to_string();
    text.push('\n');
    Ok(text.into_bytes())
}

/// A line string; the one position of a leg that has no other is a point, and a leg without any has no geometry.
fn course(table: &Table, leg: &Leg<'_>, position: &Position<'_>, rows: &[usize]) -> Feature {
    let places: Vec<[f64; 2]> = rows.iter().filter_map(|&row| position.at(row)).collect();
    let geometry = match places.as_slice() {
        [] => None,
        [place] => Some(Geometry::new_point(*place)),
        places => Some(match antimeridian::cut(places).as_slice() {
            [one] => Geometry::new_line_string(one.iter().copied()),
            parts => Geometry::new_multi_line_string(parts.iter().map(|part| part.iter().copied())),
        }),
    };
    feature(geometry, properties(&LegFacts::of(table, leg)))
}

fn properties(leg: &LegFacts<'_>) -> JsonObject {
    let mut properties = JsonObject::new();
    properties.insert("line".into(), leg.line.into());
    for (name, ends) in [("time_s", leg.time_s), ("utc_s", leg.utc_s)] {
        if let [Some(start), Some(end)] = ends {
            properties.insert(format!("start_{name}"), start.into());
            properties.insert(format!("end_{name}"), end.into());
        }
    }
    properties.insert("n".into(), leg.rows.into());
    properties
}

fn point(table: &Table, position: &Position<'_>, row: usize) -> Option<Feature> {
    let place = position.at(row)?;
    Some(feature(Some(Geometry::new_point(place)), json::row(table, row).collect()))
}

fn feature(geometry: Option<Geometry>, properties: JsonObject) -> Feature {
    Feature { geometry, properties: Some(properties), ..Feature::default() }
}
