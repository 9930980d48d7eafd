//! The replay boundary: all that the core may see at one tick, and all that it answers.

/// Epochs a second, Hz: the rate of the grid that both sensors are put on.
pub const RATE_HZ: f64 = 10.0;

/// Time from one epoch to the next, s.
pub const EPOCH_S: f64 = 1.0 / RATE_HZ;

/// The same in whole microseconds.
pub const EPOCH_US: u32 = (1e6 / RATE_HZ) as u32;

/// One tick of the grid of [`RATE_HZ`]: everything that [`Pipeline::step`](crate::Pipeline::step) may see.
///
/// Whoever has the same epochs in the same order gets the same outputs, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epoch {
    /// Position on the sampling grid. Consecutive epochs differ by one (wrapping); a larger step is a gap.
    pub tick: u32,
    /// Total field read by the scalar sensor, in picotesla, 1,000,000 to 100,000,000. `None` when it is missing or
    /// when the sensor itself flags it as invalid. An integer because one `f32` step at 50,000 nT is 0.004 nT.
    pub scalar_pt: Option<i32>,
    /// Fluxgate vector in body axes (x forward, y starboard, z down), in nanotesla. `None` when it is missing.
    pub flux_nt: Option<[f32; 3]>,
}

/// What the core answers to one [`Epoch`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// The epoch's own tick.
    pub tick: u32,
    /// What became of the epoch.
    pub status: Status,
    /// The compensated reading; `None` exactly when the epoch was rejected.
    pub compensated: Option<Compensated>,
}

/// What became of an epoch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Compensated and shown to the estimator.
    Used,
    /// Compensated, but kept from the estimator: the band-pass filter still carries the transient of its start.
    Settling,
    /// Neither compensated nor shown to the estimator.
    Rejected(Rejection),
}

/// Every status; its place is its code.
const STATUSES: [Status; 7] = [
    Status::Used,
    Status::Settling,
    Status::Rejected(Rejection::ScalarMissing),
    Status::Rejected(Rejection::ScalarOutOfRange),
    Status::Rejected(Rejection::FluxMissing),
    Status::Rejected(Rejection::FluxOutOfRange),
    Status::Rejected(Rejection::AfterGap),
];

impl Status {
    /// The byte that stands for it in records and on the cable: 0 used, 1 settling, 2 to 6 rejected, in the order of
    /// [`Rejection`].
    pub fn code(self) -> u8 {
        match self {
            Self::Used => 0,
            Self::Settling => 1,
            Self::Rejected(Rejection::ScalarMissing) => 2,
            Self::Rejected(Rejection::ScalarOutOfRange) => 3,
            Self::Rejected(Rejection::FluxMissing) => 4,
            Self::Rejected(Rejection::FluxOutOfRange) => 5,
            Self::Rejected(Rejection::AfterGap) => 6,
        }
    }

    /// The status that a [`code`](Self::code) stands for, if there is one.
    pub fn from_code(code: u8) -> Option<Self> {
        STATUSES.get(usize::from(code)).copied()
    }
}

/// Why an epoch was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rejection {
    /// The scalar reading is missing or flagged as invalid by the sensor.
    ScalarMissing,
    /// The scalar reading lies outside 1,000 to 100,000 nT.
    ScalarOutOfRange,
    /// The fluxgate reading is missing.
    FluxMissing,
    /// A fluxgate component is not finite, or the vector's magnitude lies outside 1,000 to 100,000 nT.
    FluxOutOfRange,
    /// The epoch before it is missing or was rejected, so that there is no derivative of the direction cosines.
    AfterGap,
}

/// The numbers of one compensated epoch. All come from coefficients that have not yet seen it, save the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensated {
    /// Interference that the model predicts for this epoch, nT: `A beta` of eq. (5) with the coefficients before this
    /// epoch. When coefficients change, it goes on from where it was: its changes are those of `A beta`, its level is
    /// that of the coefficients at the start.
    pub interference_nt: f32,
    /// Scalar reading less the interference, picotesla.
    pub compensated_pt: i32,
    /// Band-passed scalar reading, nT: what there was before compensation.
    pub band_passed_nt: f32,
    /// Band-passed scalar less the prediction, nT: strictly predictive.
    pub residual_nt: f32,
    /// The same with the coefficients after this epoch's update, nT. It has seen the answer: for comparison only.
    pub residual_after_update_nt: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_come_back() {
        for (code, status) in (0..).zip(STATUSES) {
            assert_eq!((status.code(), Status::from_code(code)), (code, Some(status)));
        }
        assert_eq!(Status::from_code(7), None);
    }
}
