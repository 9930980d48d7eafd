//! `host-sim table`: the paper's Table 1 on simulated recordings, every method, in one run.

use std::path::{Path, PathBuf};

use serde::Serialize;
use towmag::{Method, Settings};

use super::calibrate::fit;
use super::simulate::simulate;
use super::start::start_at;
use crate::detection::{Detection, InjectionSettings, detection_of_injected};
use crate::error::HostError;
use crate::message::file_name;
use crate::output::{AsideFolder, OutputDir, OutputError};
use crate::run::SETTLED_S;
use crate::summary::to_json;

/// Every method, in the order of the paper's tables.
const METHODS: [Method; 5] = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint, Method::Adaptive];

/// Where the second half of the table begins, s.
pub const LATE_S: f64 = SETTLED_S;

/// What `table.json` holds.
#[derive(Clone, Debug, Serialize)]
pub struct MethodTable {
    /// Format of the file.
    pub schema: u32,
    /// The scenario that was calibrated on.
    pub calibration: String,
    /// Its improvement ratio.
    pub calibration_improvement_ratio: f64,
    /// One entry a tow.
    pub tows: Vec<TowResult>,
}

/// All methods on a tow.
#[derive(Clone, Debug, Serialize)]
pub struct TowResult {
    /// Its scenario.
    pub scenario: String,
    /// Over all rows that the filter has settled for.
    pub whole: Vec<Entry>,
    /// From [`LATE_S`] on.
    pub late: Vec<Entry>,
    /// Improvement of the best 18 coefficients in hindsight over the late rows: what noise allows.
    pub late_bound_improvement_ratio: f64,
}

/// One method.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct Entry {
    /// Its name.
    pub method: String,
    /// Band-passed standard deviation after it, strictly predictive, nT.
    pub std_after_nT: f64,
    /// That of `none` over this one.
    pub improvement_ratio: f64,
}

/// Make the recordings of the scenarios, calibrate on the first, run every method on the others.
pub fn table(calibration: &Path, tows: &[PathBuf], out: &Path, settings: &Settings) -> Result<MethodTable, HostError> {
    OutputDir::check(out, &["table.json"])?;
    let output = OutputDir::create(out)?;
    let made = AsideFolder::new().map_err(|source| OutputError::Io { path: out.into(), source })?;
    let recording = |scenario: &Path| made.path().join(Path::new(&file_name(scenario)).with_extension("csv"));
    let land = recording(calibration);
    simulate(calibration, &land, None, &[], None)?;
    let fitted = fit(&land.as_path().into(), settings)?;
    let start = start_at(&fitted.file);
    let tow = |scenario: &PathBuf| {
        let towed = recording(scenario);
        simulate(scenario, &towed, None, &[], None)?;
        let entries = |skip_s: f64| {
            let injection = InjectionSettings { skip_s, ..InjectionSettings::default() };
            let (bound_nt, methods) =
                detection_of_injected(&towed.as_path().into(), &METHODS, settings, &start, &injection)?;
            let before_nt = methods[0].residual_nT;
            let entry = |of: &Detection| Entry {
                method: of.method.clone(),
                std_after_nT: of.residual_nT,
                improvement_ratio: before_nt / of.residual_nT,
            };
            Ok::<_, HostError>((methods.iter().map(entry).collect(), before_nt / bound_nt))
        };
        let ((whole, _), (late, late_bound_improvement_ratio)) = (entries(0.0)?, entries(LATE_S)?);
        Ok(TowResult { scenario: file_name(scenario), whole, late, late_bound_improvement_ratio })
    };
    let table = MethodTable {
        schema: 1,
        calibration: file_name(calibration),
        calibration_improvement_ratio: fitted.file.calibration.improvement_ratio,
        tows: tows.iter().map(tow).collect::<Result<_, HostError>>()?,
    };
    output.write("table.json", to_json(&table))?;
    output.commit("table.json")?;
    Ok(table)
}
