//! What `diagnose` is asked for.

use std::path::{Path, PathBuf};

/// What `diagnose` is asked for beside the recording.
#[derive(Clone, Debug, Default)]
pub struct DiagnoseOptions<'a> {
    /// What `calibrate` wrote.
    pub coefficients: Option<&'a Path>,
    /// A second recording to try the findings on.
    pub confirm: Option<&'a Path>,
    /// Effects taken out of the library.
    pub withheld: Vec<String>,
    /// A simulation of the user's own in the place of the base simulator.
    pub simulation: Option<&'a Path>,
    /// Whether the 18 terms of that are held; otherwise they are fitted to the recording.
    pub holds_terms: bool,
    /// Files of effects that are looked for beside those of this program.
    pub effect_files: Vec<PathBuf>,
    /// Columns of the recording that are tried.
    pub regressors: Vec<String>,
    /// Seed of everything drawn.
    pub seed: u64,
}
