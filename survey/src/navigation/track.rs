//! The body's way.

/// The body's way, a value a row; NaN where it is not known.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// Local east, m.
    pub easting_m: Vec<f64>,
    /// Local north, m.
    pub northing_m: Vec<f64>,
    /// Way along the track since the first row, m; never falls.
    pub along_m: Vec<f64>,
    /// Speed over ground, smoothed, m/s.
    pub speed_m_per_s: Vec<f64>,
    /// Course over ground, smoothed, from the grid's north by east, degrees.
    pub course_deg: Vec<f64>,
    /// WGS 84, degrees.
    pub latitude_deg: Vec<f64>,
    /// WGS 84, degrees.
    pub longitude_deg: Vec<f64>,
}
