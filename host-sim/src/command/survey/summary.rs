//! `summary.json` of a survey.

use serde::Serialize;
use towmag_survey::{Survey, SurveyedTow};

use super::diagnosed::Diagnosed;
use super::tows::Read;
use crate::diagnosis::EffectOnScalar;
use crate::provenance::Provenance;
use crate::recording::{BadRows, EPOCH_S};

/// What a survey says of itself.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct SurveySummary {
    /// Format of the file.
    pub schema: u32,
    /// One entry a recording, in the order given.
    pub recordings: Vec<RecordingSummary>,
    /// Time that was surveyed: of valid rows, s.
    pub duration_s: f64,
    /// How many contacts there are.
    pub contacts: usize,
    /// False contacts an hour that the threshold allows.
    pub false_alarms_per_hour: f64,
    /// Of the anomaly in the band beside the contacts, nT.
    pub noise_floor_nT: f64,
    /// Median along the track of the smallest moment that is found with a probability of 0.9, A m2.
    pub smallest_moment_Am2: Option<f64>,
    /// The mean over all rows, in the units of eq. (4).
    pub coefficients: [f64; 18],
    /// Their standard deviations.
    pub coefficient_std: [f64; 18],
    /// The map; there where positions are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<GridSummary>,
    /// Rows of all recordings that were no good and were not used.
    #[serde(skip_serializing_if = "BadRows::is_empty")]
    pub bad_rows: BadRows,
    /// What the reader must know before trusting the figures, a sentence each; there when there is anything.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// What it was made by, and of.
    pub provenance: Provenance,
}

/// One recording of a survey.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct RecordingSummary {
    /// File name.
    pub recording: String,
    /// Its rows.
    pub rows: usize,
    /// Rows whose field is known.
    pub valid_rows: usize,
    /// Rows whose place is known.
    pub placed_rows: usize,
    /// Positions that were used.
    pub fixes: usize,
    /// Positions that were not used: zeros, not on Earth, far off their neighbours, or the same to the last digit for half a minute.
    pub dropped_fixes: usize,
    /// Its lines, named or found.
    pub lines: Vec<String>,
    /// What a diagnosis named in its scalar, and was taken off it; empty where nothing was named or looked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<EffectOnScalar>,
    /// What of its scalar no known effect causes, beyond the noise, nT rms; there where it is as loud as that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unexplained_nT: Option<f64>,
    /// What two scalar sensors tell together; there where all recordings have two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub second_scalar: Option<SecondScalarSummary>,
}

/// Noise of two scalar sensors, of what is quicker than 10 s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct SecondScalarSummary {
    /// Standard deviation of what both have, nT.
    pub common_nT: f64,
    /// Of what the first has of its own, nT.
    pub own_first_nT: f64,
    /// Of what the second has of its own, nT.
    pub own_second_nT: f64,
}

/// The grid of eastings and northings, and the map on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GridSummary {
    /// Code in the register of EPSG: a zone of UTM on WGS 84.
    pub epsg: u16,
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Cells from west to east.
    pub width: usize,
    /// Cells from south to north.
    pub height: usize,
    /// Usual distance between lines, m; `None` with fewer than two.
    pub line_distance_m: Option<f64>,
}

impl SurveySummary {
    pub(super) fn new(
        read: &Read,
        survey: &Survey,
        grid: Option<GridSummary>,
        warnings: Vec<String>,
        provenance: Provenance,
    ) -> Self {
        let valid = survey.tows.iter().flat_map(|tow| &tow.is_valid).filter(|is_valid| **is_valid).count();
        let several = read.tows.len() > 1;
        let named = read.tows.iter().zip(&read.bad_rows);
        let bad_rows = named.map(|(tow, bad)| if several { bad.of_file(&tow.name) } else { bad.clone() });
        Self {
            schema: 1,
            recordings: recordings(read, survey),
            duration_s: valid as f64 * EPOCH_S,
            contacts: survey.contacts.len(),
            false_alarms_per_hour: survey.false_alarms_per_hour,
            noise_floor_nT: survey.noise_floor_nt,
            smallest_moment_Am2: survey.smallest_moment_am2,
            coefficients: survey.coefficients,
            coefficient_std: survey.coefficient_std,
            grid,
            bad_rows: bad_rows.reduce(BadRows::and).unwrap_or_default(),
            warnings,
            provenance,
        }
    }
}

fn recordings(read: &Read, survey: &Survey) -> Vec<RecordingSummary> {
    let one = |(tow, diagnosed): (&SurveyedTow, &Diagnosed)| {
        let mut lines: Vec<String> = Vec::new();
        for line in tow.line.iter().filter(|line| !line.is_empty()) {
            if lines.iter().all(|known| **known != **line) {
                lines.push(line.to_string());
            }
        }
        RecordingSummary {
            recording: tow.name.clone(),
            rows: tow.time_s.len(),
            valid_rows: tow.is_valid.iter().filter(|is_valid| **is_valid).count(),
            placed_rows: tow.track.iter().flat_map(|track| &track.easting_m).filter(|east| east.is_finite()).count(),
            fixes: tow.fixes,
            dropped_fixes: tow.dropped_fixes,
            lines,
            effects: diagnosed.effects.clone(),
            unexplained_nT: diagnosed.unexplained_nt,
            second_scalar: tow.second.as_ref().map(|second| SecondScalarSummary {
                common_nT: second.common_nt,
                own_first_nT: second.own_nt[0],
                own_second_nT: second.own_nt[1],
            }),
        }
    };
    survey.tows.iter().zip(&read.diagnosed).map(one).collect()
}
