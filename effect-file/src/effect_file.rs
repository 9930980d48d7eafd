//! An effect as a user wrote it, checked.

use crate::dependence::{is_affine, is_proportional};
use crate::formula::{BoundFormula, Source};
use crate::parts::{Channel, Filter, Input, Kind, Parameter};
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

impl EffectFile {
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
        let inputs = self.inputs.iter().flat_map(|input| &input.of.sources);
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
            if input.of.sources.iter().any(|source| of_scalar.contains(source)) {
                // What takes up a play or sticks is no sum.
                let is_sum = !matches!(input.filter, Filter::Play(_) | Filter::Hold(_));
                if !is_sum || !is_affine(&self.parameters, std::slice::from_ref(&input.of), &of_scalar) {
                    return false;
                }
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
