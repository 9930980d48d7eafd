//! What the adaptive method says of its own output.

/// How good the compensation of an epoch is, as known before the epoch is learnt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Predicted standard deviation of the band-passed residual, nT: noise, uncertainty of the coefficients, and how
    /// far the members of the bank disagree. Holds where there is no target. 0 before the first epoch.
    pub predicted_std_nt: f32,
    /// Share of the information behind the coefficients that is not the calibration's, 0 to 1.
    pub adapted: f32,
    /// Whether the coefficients follow the data, and why not.
    pub adaptation: Adaptation,
}

/// Whether the coefficients follow the data, and why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adaptation {
    /// They stand still: the band-pass filter still carries the transient of its start, or the epoch was rejected.
    Waiting,
    /// They follow.
    Learning,
    /// They hardly move: the innovation is too large for an error of the model. A target, or a spike.
    Surprised,
    /// They stand still: the body hardly turns, less is learnt than is forgotten.
    Resting,
    /// Predictions have failed for too long to be a target: a member of the bank has been reinitialised.
    Relearning,
}

impl Adaptation {
    /// Its name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Learning => "learning",
            Self::Waiting => "waiting",
            Self::Surprised => "surprised",
            Self::Resting => "resting",
            Self::Relearning => "relearning",
        }
    }
}

impl Quality {
    /// Before the first epoch.
    pub(super) const START: Self = Self { predicted_std_nt: 0.0, adapted: 0.0, adaptation: Adaptation::Waiting };
}
