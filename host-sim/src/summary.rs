//! `summary.json`, as scripts rely on it.

use serde::Serialize;
use towmag::model::TERMS;

use crate::collect::{FigureOfMerit, SECTORS, SectorStd};
use crate::provenance::Provenance;
use crate::recording::{BadRows, SessionGap};
use crate::run::{AdaptationSummary, Coefficient, Counts, MethodResult, SETTLED_S, Settled};

/// The figures of one method on one recording. Standard deviations are of the band-passed scalar over the used rows.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct Summary {
    /// Format of the file.
    pub schema: u32,
    /// Name of the method.
    pub method: String,
    /// Rows in the recording.
    pub rows: u64,
    /// Rows behind the figures.
    pub used_rows: u64,
    /// Before compensation, nT.
    pub std_before_nT: f64,
    /// After compensation with coefficients that have not yet seen the epoch, nT.
    pub std_after_nT: f64,
    /// The one over the other.
    pub improvement_ratio: f64,
    /// After compensation with coefficients that have seen the epoch, nT.
    pub std_after_update_nT: f64,
    /// Coefficients at the end, in the units of eq. (4).
    pub coefficients: [f64; TERMS],
    /// Their standard deviations.
    pub coefficient_std: [f64; TERMS],
    /// What the adaptive method said of itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adaptation: Option<AdaptationSummary>,
    /// The figures from the third minute on; there in a recording that is longer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settled: Option<SettledSummary>,
    /// Median of the residual's standard deviation in windows of 10 s, nT.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_floor_nT: Option<f64>,
    /// Standard deviation of the fourth differences of the compensated reading over the root of 70, nT.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fourth_difference_nT: Option<f64>,
    /// Sums of peak to peak over the manoeuvres and headings that could be told; there where any could.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub figure_of_merit: Option<MeritSummary>,
    /// Before and after by heading, of the sectors that were sailed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub headings: Vec<HeadingSummary>,
    /// Largest over smallest singular value of the calibration's band-passed terms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub condition_number: Option<f64>,
    /// Rows that were no good and were not used; there when there are any.
    #[serde(skip_serializing_if = "BadRows::is_empty")]
    pub bad_rows: BadRows,
    /// What the reader must know before trusting the figures, a sentence each; there when there is anything.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// What lies between the sessions of a log, in their order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub session_gaps: Vec<SessionGap>,
    /// What it was made by, and of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
}

impl Summary {
    /// Of what a method made of a recording.
    pub fn new(result: &MethodResult, counts: &Counts) -> Self {
        let coefficients = result.coefficients;
        let each = |of: fn(&Coefficient) -> f64| {
            coefficients.map_or([0.0; TERMS], |coefficients| coefficients.each_ref().map(of))
        };
        Self {
            schema: 1,
            method: result.name.clone(),
            rows: counts.rows,
            used_rows: counts.used_rows,
            std_before_nT: result.std_before_nt,
            std_after_nT: result.std_after_nt,
            improvement_ratio: result.improvement_ratio(),
            std_after_update_nT: result.std_after_update_nt.unwrap_or(result.std_after_nt),
            coefficients: each(|coefficient| coefficient.value),
            coefficient_std: each(|coefficient| coefficient.std),
            adaptation: result.adaptation,
            settled: result.settled.as_ref().map(SettledSummary::from),
            noise_floor_nT: result.noise_floor_nt,
            fourth_difference_nT: result.fourth_difference_nt,
            figure_of_merit: MeritSummary::of(&result.merit),
            headings: headings(result),
            condition_number: None,
            bad_rows: counts.bad_rows.clone(),
            warnings: Vec::new(),
            session_gaps: counts.session_gaps.clone(),
            provenance: None,
        }
    }
}

/// The figures of the rows after settling.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct SettledSummary {
    /// Where they begin after the first row, s.
    pub from_s: f64,
    /// How many they are.
    pub rows: u64,
    /// Before compensation, nT.
    pub std_before_nT: f64,
    /// After compensation, strictly predictive, nT.
    pub std_after_nT: f64,
    /// The one over the other.
    pub improvement_ratio: f64,
}

impl From<&Settled> for SettledSummary {
    fn from(settled: &Settled) -> Self {
        Self {
            from_s: SETTLED_S,
            rows: settled.rows,
            std_before_nT: settled.std_before_nt,
            std_after_nT: settled.std_after_nt,
            improvement_ratio: settled.improvement_ratio(),
        }
    }
}

/// The figure of merit.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct MeritSummary {
    /// Manoeuvres and headings that are summed over: 12 of the classical figure.
    pub cells: usize,
    /// Before compensation, nT.
    pub before_nT: f64,
    /// After compensation, nT.
    pub after_nT: f64,
}

impl MeritSummary {
    fn of(merit: &FigureOfMerit) -> Option<Self> {
        let [before_nt, after_nt] = merit.sums_nt()?;
        Some(Self { cells: merit.seen().count(), before_nT: before_nt, after_nT: after_nt })
    }
}

/// The figures of the rows on the headings of one sector.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct HeadingSummary {
    /// `N`, `NE` and so on.
    pub heading: &'static str,
    /// How many rows.
    pub rows: u64,
    /// Before compensation, nT.
    pub std_before_nT: f64,
    /// After compensation, nT.
    pub std_after_nT: f64,
    /// The one over the other.
    pub improvement_ratio: f64,
}

fn headings(result: &MethodResult) -> Vec<HeadingSummary> {
    let sectors = SECTORS.iter().zip(result.headings_before.iter().zip(&result.headings));
    let sailed = sectors.filter(|(_, (_, after))| after.count > 0);
    let summary = |(heading, (before, after)): (&&'static str, (&SectorStd, &SectorStd))| HeadingSummary {
        heading,
        rows: after.count,
        std_before_nT: before.std_nt,
        std_after_nT: after.std_nt,
        improvement_ratio: before.std_nt / after.std_nt,
    };
    sailed.map(summary).collect()
}

/// Any result as the JSON that is written and printed: indented, with a newline at the end.
pub fn to_json(result: &impl Serialize) -> String {
    let mut json = serde_json::to_string_pretty(result).expect("numbers and strings are always JSON");
    json.push('\n');
    json
}
