//! `coefficients.toml`: what `calibrate` writes and the other commands start from.

use std::path::Path;

use crate::message::number;
use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};
use towmag::estimate::{CalibrationResult, Information, LEVEL_COLUMNS, Prior};
use towmag::model::{Coefficients, TERM_NAMES, TERM_UNITS, TERMS};

/// The format that this program writes and reads.
const SCHEMA: u32 = 1;

/// A whole coefficients file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoefficientsFile {
    /// Format of the file.
    pub schema: u32,
    /// Where the coefficients come from. Not used again; for the reader.
    pub calibration: Origin,
    /// The 18 terms in the order of eq. (4).
    #[serde(rename = "term")]
    pub terms: Vec<CoefficientEntry>,
    /// How well the calibration knew them. Absent in files of earlier programs, which are read all the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub information: Option<StoredInformation>,
    /// What it has learnt of the level, likewise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<StoredInformation>,
}

/// [`Information`], as the core has it: in its basis, in nT. For the adaptive method alone, not for a person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct StoredInformation {
    /// Of the level, the columns that it is in: [`LEVEL_COLUMNS`]. Absent in what earlier programs wrote, whose level is left aside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub columns: Option<u32>,
    /// Root mean square of what the least-squares solution leaves of the band-passed scalar, nT.
    pub noise_nT: f32,
    /// The least-squares solution, 18 numbers.
    pub solution: Vec<f32>,
    /// Upper triangle of the square root of the information, row by row from the diagonal on, 171 numbers.
    pub triangle: Vec<f32>,
}

impl From<&Information> for StoredInformation {
    fn from(information: &Information) -> Self {
        Self {
            columns: None,
            noise_nT: information.noise_nt(),
            solution: information.centre().basis().as_slice().to_vec(),
            triangle: information.triangle().to_vec(),
        }
    }
}

impl StoredInformation {
    /// For the core; `None` when it is not complete or not finite.
    fn information(&self) -> Option<Information> {
        let solution: [f32; TERMS] = self.solution.as_slice().try_into().ok()?;
        let solution = Coefficients::from_basis(solution)?;
        Information::new(solution, self.triangle.as_slice().try_into().ok()?, self.noise_nT)
    }
}

/// How a calibration came about and how good it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct Origin {
    /// File name of the recording.
    pub recording: String,
    /// Rows that the coefficients were fitted to.
    pub used_rows: u64,
    /// Band-passed standard deviation of the scalar over them, nT.
    pub std_before_nT: f64,
    /// What the fit leaves of it, nT.
    pub std_after_nT: f64,
    /// The one over the other.
    pub improvement_ratio: f64,
    /// Of the band-passed terms, induced and eddy ones per 50,000 nT.
    pub condition_number: f64,
    /// Penalty on magnitudes, eq. (7).
    pub lambda1: f64,
    /// Penalty on squares, eq. (7).
    pub lambda2: f64,
    /// Lower edge of the band-pass, Hz.
    pub band_low_hz: f64,
    /// Upper edge of the band-pass, Hz.
    pub band_high_hz: f64,
}

/// One term of eq. (4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoefficientEntry {
    /// Name of the term.
    pub name: String,
    /// Its coefficient.
    pub value: f64,
    /// Standard deviation of the coefficient.
    pub std: f64,
    /// Unit of both: nT, nT/nT or s.
    pub unit: String,
}

/// Why a coefficients file is of no use.
#[derive(Debug, thiserror::Error)]
pub enum CoefficientsError {
    /// It cannot be read.
    #[error("{file}: cannot be read: {source}")]
    Io {
        /// The file as the user named it.
        file: String,
        /// The system's own words.
        source: std::io::Error,
    },
    /// It is not such a file.
    #[error("{file}: {what}")]
    Bad {
        /// The file as the user named it.
        file: String,
        /// What is wrong, on one line.
        what: String,
    },
}

impl CoefficientsFile {
    /// From coefficients and their standard deviations, both in the units of eq. (4).
    pub fn new(calibration: Origin, coefficients: &[f64; TERMS], std: &[f64; TERMS]) -> Self {
        let terms = (0..TERMS).map(|i| CoefficientEntry {
            name: TERM_NAMES[i].into(),
            value: coefficients[i],
            std: std[i],
            unit: TERM_UNITS[i].into(),
        });
        Self { schema: SCHEMA, calibration, terms: terms.collect(), information: None, level: None }
    }

    /// The same with the information behind the coefficients.
    pub fn with_information_of(self, result: &CalibrationResult) -> Self {
        let Prior { information, level, .. } = result.prior();
        let level = level
            .as_ref()
            .map(|level| StoredInformation { columns: Some(LEVEL_COLUMNS), ..StoredInformation::from(level) });
        Self { information: information.as_ref().map(Into::into), level, ..self }
    }

    /// Read and check a file.
    pub fn read(path: &Path) -> Result<Self, CoefficientsError> {
        let file = path.display().to_string();
        let text =
            std::fs::read_to_string(path).map_err(|source| CoefficientsError::Io { file: file.clone(), source })?;
        Self::parse(&text).map_err(|what| CoefficientsError::Bad { file, what })
    }

    fn parse(text: &str) -> Result<Self, String> {
        let parsed: Self = toml::from_str(text).map_err(|error| one_line(text, &error))?;
        if parsed.schema != SCHEMA {
            return Err(format!("schema is {}, this program reads {SCHEMA}", parsed.schema));
        }
        if parsed.terms.len() != TERMS {
            return Err(format!("has {} terms, {TERMS} are needed", parsed.terms.len()));
        }
        for (term, (name, unit)) in parsed.terms.iter().zip(TERM_NAMES.into_iter().zip(TERM_UNITS)) {
            if term.name != name || term.unit != unit {
                return Err(format!("has \"{}\" in {} where \"{name}\" in {unit} is expected", term.name, term.unit));
            }
            if !(term.std >= 0.0 && (term.value as f32).is_finite()) {
                let (value, std) = (number(term.value), number(term.std));
                return Err(format!("{name}: value {value} with std {std} is no coefficient"));
            }
        }
        parsed.coefficients().ok_or("holds coefficients that are too large")?;
        for (name, stored) in [("information", &parsed.information), ("level", &parsed.level)] {
            if stored.as_ref().is_some_and(|stored| stored.information().is_none()) {
                let needed =
                    "18 finite numbers, 171 with a diagonal of zero or more, and a noise above zero are needed";
                return Err(format!("{name}: {needed}"));
            }
        }
        Ok(parsed)
    }

    /// As TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("numbers and strings are always TOML")
    }

    /// The values for the core; `None` when one of them is not finite in its units.
    pub fn coefficients(&self) -> Option<Coefficients> {
        Coefficients::from_paper_units(std::array::from_fn(|i| self.terms[i].value))
    }

    /// The values with the information behind them, for the core.
    pub fn prior(&self) -> Option<Prior> {
        let level = self.level.as_ref().filter(|level| level.columns == Some(LEVEL_COLUMNS));
        let [information, level] =
            [self.information.as_ref(), level].map(|stored| stored.and_then(StoredInformation::information));
        Some(Prior { coefficients: self.coefficients()?, information, level })
    }

    /// The values, in the units of eq. (4): the least-squares ones where the information behind them is there, else those of the
    /// elastic net.
    pub fn values(&self) -> [f64; TERMS] {
        let information = self.information.as_ref().and_then(StoredInformation::information);
        information
            .map_or_else(|| std::array::from_fn(|i| self.terms[i].value), |known| known.centre().to_paper_units())
    }

    /// Covariance of [`CoefficientsFile::values`], in the units of eq. (4).
    pub fn covariance(&self) -> [[f64; TERMS]; TERMS] {
        let diagonal = |i: usize, k: usize| if i == k { self.terms[i].std.powi(2) } else { 0.0 };
        let alone = || std::array::from_fn(|i| std::array::from_fn(|k| diagonal(i, k)));
        self.information.as_ref().and_then(covariance_of).unwrap_or_else(alone)
    }

    /// The standard deviations, in the units of eq. (4).
    pub fn std(&self) -> [f64; TERMS] {
        std::array::from_fn(|i| self.terms[i].std)
    }
}

/// What is not determined at all is known to this, nT: no body is further from zero.
const FREE_STD_NT: f64 = 1e4;

/// The inverse of the stored information, from the core's basis to the units of eq. (4).
fn covariance_of(stored: &StoredInformation) -> Option<[[f64; TERMS]; TERMS]> {
    let mut numbers = stored.triangle.iter();
    let mut root = SMatrix::<f64, TERMS, TERMS>::zeros();
    for row in 0..TERMS {
        for column in row..TERMS {
            root[(row, column)] = f64::from(*numbers.next()?);
        }
    }
    let noise_nt = f64::from(stored.noise_nT);
    let free = SMatrix::identity() / FREE_STD_NT.powi(2);
    let covariance = (root.transpose() * root / (noise_nt * noise_nt) + free).try_inverse()?;
    let mut to_paper = SMatrix::<f64, TERMS, TERMS>::zeros();
    for k in 0..TERMS {
        let unit = Coefficients::from_basis(std::array::from_fn::<f32, TERMS, _>(|i| f32::from(u8::from(i == k))))?;
        to_paper.column_mut(k).copy_from_slice(&unit.to_paper_units());
    }
    let paper = to_paper * covariance * to_paper.transpose();
    Some(std::array::from_fn(|i| std::array::from_fn(|k| paper[(i, k)])))
}

fn one_line(text: &str, error: &toml::de::Error) -> String {
    let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].lines().count().max(1));
    format!("line {line}: {}", error.message().replace('\n', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> CoefficientsFile {
        let calibration = Origin {
            recording: "cal.csv".into(),
            used_rows: 3000,
            std_before_nT: 12.0,
            std_after_nT: 0.5,
            improvement_ratio: 24.0,
            condition_number: 4000.0,
            lambda1: 0.001,
            lambda2: 0.025,
            band_low_hz: 0.1,
            band_high_hz: 0.9,
        };
        let stored = StoredInformation {
            columns: None,
            noise_nT: 0.3,
            solution: (0..18).map(|i| 0.1 * i as f32 - 0.7).collect(),
            triangle: (0..171).map(|i| 1.0 / (3.0 + i as f32)).collect(),
        };
        let file = CoefficientsFile::new(calibration, &std::array::from_fn(|i| 0.1 * i as f64 - 0.33), &[1e-3; TERMS]);
        let level = StoredInformation { columns: Some(LEVEL_COLUMNS), ..stored.clone() };
        CoefficientsFile { information: Some(stored), level: Some(level), ..file }
    }

    #[test]
    fn what_is_written_is_read() {
        let read = CoefficientsFile::parse(&file().to_toml()).unwrap();
        assert_eq!(read, file());
        assert!(read.prior().unwrap().information.is_some());
        let without = CoefficientsFile { information: None, level: None, ..file() };
        assert_eq!(CoefficientsFile::parse(&without.to_toml()), Ok(without));
    }

    #[test]
    fn a_level_in_other_columns_is_left_aside() {
        let level = |text: &str| CoefficientsFile::parse(text).unwrap().prior().unwrap().level;
        let text = file().to_toml();
        assert!(level(&text).is_some());
        assert!(level(&text.replace("columns = 2\n", "")).is_none());
        assert!(level(&text.replace("columns = 2", "columns = 1")).is_none());
    }

    #[test]
    fn what_is_wrong_is_said() {
        let text = file().to_toml();
        let wrong = |from: &str, to: &str| CoefficientsFile::parse(&text.replacen(from, to, 1)).unwrap_err();
        assert_eq!(wrong("schema = 1", "schema = 2"), "schema is 2, this program reads 1");
        assert!(wrong("value = -0.33", "value = nan").starts_with("permanent x: value NaN"));
        assert!(wrong("value = -0.33", "value = 1e300").starts_with("permanent x: value 1e300"));
        assert!(wrong("permanent y", "permanent q").contains("\"permanent y\" in nT is expected"));
        assert!(wrong("value = -0.33", "value = \"x\"").starts_with("line "));
        assert!(wrong("noise_nT = 0.3", "noise_nT = 0.0").starts_with("information: "));
        assert!(wrong("triangle = [", "triangle = [1.0, ").starts_with("information: "));
        assert!(CoefficientsFile::parse("").unwrap_err().starts_with("line 1: "));
    }
}
