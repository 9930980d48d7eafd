//! What is known of an effect beside its forward model: words, parameters, and how a diagnosis is to look for it.

use super::search::Search;

/// An effect, as it is written about and looked for. Start from [`Spec::BASE`] and say what differs.
#[derive(Debug)]
pub struct Spec {
    /// Its name on the command line and in every result.
    pub name: &'static str,
    /// What it is, in a few words that can follow "explained by".
    pub title: &'static str,
    /// What it is, in a sentence.
    pub what: &'static str,
    /// Where it comes from.
    pub origin: &'static str,
    /// Where its plausible size comes from.
    pub source: &'static str,
    /// Its forward model: the last column of its row in `docs/scenarios.md`, which a test holds against this.
    pub model: &'static str,
    /// Its parameters, in the order of every slice of them.
    pub parameters: &'static [Parameter],
    /// The channel that it changes.
    pub channel: Channel,
    /// The optional column without which it has no meaning.
    pub needs: Option<Column>,
    /// Whether it is random from epoch to epoch, so that only its variance can be known.
    pub random: bool,
    /// Whether its parameters mean the same on another recording: not those that say when something happens.
    pub portable: bool,
    /// How its change depends on the 18 coefficients.
    pub coefficients: CoefficientDependence,
    /// How its first values are found on a recording.
    pub search: Search,
    /// What it must do on parts of the recording that it was not fitted to, to be named.
    pub held_out: HeldOut,
    /// Effects of one family describe one fault together, so that two of them may be at work though what they add
    /// nearly cancels.
    pub family: Option<&'static str>,
    /// What sets it going, where a manoeuvre can keep that away.
    pub driver: Option<Driver>,
    /// Frequencies at which its forward model is cut off and nature is not, Hz: a periodic effect there is that cut.
    pub band_edges_hz: &'static [f64],
    /// Whether a trial may put it into a real recording: it needs no other physics than what was recorded.
    pub injectable: bool,
}

impl Spec {
    /// An additive effect on the scalar, linear in all its parameters, without words.
    pub const BASE: Self = Self {
        name: "",
        title: "",
        what: "",
        origin: "",
        source: "",
        model: "",
        parameters: &[],
        channel: Channel::Scalar,
        needs: None,
        random: false,
        portable: true,
        coefficients: CoefficientDependence::None,
        search: Search::Linear,
        held_out: HeldOut::NotAsked,
        family: None,
        driver: None,
        band_edges_hz: &[],
        injectable: false,
    };

    /// Whether it happens once, at a moment that is one of its parameters.
    pub fn is_momentary(&self) -> bool {
        self.moment().is_some()
    }

    /// The parameter that says when it happens.
    pub fn moment(&self) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.domain == Domain::Moment)
    }

    /// Where the linear parameters are.
    pub fn linear_parameters(&self) -> Vec<usize> {
        (0..self.parameters.len()).filter(|&index| self.parameters[index].kind == Kind::Linear).collect()
    }
}

/// A parameter of an effect.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name, with its unit.
    pub name: &'static str,
    /// Its unit, for a reader; empty when it has none.
    pub unit: &'static str,
    /// Range that is accepted, both ends included.
    pub range: [f64; 2],
    /// Range that is plausible in the field, where a search should look.
    pub plausible: [f64; 2],
    /// How a fit finds it.
    pub kind: Kind,
    /// What its values are.
    pub domain: Domain,
}

/// How a fit finds a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// The change is in proportion to it, the others held. 0 is no effect.
    Linear,
    /// The change is smooth in it: by its derivative, a difference quotient over twice this step.
    Differentiable(Step),
    /// The change jumps with it, as where it says at which row something happens: by trying values this far apart.
    Discrete(Step),
    /// The variance that is added is in proportion to its square.
    Spread,
    /// By the effect's own [search](Search), after which it is held.
    Searched,
    /// It follows from linear coordinates that are not parameters: see [`Effect::from_coordinates`](super::Effect).
    Derived,
}

/// A step of a parameter: `absolute + relative * value + over_duration / duration_s`, the duration of the recording being
/// taken as at least 60 s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// In the parameter's unit.
    pub absolute: f64,
    /// Share of its value.
    pub relative: f64,
    /// In the parameter's unit, times seconds.
    pub over_duration: f64,
}

impl Step {
    /// The same everywhere.
    pub const fn fixed(absolute: f64) -> Self {
        Self { absolute, relative: 0.0, over_duration: 0.0 }
    }

    /// With a share of the value.
    pub const fn growing(absolute: f64, relative: f64) -> Self {
        Self { absolute, relative, over_duration: 0.0 }
    }

    /// The finer the longer the recording.
    pub const fn over_duration(over_duration: f64) -> Self {
        Self { absolute: 0.0, relative: 0.0, over_duration }
    }

    /// At a value, on a recording of so many seconds.
    pub fn at(&self, value: f64, duration_s: f64) -> f64 {
        self.absolute + self.relative * value + self.over_duration / duration_s.max(60.0)
    }
}

/// What the values of a parameter are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// Any number.
    Real,
    /// Whole numbers; 0 is no effect.
    Whole,
    /// It comes round: values that differ by `turn` are the same.
    Cyclic {
        /// In the parameter's unit.
        turn: f64,
    },
    /// A time on the recording's own axis, which acts between two rows.
    Moment,
}

/// What an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// The scalar sensor's reading.
    Scalar,
    /// The fluxgate's reading.
    Fluxgate,
}

/// An optional column of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// `depth_m`.
    Depth,
    /// `temperature_degC`.
    Temperature,
}

/// How the change of an effect depends on the 18 coefficients, which are fitted with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoefficientDependence {
    /// Not at all.
    None,
    /// In proportion to the signal, and so linear in the coefficients.
    Proportional,
    /// In any other smooth way.
    Nonlinear,
}

/// What an effect must do on held-out parts of the recording to be named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldOut {
    /// Nothing: it cannot be bent to fit a few rows.
    NotAsked,
    /// It must explain a part of what it explains elsewhere.
    MustExplain,
    /// It shows at its moment alone, which cannot be held out; but it must not do harm elsewhere.
    MustNotHarm,
}

/// What sets an effect going.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// Waves at the surface.
    Swell,
    /// Currents of pumps, strobes and the like.
    Loads,
}
