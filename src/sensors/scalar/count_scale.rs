//! Counts of a sensor as a magnetic field.

use super::fields::Defect;
use crate::sensors::check;
use crate::settings::SettingsError;

/// Counts of a sensor to picotesla, in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CountScale {
    micro_counts_per_nt: u64,
}

impl CountScale {
    pub(super) fn new(counts_per_nt: f64) -> Result<Self, SettingsError> {
        check("counts_per_nt", counts_per_nt, 1.0..=1e6, "1 to 1000000")?;
        Ok(Self { micro_counts_per_nt: libm::round(counts_per_nt * 1e6) as u64 })
    }

    /// Rounded to the nearest picotesla. A count needs 29 bits: it never goes through `f32`.
    pub(super) fn to_pt(self, counts: u32) -> Result<i32, Defect> {
        // counts * 1000 pT/nT * 1e6 / micro_counts_per_nt; below 2^32 * 1e9 + 1e12 / 2 < 2^63.
        let scaled = u64::from(counts) * 1_000_000_000 + self.micro_counts_per_nt / 2;
        i32::try_from(scaled / self.micro_counts_per_nt).map_err(|_| Defect::BadNumber)
    }
}
