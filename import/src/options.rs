//! What a person asks of an import.

use crate::profile::Profile;

/// What a person asks of an import; all of it may be left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Of an earlier import, or made by hand.
    pub profile: Profile,
    /// The column of the scalar sensor.
    pub scalar: Option<String>,
    /// What the names of the fluxgate's columns have in common, or its three names with commas.
    pub flux: Option<String>,
    /// The unit of both magnetic sensors.
    pub units: Option<String>,
    /// What the fluxgate's readings are multiplied by, to nT.
    pub flux_factor: Option<f64>,
    /// Columns of the recording and what they come from.
    pub map: Vec<(String, String)>,
}
