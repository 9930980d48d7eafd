//! What an effect file is made of.

use crate::formula::BoundFormula;

/// The sensor whose reading changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// The scalar sensor.
    Scalar,
    /// The fluxgate.
    Fluxgate,
}

/// How a formula changes a reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It is nT that are added.
    Additive,
    /// The reading times 1 + it.
    Multiplicative,
    /// It is s by which the reading is late: `s'(t) = s(t - formula)`.
    Delay,
}

/// A parameter of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in the formula.
    pub name: String,
    /// Its unit, for a reader; empty when it has none.
    pub unit: String,
    /// Where a diagnosis looks for it.
    pub low: f64,
    /// Where a diagnosis looks for it.
    pub high: f64,
    /// What a simulation takes where nothing else is said.
    pub default: f64,
    /// Whether the formulas are in proportion to it and to all others of which this is said, together.
    pub is_linear: bool,
    /// Whether the formulas change with it in jumps alone, as where it is a moment.
    pub is_stepped: bool,
}

/// A variable made from others over time: what a formula over one epoch cannot say.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name in the formula.
    pub name: String,
    /// What it is made of: a formula without parameters, most often a name alone.
    pub of: BoundFormula,
    /// How.
    pub filter: Filter,
}

/// What makes one variable of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// First-order low-pass of this time constant.
    LowPass(FilterTime),
    /// What it was so long ago.
    Delay(FilterTime),
    /// Its mean over the last so many seconds.
    Mean(FilterTime),
    /// Its time derivative, per s.
    Rate,
    /// A quarter period behind, 0.05 to 0.5 Hz.
    Hilbert,
    /// Follows only once a play of this half width, in the unit of what it is made of, is taken up: Prandtl and Ishlinskii's element.
    Play(f64),
    /// Stays as it was until its input is further away than this, in the unit of that, and then jumps to it.
    Hold(f64),
}

/// A time of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterTime {
    /// s.
    Fixed(f64),
    /// The parameter with this place, s.
    Parameter(usize),
}

impl Filter {
    /// Its time, if it has one.
    pub fn time(self) -> Option<FilterTime> {
        match self {
            Self::LowPass(time) | Self::Delay(time) | Self::Mean(time) => Some(time),
            Self::Rate | Self::Hilbert | Self::Play(_) | Self::Hold(_) => None,
        }
    }
}
