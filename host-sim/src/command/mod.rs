//! What the commands do. Each takes typed arguments, writes its results as a whole or not at all, and returns what
//! the command line prints.

mod calibrate;
mod card;
mod compare;
mod diagnose;
mod diagnose_options;
mod diagnose_report;
mod effect_files;
#[cfg(unix)]
mod emulate;
mod export;
mod hidden;
mod import;
mod inputs;
mod plan;
mod recover;
mod replay;
mod report_data;
mod sample;
mod simulate;
mod start;
mod survey;
mod table;
mod trial;
mod trial_merge;
mod zero_phase;

pub use calibrate::{CalibrateResult, calibrate};
pub use card::{prepare_card, test_card};
pub use compare::{CompareOptions, CompareResult, compare};
pub use diagnose::diagnose;
pub use diagnose_options::DiagnoseOptions;
pub use effect_files::{library_with, own_effects, requests, with_regressors};
#[cfg(unix)]
pub use emulate::{EmulateResult, emulate, emulate_watched};
pub use export::{ExportResult, export};
pub use import::{ImportResult, import};
pub use plan::plan;
pub use recover::{RecoverResult, recover};
pub use replay::{replay, replay_opened};
pub use sample::{recording, sample};
pub use simulate::{SimulateResult, Through, simulate};
pub use start::{start_at, start_from};
pub use survey::{GridSummary, RecordingSummary, SurveyRequest, SurveySummary, survey};
pub use table::{Entry, LATE_S, MethodTable, TowResult, table};
pub use trial::trial;
pub use trial_merge::merge_trial;
