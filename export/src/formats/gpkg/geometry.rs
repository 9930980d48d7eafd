//! Geometries as a GeoPackage stores them: its own header, section 2.1.3 of the specification, then well-known binary.

/// Little-endian, no envelope, not empty.
const FLAGS: u8 = 0b0000_0001;
const LITTLE_ENDIAN: u8 = 1;
const WKB_POINT: u32 = 1;
const WKB_LINE_STRING: u32 = 2;

/// A point.
pub(super) fn point(srs_id: i32, place: [f64; 2]) -> Vec<u8> {
    let mut bytes = header(srs_id, WKB_POINT);
    bytes.extend(place.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// A line through these places. SQLite takes no blob that would hold more of them than 32 bits count.
pub(super) fn line(srs_id: i32, places: &[[f64; 2]]) -> Vec<u8> {
    let mut bytes = header(srs_id, WKB_LINE_STRING);
    bytes.extend((places.len() as u32).to_le_bytes());
    bytes.extend(places.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

fn header(srs_id: i32, geometry: u32) -> Vec<u8> {
    let mut bytes = b"GP\0".to_vec();
    bytes.push(FLAGS);
    bytes.extend(srs_id.to_le_bytes());
    bytes.push(LITTLE_ENDIAN);
    bytes.extend(geometry.to_le_bytes());
    bytes
}
