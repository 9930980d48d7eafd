//! The sim-to-real gap of a recording: where it lies, which unmodelled effect causes it, and how far it shrinks.
//!
//! ```text
//! recording -> Prepared -> World (direction smoothed, field, coefficients) -> Signals of the simulator
//!   readings less signals -> RegressionProblem: background projected out, noise whitened, 18 terms refitted
//!     -> search: every effect of the simulator's library on what is left, the best added, all fitted jointly
//!       fluxgate first; its correction makes a new World for the scalar
//!     -> localise, shrink on held-out blocks, probabilities, verdict
//! ```

mod base;
mod change;
mod channel_search;
mod confirm;
mod consequence;
mod diagnose;
mod evidence;
mod findings;
mod firmware;
mod manoeuvre;
mod noise;
mod null;
mod numerics;
mod once;
mod own_simulation;
mod plan;
mod policy;
mod reconstruct;
mod recording;
mod regression;
mod result;
mod rounding;
mod search;
mod selection;
mod shapes;
mod targets;
mod unexplained;
mod verdict;

pub use change::{EffectOnScalar, NamedChange};
pub(crate) use diagnose::diagnose_telling;
pub use diagnose::{DiagnoseSettings, Stage, diagnose, named_change, plan};
pub use firmware::{is_mismatch, mismatch, replay_log};
pub use own_simulation::{OwnSimulation, SimulatedTrack};
pub use plan::{Alike, PLANNED_STRENGTH, Plan, PlannedEffect, Segment, Separated};
pub use reconstruct::prepared::{LEAST_VALID_S, Prepared};
pub use result::{
    CandidateShare, Cell, ChannelGap, ChannelResiduals, ColumnForm, ColumnMatch, ColumnWay, Consequence, Curve,
    CurvePoint, Description, Diagnosis, DriverForm, DriverShare, EffectFound, Gap, GapClosed, ManoeuvreKind, Map,
    NextManoeuvre, Outcome, ParameterEstimate, RoundingFound, SessionReplay, SimulationUsed, TargetFound, Unexplained,
    Verdict,
};
