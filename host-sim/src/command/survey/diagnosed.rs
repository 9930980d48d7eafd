//! What a diagnosis said of a recording that is surveyed.

use crate::diagnosis::EffectOnScalar;

/// What was found in a recording.
#[derive(Clone, Debug, Default)]
pub(super) struct Diagnosed {
    /// What was named in its scalar and taken off it; empty where nothing was named or looked for.
    pub(super) effects: Vec<EffectOnScalar>,
    /// What of its scalar has no name, beyond the noise, nT rms; where it is as loud as that.
    pub(super) unexplained_nt: Option<f64>,
    /// Why there is no diagnosis although one was asked for.
    pub(super) refusal: Option<String>,
}
