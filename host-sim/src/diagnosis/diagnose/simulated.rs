//! Recordings for the tests of the diagnosis.

use std::path::Path;

use crate::diagnosis::base::blocks_of;
use crate::diagnosis::noise::model::NoiseModel;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::recording::Recording;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::effects::{Channel, Library};
use crate::simulator::scenario::{Scenario, Simulation};

/// Four minutes of a preset, with nothing in it but noise.
pub(in crate::diagnosis) fn recorded(preset: &str) -> Prepared {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(preset);
    let scenario = Scenario { duration_s: 240.0, ..Scenario::read(&path).expect("a scenario of this repository") };
    let simulation = Simulation::new(&scenario, scenario.seed).expect("a good scenario");
    Prepared::of_simulation(&simulation, &[], "simulated", &[]).expect("a recording")
}

/// What the scalar of a recording is to be explained by, as if its noise were white.
pub(in crate::diagnosis) fn in_white_noise<'a>(
    recording: &Recording<'_>,
    library: &'a Library,
) -> RegressionProblem<'a> {
    let Recording { table, start, .. } = recording;
    let white = NoiseModel::white(&blocks_of(start.epochs_s(), &table.usable)).whitening;
    RegressionProblem::new(library, Channel::Scalar, start.clone(), table.to_explain_nt(), white)
}
