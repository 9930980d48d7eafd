//! GeoJSON, RFC 7946: WGS 84, longitude first.

use geojson::{Feature, FeatureCollection, GeoJson, Geometry, JsonObject};
use serde_json::Value;

use super::digits::rounded;

/// Digits of a longitude: 1e-8 degrees are a millimetre, and no longitude has more than three digits before the point.
const PLACE_DIGITS: usize = 11;

/// A place, longitude first; `None` where it is not known.
pub(super) fn place(longitude_deg: f64, latitude_deg: f64) -> Option<[f64; 2]> {
    let place = [longitude_deg, latitude_deg];
    place.iter().all(|degrees| degrees.is_finite()).then(|| place.map(|degrees| rounded(degrees, PLACE_DIGITS)))
}

/// A feature with these properties; null where a number is none.
pub(super) fn feature(geometry: Option<Geometry>, properties: Vec<(&str, Value)>) -> Feature {
    let properties: JsonObject = properties.into_iter().map(|(name, value)| (name.to_string(), value)).collect();
    Feature { geometry, properties: Some(properties), ..Feature::default() }
}

/// The text of a file.
pub(super) fn text(features: Vec<Feature>) -> String {
    let mut text = GeoJson::from(FeatureCollection::new(features)).to_string();
    text.push('\n');
    text
}
