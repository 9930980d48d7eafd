//! What a simulation of the user's own adds to the base model of a recording, and how it was laid on it.

use towmag::model::TERMS;

/// What a simulation adds to the base model of a recording, one value a row, nT; empty where there is none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beyond {
    pub(crate) scalar_nt: Vec<f64>,
    /// To the magnitude of the fluxgate's vector.
    pub(crate) magnitude_nt: Vec<f64>,
    /// Its 18 coefficients, where they are held, in the units of eq. (4).
    pub(crate) held: Option<[f64; TERMS]>,
}

/// How a simulation was laid on a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationUsed {
    /// File as the user named it.
    pub file: String,
    /// Its clock less the recording's, s.
    pub offset_s: f64,
    /// Share of the changes of the recording's fluxgate that it explains.
    pub track_explained: f64,
    /// Its rows in a second.
    pub rate_hz: f64,
    /// Whether its 18 terms were held.
    pub holds_terms: bool,
    /// What it says beyond 18 terms and a slow background, nT rms; `None` where that is no more than its noise, and is left aside.
    pub beyond_nt: Option<f64>,
}
