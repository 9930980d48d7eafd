//! How a sensor writes the field, and what that is in picotesla.

use super::fields::{Defect, Fields};
use crate::sensors::check;
use crate::settings::SettingsError;

/// How a sensor writes the field; computed once, when the settings are checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Nanotesla with exactly this many decimals, no point for none. A number with another count of decimals is
    /// refused, since it may have lost a digit.
    Decimals(u8),
    /// An integer count.
    Counts(CountScale),
}

impl Scale {
    /// Decimal nanotesla, 0 to 6 decimals.
    pub fn decimals(decimals: u8) -> Result<Self, SettingsError> {
        check("decimals", decimals.into(), 0.0..=6.0, "0 to 6")?;
        Ok(Self::Decimals(decimals))
    }

    /// Counts, 1 to 1,000,000 of them to a nanotesla.
    pub fn counts(counts_per_nt: f64) -> Result<Self, SettingsError> {
        Ok(Self::Counts(CountScale::new(counts_per_nt)?))
    }

    /// The field as a number of this scale, rounded to the nearest picotesla.
    pub fn read(self, fields: &mut Fields<'_>) -> Result<i32, Defect> {
        match self {
            Self::Decimals(decimals) => decimal_pt(fields, decimals),
            Self::Counts(scale) => scale.to_pt(fields.number()?),
        }
    }

    /// What neighbouring numbers differ by, picotesla.
    #[cfg(not(target_os = "none"))]
    pub fn resolution_pt(self) -> f64 {
        match self {
            Self::Decimals(decimals) => libm::pow(10.0, 3.0 - f64::from(decimals)),
            Self::Counts(scale) => 1e9 / scale.micro_counts_per_nt as f64,
        }
    }

    /// A field of 0 pT or more as a number of this scale, as the sensor would write it.
    #[cfg(not(target_os = "none"))]
    pub fn write(self, scalar_pt: i32, out: &mut dyn core::fmt::Write) -> core::fmt::Result {
        let micro_nt = u128::from(scalar_pt.unsigned_abs()) * 1_000;
        match self {
            Self::Decimals(decimals) => {
                let [unit_micro_nt, units_per_nt] =
                    [6_u32.saturating_sub(decimals.into()), decimals.into()].map(|n| 10_u128.pow(n));
                let units = (micro_nt + unit_micro_nt / 2) / unit_micro_nt;
                let (nt, fraction) = (units / units_per_nt, units % units_per_nt);
                match decimals {
                    0 => write!(out, "{nt}"),
                    _ => write!(out, "{nt}.{fraction:0width$}", width = usize::from(decimals)),
                }
            }
            Self::Counts(scale) => {
                let micro_counts = micro_nt * u128::from(scale.micro_counts_per_nt) / 1_000_000;
                write!(out, "{}", (micro_counts + 500_000) / 1_000_000)
            }
        }
    }
}

/// Counts of a sensor to picotesla, in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CountScale {
    micro_counts_per_nt: u64,
}

impl CountScale {
    fn new(counts_per_nt: f64) -> Result<Self, SettingsError> {
        check("counts_per_nt", counts_per_nt, 1.0..=1e6, "1 to 1000000")?;
        Ok(Self { micro_counts_per_nt: libm::round(counts_per_nt * 1e6) as u64 })
    }

    /// Rounded to the nearest picotesla. A count needs 29 bits: it never goes through `f32`.
    fn to_pt(self, counts: u32) -> Result<i32, Defect> {
        // counts * 1000 pT/nT * 1e6 / micro_counts_per_nt; below 2^32 * 1e9 + 1e12 / 2 < 2^63.
        let scaled = u64::from(counts) * 1_000_000_000 + self.micro_counts_per_nt / 2;
        let pt = scaled.checked_div(self.micro_counts_per_nt).and_then(|pt| i32::try_from(pt).ok());
        pt.ok_or(Defect::BadNumber)
    }
}

/// Decimal nanotesla, rounded to the nearest picotesla.
fn decimal_pt(fields: &mut Fields<'_>, decimals: u8) -> Result<i32, Defect> {
    let nt = fields.number()?;
    let fraction = if decimals == 0 {
        0
    } else {
        fields.expect(b'.')?;
        fields.digits(decimals)?
    };
    // In 1e-6 nT: below 2^32 * 1e6 + 1e6 < 2^63.
    let micro_nt =
        i64::from(nt) * 1_000_000 + i64::from(fraction) * 10_i64.pow(u32::from(6_u8.saturating_sub(decimals)));
    i32::try_from((micro_nt + 500) / 1_000).map_err(|_| Defect::BadNumber)
}
