//! `host-sim diagnose --plan`: what a planned tow could tell, before it is sailed.

use std::path::Path;

use super::inputs::keep_inputs;
use crate::diagnosis::{self, DiagnoseSettings, Plan, Prepared};
use crate::effects::Library;
use crate::error::HostError;
use crate::output::OutputDir;
use crate::simulator::scenario::{Scenario, Simulation};
use crate::text::plan as words;

const RESULTS: [&str; 1] = ["plan.json"];

/// Simulate a scenario, find what a diagnosis of it could tell, and write `plan.json`. Targets of the scenario are left out: where they
/// will be is not known.
pub fn plan(scenario_file: &Path, out: &Path, seed: u64, library: Library) -> Result<Plan, HostError> {
    keep_inputs(&[scenario_file], out, &RESULTS)?;
    let scenario = Scenario { targets: Vec::new(), ..Scenario::read(scenario_file)? };
    let named = |what: String| HostError::Usage(format!("{}: {what}", scenario_file.display()));
    let simulation = Simulation::new(&scenario, scenario.seed).map_err(named)?;
    let name = scenario_file.display().to_string();
    let table = Prepared::of_simulation(&simulation, &[], &name, &library.columns())?;
    let plan = diagnosis::plan(&table, &DiagnoseSettings { seed, library, ..DiagnoseSettings::default() })?;
    let output = OutputDir::create(out)?;
    output.write("plan.json", words::json(&plan))?;
    output.commit("plan.json")?;
    Ok(plan)
}
