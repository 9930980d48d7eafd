//! What the log keeps of an epoch.

use crate::log::EpochRecord;
use crate::sensors::grid::{EpochMarks, FluxMark, ScalarMark};
use crate::{Epoch, Output};

/// Flags of [`EpochRecord::faults`].
pub mod fault {
    /// No scalar reading came.
    pub const SCALAR_MISSING: u32 = 1 << 0;
    /// The scalar reading is invalid.
    pub const SCALAR_INVALID: u32 = 1 << 1;
    /// The scalar reading came off its time.
    pub const SCALAR_OFF_TIME: u32 = 1 << 2;
    /// More than one scalar reading came.
    pub const SCALAR_DOUBLED: u32 = 1 << 3;
    /// The grid was moved to the scalar sensor's phase.
    pub const RELOCKED: u32 = 1 << 4;
    /// Fluxgate conversions are missing.
    pub const FLUX_MISSING: u32 = 1 << 5;
    /// The fluxgate's converter is at its full scale.
    pub const FLUX_CLIPPED: u32 = 1 << 6;
}

/// The fault flags of an epoch.
pub fn faults_of(marks: &EpochMarks) -> u32 {
    let scalar = match marks.scalar {
        ScalarMark::Present => 0,
        ScalarMark::Missing => fault::SCALAR_MISSING,
        ScalarMark::Invalid => fault::SCALAR_INVALID,
        ScalarMark::OffTime => fault::SCALAR_OFF_TIME,
    };
    let flux = match marks.flux {
        FluxMark::Present => 0,
        FluxMark::Missing => fault::FLUX_MISSING,
        FluxMark::Clipped => fault::FLUX_CLIPPED,
    };
    let flag = |is_set: bool, flag| if is_set { flag } else { 0 };
    scalar | flux | flag(marks.duplicates > 0, fault::SCALAR_DOUBLED) | flag(marks.relocked, fault::RELOCKED)
}

/// Makes the log's record of an epoch; keeps the fault flags, which are recorded when they change.
#[derive(Clone, Copy, Debug, Default)]
pub struct RecordBuilder {
    faults: u32,
}

impl RecordBuilder {
    /// The record of an epoch and what the core answered.
    pub fn record(&mut self, epoch: Epoch, marks: &EpochMarks, output: Output) -> EpochRecord {
        let faults = faults_of(marks);
        let changed = core::mem::replace(&mut self.faults, faults) != faults;
        EpochRecord { epoch, output, battery_a: marks.current_a, faults: changed.then_some(faults) }
    }
}
