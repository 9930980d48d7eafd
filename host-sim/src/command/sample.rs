//! `host-sim sample`: the two recordings that the README's first command runs on.

use std::io::Write;
use std::path::Path;

use super::hidden::file_of;
use crate::error::HostError;
use crate::output::OutputDir;
use crate::simulator::{Scenario, sample_calibration, sample_survey};

/// Write `calibration.csv`, `survey.csv` and what is hidden in it, `survey.targets.csv`.
pub fn sample(out: &Path) -> Result<(), HostError> {
    OutputDir::check(out, &["calibration.csv", "survey.csv", "survey.targets.csv"])?;
    let output = OutputDir::create(out)?;
    output.write("calibration.csv", recording(&sample_calibration()))?;
    let survey = sample_survey();
    output.write("survey.targets.csv", file_of(&survey.targets))?;
    output.write("survey.csv", recording(&survey))?;
    output.commit("survey.csv")?;
    Ok(())
}

/// A made recording as CSV.
pub fn recording(scenario: &Scenario) -> Vec<u8> {
    let mut csv = b"time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,heading_deg\n".to_vec();
    for sample in scenario.samples() {
        let [x, y, z] = sample.flux_nt;
        let heading_deg = sample.attitude.heading.to_degrees().rem_euclid(360.0);
        let (time_s, scalar_nt) = (sample.time_s, sample.scalar_nt);
        writeln!(csv, "{time_s:.1},{scalar_nt:.3},{x:.2},{y:.2},{z:.2},{heading_deg:.1}").expect("memory takes it");
    }
    csv
}
