//! Formulas: their text, what they are made of, and their value.

mod expression;
mod lexer;
mod operators;
mod syntax;

pub(crate) use expression::Expression;
pub(crate) use operators::is_function;

use crate::variable::Variable;

/// Where a name of a formula comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// It is of every recording.
    Variable(Variable),
    /// The parameter with this place.
    Parameter(usize),
    /// The input with this place.
    Input(usize),
    /// A column of the recording.
    Column(String),
}

/// A formula that knows where its names come from.
#[derive(Clone, Debug)]
pub struct BoundFormula {
    /// As it is written.
    pub text: String,
    /// Where each value comes from, in the order in which [`Self::eval`] takes them.
    pub sources: Vec<Source>,
    pub(crate) expression: Expression,
}

impl BoundFormula {
    /// What a name alone stands for, whatever characters that name has.
    pub(crate) fn named(text: &str, source: Source) -> Self {
        Self { text: text.into(), sources: vec![source], expression: Expression::of_one() }
    }

    /// The one thing that it is, unchanged, if it is that.
    pub fn alone(&self) -> Option<&Source> {
        self.expression.is_of_one().then(|| &self.sources[0])
    }

    /// Its value; not a number where it has none. `values` are those of [`Self::sources`].
    pub fn eval(&self, values: &[f64]) -> f64 {
        self.expression.eval(values)
    }
}
