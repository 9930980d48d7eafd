//! The result of a diagnosis, in numbers and names: sentences are made of it in `text`, pages in `report`.

use serde::Serialize;

pub use super::manoeuvre::kind::ManoeuvreKind;
use crate::effects::Spec;
use crate::provenance::Provenance;
use crate::recording::BadRows;

pub use crate::diagnosis::evidence::interval::ParameterEstimate;
pub use crate::diagnosis::evidence::localise::Cell;
pub use crate::diagnosis::evidence::shrink::GapClosed;
pub use crate::diagnosis::firmware::{Outcome, SessionReplay};
pub use crate::diagnosis::own_simulation::beyond::SimulationUsed;

/// What the recording says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The recording looks like the simulator.
    NoGap,
    /// With the named effects it does.
    Explained,
    /// They help, but a significant gap is left.
    PartlyExplained,
    /// A gap, and none of the known effects causes it.
    Unknown,
}

/// What the scalar's gap means for whoever looks for iron. Each figure three times: with the sensor's noise alone, with the gap, and
/// with the named effects taken off.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(non_snake_case)] // the contract writes units as `Am2`
pub struct Consequence {
    /// Closest distance of the object that is meant, m.
    pub distance_m: f64,
    /// Speed at which it is passed, m/s.
    pub speed_m_per_s: f64,
    /// Smallest moment that is found nine times in ten at one false contact an hour, A m^2.
    pub smallest_moment_Am2: [f64; 3],
    /// How well the place of an object along the track is known that is only just found with the gap, m.
    pub place_m: [f64; 3],
}

/// A whole diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// In a word.
    pub verdict: Verdict,
    /// How large the gap is.
    pub gap: Gap,
    /// Where it lies, largest share first.
    pub cells: Vec<Cell>,
    /// The effects that are at work, most probable first.
    pub effects: Vec<EffectFound>,
    /// Every effect, `none` and `unknown`, as probabilities of being the main cause.
    pub candidates: Vec<CandidateShare>,
    /// What would tell apart what this recording does not.
    pub next_manoeuvre: Option<NextManoeuvre>,
    /// What was found of which no effect is the cause.
    pub unexplained: Vec<Unexplained>,
    /// What drives that, where the verdict says that something is left, and the effect that is proposed for it.
    pub description: Option<Description>,
    /// Passing iron: signal, and no gap; in time.
    pub targets: Vec<TargetFound>,
    /// What the recorder rounds to; none where the sensors are not judged.
    pub rounding: Option<RoundingFound>,
    /// The channels by themselves.
    pub channels: Vec<ChannelGap>,
    /// What the gap means for whoever looks for iron; none without a gap of the scalar.
    pub consequence: Option<Consequence>,
    /// The simulation of the user's own that the recording was held against.
    pub simulation: Option<SimulationUsed>,
    /// Whether a search ended with what it had, because it had gone on for long.
    pub is_cut_short: bool,
    /// Of a device log: what a replay of each session says.
    pub exact_replay: Vec<SessionReplay>,
    /// Rows of the recording that were no good and were not used.
    pub bad_rows: BadRows,
    /// What it was made by, and of; where it was made of a file.
    pub provenance: Option<Provenance>,
    /// The effects that were looked for, for what is written about them.
    pub specs: Vec<&'static Spec>,
    /// The residuals of each channel.
    pub residuals: Vec<ChannelResiduals>,
}

/// Size of the gap, in a channel that has one; of two, in the one that shows more of it.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct Gap {
    /// Residual after the refit of the 18 terms and the background, nT.
    pub residual_rms_nT: f64,
    /// Noise that the simulator expects of it, nT.
    pub noise_floor_rms_nT: f64,
    /// What is left of the one without the other, nT.
    pub excess_rms_nT: f64,
    /// Chance of as much from noise alone, everything that was tried counted.
    pub p_value: f64,
    /// Which channel these are of.
    pub channel: &'static str,
}

/// The steps that the recorder rounds readings to, as the values show them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct RoundingFound {
    /// Of the scalar, the coarsest where it changes, nT.
    pub scalar_nT: f64,
    /// Of the components of the fluxgate, the coarsest of all, nT.
    pub flux_nT: f64,
    /// Share of the noise power that rounding makes, 0 to 1, of the sensor where it is larger.
    pub noise_share: f64,
    /// Of the scalar.
    pub scalar_noise_share: f64,
    /// Of the magnitude of the fluxgate.
    pub flux_noise_share: f64,
}

/// A target: passing iron that both sensors read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct TargetFound {
    /// When its anomaly is largest, on the recording's axis, s.
    pub time_s: f64,
    /// Its largest value, with its sign, nT.
    pub peak_nT: f64,
    /// Between the half heights of the largest lobe, s.
    pub width_s: f64,
    /// That it is a target, and nothing else.
    pub probability: f64,
}

/// One channel's part.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct ChannelGap {
    /// `scalar` or `fluxgate`.
    pub channel: &'static str,
    /// What it says by itself.
    pub verdict: Verdict,
    /// Residual before any effect, nT.
    pub residual_rms_nT: f64,
    /// Residual with all named effects, nT.
    pub residual_after_rms_nT: f64,
    /// Noise, nT.
    pub noise_floor_rms_nT: f64,
}

impl ChannelGap {
    /// What the residual before any effect has beyond the noise, nT rms; 0 where it has less.
    pub fn excess_rms_nt(&self) -> f64 {
        self.beyond_noise_nt(self.residual_rms_nT)
    }

    /// The same of the residual with all named effects.
    pub fn excess_after_rms_nt(&self) -> f64 {
        self.beyond_noise_nt(self.residual_after_rms_nT)
    }

    fn beyond_noise_nt(&self, rms_nt: f64) -> f64 {
        (rms_nt.powi(2) - self.noise_floor_rms_nT.powi(2)).max(0.0).sqrt()
    }
}

/// An effect that is at work.
#[derive(Clone, Debug, Serialize)]
pub struct EffectFound {
    /// Its name.
    pub name: &'static str,
    /// That it is at work.
    pub probability: f64,
    /// Its parameters, in the units of their names.
    pub parameters: Vec<ParameterEstimate>,
    /// Share of the excess that goes with it.
    pub gap_closed: GapClosed,
    /// The same on a second recording, parameters frozen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confirmed: Option<GapClosed>,
    /// Effects that would do nearly as well.
    pub indistinguishable_from: Vec<&'static str>,
    /// The load that drives it, if one that was recorded does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<String>,
    /// The column that drives it, of one that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regressor: Option<String>,
    /// How the field follows that column, where it was tried in full.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<ColumnWay>,
    /// The channel that it changes.
    pub channel: &'static str,
    /// Whether it is noise that is larger somewhere, without an edge: a piece of anything may be that.
    #[serde(skip)]
    pub is_noise_without_edge: bool,
    /// Root of twice its log likelihood ratio: how many standard deviations it stands out.
    pub strength: f64,
}

/// How the field follows a recorded column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ColumnWay {
    /// As it adds to the field.
    pub form: ColumnForm,
    /// How much later than the column the field changes, s; negative where the column is late.
    pub delay_s: f64,
    /// Time constant of a first-order low-pass between the two, s; 0 where there is none.
    pub time_constant_s: f64,
}

/// How a column adds to the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ColumnForm {
    /// Whatever the attitude; the moment that is told is that along the mean direction.
    Additive,
    /// As a moment in body axes, along the direction of the field.
    AlongField,
}

/// A possible main cause.
#[derive(Clone, Debug, Serialize)]
pub struct CandidateShare {
    /// An effect, `none` or `unknown`.
    pub name: &'static str,
    /// Of being the main cause; all sum to 1.
    pub probability: f64,
    /// Share of its own power that the refit leaves on this recording.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub identifiable_fraction: Option<f64>,
}

/// What to do next.
#[derive(Clone, Debug, PartialEq)]
pub struct NextManoeuvre {
    /// What it would tell apart.
    pub separates: Vec<&'static str>,
    /// What to do.
    pub kind: ManoeuvreKind,
    /// Whether what happened once must be made to happen again half way.
    pub repeats_event: bool,
    /// Whether it tells them apart within the time that a manoeuvre may take.
    pub is_enough: bool,
    /// For how long.
    pub minutes: f64,
}

/// A finding without a name.
#[derive(Clone, Debug, Serialize)]
pub struct Unexplained {
    /// `scalar` or `fluxgate`.
    pub channel: &'static str,
    /// What the test that found it looks at.
    pub what: &'static str,
    /// Chance under noise.
    pub p_value: f64,
}

/// What is left beside everything that has a name: what drives it, and how.
#[derive(Clone, Debug)]
pub struct Description {
    /// The sensor that shows it most: `scalar` or `fluxgate`.
    pub channel: &'static str,
    /// Inputs, most probable first; they sum to 1.
    pub drivers: Vec<DriverShare>,
    /// Whether roll or pitch was recorded, from which parts that hang, lie loose or stick are told.
    pub has_tilt: bool,
    /// How the first of them enters; none where nothing that is known does.
    pub form: Option<DriverForm>,
    /// By how much it is later than its driver, s.
    pub delay_s: Option<f64>,
    /// Whether it moves by a step at each of some events of the driver, and stays there in between.
    pub is_in_steps: bool,
    /// Share of the excess that the proposed effect closes, on parts held out; none where nothing is proposed.
    pub gap_closed: Option<GapClosed>,
    /// The same on a second recording, nothing of the proposal fitted to that.
    pub confirmed: Option<GapClosed>,
    /// Whether a few terms did as well as the fitted shape.
    pub is_closed_form: bool,
    /// The known effect, in words that can follow "explained by", that the proposal is in disguise, if it is one.
    pub looks_like: Option<&'static str>,
    /// The proposed effect, as the text of an effect file.
    pub effect_file: Option<String>,
    /// Where nothing that was recorded drives it: the column that its course looks like most.
    pub matched: Option<ColumnMatch>,
    /// What is left over its driver.
    pub curve: Option<Curve>,
    /// The same over the driver and one thing beside it, where that tells clearly more.
    pub map: Option<Map>,
    /// The course in time of what is proposed or else recovered, nT, one value a row of the recording.
    pub course: Vec<Option<f64>>,
}

/// An input that may drive what is left.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DriverShare {
    /// `attitude`, `attitude_rate`, `attitude_history`, `depth`, `depth_rate`, `temperature`, `reading`, `time_periodic`,
    /// `time_irregular`, a column's name, or `none`.
    pub input: String,
    /// That it is the driver.
    pub probability: f64,
    /// Share of the excess that shapes of it close, on parts held out.
    pub closed: f64,
}

/// How a driver enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DriverForm {
    /// It adds to the reading, by itself or as a moment in body axes.
    Additive,
    /// It makes the reading larger or smaller in proportion.
    Multiplicative,
    /// It makes the reading late or early.
    Delay,
    /// It makes the reading's noise larger or smaller.
    Variance,
}

/// What is left, over what drives it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// The driver with its unit.
    pub over: String,
    /// In the order of the driver.
    pub points: Vec<CurvePoint>,
}

/// Rows with about the same value of the driver.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    /// The mean of that value.
    pub driver: f64,
    /// Mean of what is left, or how large it is, nT.
    #[serde(rename = "left_nT")]
    pub left_nt: f64,
    /// Its 95 % band.
    #[serde(rename = "band_nT")]
    pub band_nt: [f64; 2],
    /// What is fitted, nT.
    #[serde(rename = "fitted_nT")]
    pub fitted_nt: f64,
}

/// What is left, over what drives it and one thing beside.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Map {
    /// The driver and what is beside it, with their units.
    pub over: [String; 2],
    /// Edges of the cells along both, ascending.
    pub edges: [Vec<f64>; 2],
    /// A line of cells for each part of what is beside, in it one for each part of the driver; none where there are few rows.
    pub cells: Vec<Vec<Option<CurvePoint>>>,
}

/// A recorded column beside a course in time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnMatch {
    /// Its name.
    pub column: String,
    /// With the course.
    pub correlation: f64,
    /// Chance of as much by any of those tried.
    pub p_value: f64,
    /// How many columns were tried.
    pub tried: usize,
}

/// Residuals of a channel and their power densities.
#[derive(Clone, Debug)]
pub struct ChannelResiduals {
    /// `scalar` or `fluxgate`.
    pub channel: &'static str,
    /// Row of the recording of each value below.
    pub rows: Vec<usize>,
    /// Time on the recording's axis, s.
    pub time_s: Vec<f64>,
    /// Residual without effects, nT.
    pub before_nt: Vec<f64>,
    /// Residual with them, nT.
    pub after_nt: Vec<f64>,
    /// Power density of the one, Hz and nT^2/Hz.
    pub spectrum_before: Vec<[f64; 2]>,
    /// Of the other.
    pub spectrum_after: Vec<[f64; 2]>,
    /// Of the noise model.
    pub spectrum_noise: Vec<[f64; 2]>,
}
