//! An effect as a user wrote it, checked.

use crate::dependence::{is_affine, is_proportional};
use crate::error::EffectFileError;
use crate::formula::{BoundFormula, Source};
use crate::variable::Variable;

/// An effect that a user wrote.
#[derive(Clone, Debug)]
pub struct EffectFile {
    /// The file, as the user named it.
    pub file: String,
    /// Its name on the command line and in every result.
    pub name: String,
    /// What it is, in words that can follow "explained by".
    pub title: String,
    /// The channel that it changes.
    pub channel: Channel,
    /// How the formula changes it.
    pub kind: Kind,
    /// One for the scalar, three for the axes of the fluxgate.
    pub formulas: Vec<BoundFormula>,
    /// In the order of the file, which is that of every slice of their values.
    pub parameters: Vec<Parameter>,
    /// In the order of the file: each may be made of those before it.
    pub inputs: Vec<Input>,
}

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

/// A variable made from another one over time: what a formula over one epoch cannot say.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its name in the formula.
    pub name: String,
    /// What it is made of; never a parameter.
    pub of: Source,
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
}

/// A time of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterTime {
    /// s.
    Fixed(f64),
    /// The parameter with this place, s.
    Parameter(usize),
}

impl EffectFile {
    /// Read and check the text of a file; messages call it `file_name`.
    ///
    /// # Errors
    ///
    /// When it is no effect that can be evaluated: the line, and why.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, EffectFileError> {
        crate::check::checked(text, file_name).map_err(|wrong| wrong.in_file(text, file_name))
    }

    /// Columns of a recording that it needs, each once, beside those that are a [`Variable`](crate::Variable).
    pub fn columns(&self) -> Vec<&str> {
        let mut columns: Vec<&str> = Vec::new();
        for source in self.sources() {
            if let Source::Column(name) = source
                && !columns.contains(&name.as_str())
            {
                columns.push(name);
            }
        }
        columns
    }

    /// Everything that its formulas and inputs are made of.
    pub fn sources(&self) -> impl Iterator<Item = &Source> {
        let inputs = self.inputs.iter().map(|input| &input.of);
        self.formulas.iter().flat_map(|formula| &formula.sources).chain(inputs)
    }

    /// Whether anything in it is made of a variable.
    pub fn asks_for(&self, is_asked: impl Fn(Variable) -> bool) -> bool {
        self.sources().any(|source| matches!(source, Source::Variable(variable) if is_asked(*variable)))
    }

    /// Whether the formulas depend on the clean scalar reading at most as a sum of it and of what filters make of it.
    pub fn is_affine_in_scalar(&self) -> bool {
        let mut of_scalar = vec![Source::Variable(Variable::Scalar)];
        for (index, input) in self.inputs.iter().enumerate() {
            if of_scalar.contains(&input.of) {
                of_scalar.push(Source::Input(index));
            }
        }
        is_affine(&self.parameters, &self.formulas, &of_scalar)
    }

    /// Whether the formulas are in proportion to a parameter, whatever is made of their values.
    pub fn is_proportional_to(&self, index: usize) -> bool {
        is_proportional(&self.parameters, &self.formulas, index)
    }
}

impl Filter {
    /// Its time, if it has one.
    pub fn time(self) -> Option<FilterTime> {
        match self {
            Self::LowPass(time) | Self::Delay(time) | Self::Mean(time) => Some(time),
            Self::Rate | Self::Hilbert => None,
        }
    }
}
