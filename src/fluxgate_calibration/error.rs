//! Why a calibration of the fluxgate has no result, and what to do.

use crate::settings::SettingsError;

/// Why a calibration of the fluxgate has no result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FluxgateCalibrationError {
    /// There are too few usable epochs. It goes on.
    TooShort {
        /// How many there are.
        used_epochs: u32,
        /// How many it takes.
        needed_epochs: u32,
    },
    /// The body was not turned through enough directions. It goes on.
    NotCovered {
        /// What is known least: 0 to 2 the offset of x, y or z, 3 to 5 its scale, 6 to 8 the angle of xy, xz or yz.
        unknown: usize,
        /// How far it may be off, nT at the present field.
        error_nt: f64,
    },
    /// No axes fit the readings: the root mean square of what is left is too large, nT.
    Misfit(f64),
    /// What was found is nothing that the settings may be.
    OutOfRange(SettingsError),
    /// There is no solution.
    NotFinite,
}

/// What the body is to be turned to.
const AXES: [&str; 3] = ["x", "y", "z"];
const PAIRS: [&str; 3] = ["x and y", "x and z", "y and z"];

impl FluxgateCalibrationError {
    /// Whether the recording goes on, so that the operator can bring what is missing.
    pub fn goes_on(&self) -> bool {
        matches!(self, Self::TooShort { .. } | Self::NotCovered { .. })
    }
}

impl core::fmt::Display for FluxgateCalibrationError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooShort { used_epochs, needed_epochs } => write!(
                f,
                "only {used_epochs} usable epochs, {needed_epochs} are needed: turn on, slower than 17 deg/s, scalar valid"
            ),
            Self::NotCovered { unknown, error_nt } => {
                let (part, of) = (unknown / 3, unknown % 3);
                let name = if part == 2 { PAIRS.get(of) } else { AXES.get(of) }.unwrap_or(&"all axes");
                let way = if part == 2 { "half-way between them" } else { "along it" };
                write!(f, "sensor {name} may be {error_nt:.0} nT off: turn on, till the field was {way}, both ways")
            }
            Self::Misfit(rms_nt) => {
                write!(f, "{rms_nt:.1} nT rms are left: go away from iron, calibrate fluxgate, and turn slower")
            }
            Self::OutOfRange(error) => error.fmt(f),
            Self::NotFinite => f.write_str("no ellipsoid fits the readings: calibrate fluxgate, and turn on all axes"),
        }
    }
}

impl core::error::Error for FluxgateCalibrationError {}
