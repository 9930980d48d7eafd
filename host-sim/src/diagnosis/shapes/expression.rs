//! What a shape is made of: variables, filters and functions in the language of effect files, which can be evaluated on any
//! recording and written down.

use std::borrow::Cow;
use std::fmt::{self, Display, Formatter};

use super::filter::Filter;
use super::scene::Scene;

/// A formula over the rows of a recording.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expr {
    Number(f64),
    Variable(String),
    /// What comes of a variable, or of another such, by a filter.
    Filtered(Box<Expr>, Filter),
    Sum(Vec<Expr>),
    Product(Vec<Expr>),
    Apply(Function, Box<Expr>),
}

/// Functions of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Tanh,
    Sin,
    Cos,
    /// The larger of it and 0.
    Positive,
    /// 1 above 0, -1 below.
    Sign,
}

/// A variable by its name.
pub(crate) fn var(name: &str) -> Expr {
    Expr::Variable(name.into())
}

/// A product of two.
pub(crate) fn times(a: &Expr, b: &Expr) -> Expr {
    match (a, b) {
        (Expr::Number(one), other) | (other, Expr::Number(one)) if *one == 1.0 => other.clone(),
        (Expr::Product(all), other) => Expr::Product(all.iter().chain([other]).cloned().collect()),
        _ => Expr::Product(vec![a.clone(), b.clone()]),
    }
}

/// It times itself, so many times.
pub(crate) fn power(x: &Expr, times_itself: usize) -> Expr {
    (0..times_itself).fold(Expr::Number(1.0), |product, _| times(&product, x))
}

/// `(x - middle) / width`.
pub(crate) fn scaled(x: &Expr, middle: f64, width: f64) -> Expr {
    let away = Expr::Sum(vec![x.clone(), Expr::Number(-middle)]);
    Expr::Product(vec![Expr::Number(1.0 / width), away])
}

impl Expr {
    /// A function of it.
    pub(crate) fn apply(self, function: Function) -> Self {
        Self::Apply(function, Box::new(self))
    }

    /// What a filter makes of it.
    pub(crate) fn through(&self, filter: Filter) -> Self {
        Self::Filtered(Box::new(self.clone()), filter)
    }

    /// With some of its variables through a filter.
    pub(crate) fn with_variables(&self, filter: &dyn Fn(&str) -> Option<Filter>) -> Self {
        let all = |parts: &[Self]| parts.iter().map(|part| part.with_variables(filter)).collect();
        match self {
            Self::Number(number) => Self::Number(*number),
            Self::Variable(name) => filter(name).map_or_else(|| self.clone(), |filter| self.through(filter)),
            Self::Filtered(of, own) => of.with_variables(filter).through(*own),
            Self::Sum(parts) => Self::Sum(all(parts)),
            Self::Product(parts) => Self::Product(all(parts)),
            Self::Apply(function, of) => of.with_variables(filter).apply(*function),
        }
    }

    /// One value a row; none where the recording has not what it needs.
    pub(crate) fn evaluate(&self, scene: &Scene) -> Option<Vec<f64>> {
        Some(self.values(scene)?.into_owned())
    }

    /// The same, of a variable without a copy.
    fn values<'b>(&self, scene: &'b Scene) -> Option<Cow<'b, [f64]>> {
        Some(Cow::Owned(match self {
            Self::Number(number) => vec![*number; scene.rows()],
            Self::Variable(name) => return scene.variable(name).map(Cow::Borrowed),
            Self::Filtered(of, filter) => filter.apply(scene.segments(), &of.values(scene)?),
            Self::Sum(parts) => folded(parts, scene, 0.0, |a, b| a + b)?,
            Self::Product(parts) => folded(parts, scene, 1.0, |a, b| a * b)?,
            Self::Apply(function, of) => of.values(scene)?.iter().map(|x| function.of(*x)).collect(),
        }))
    }

    /// With whatever is made by a filter replaced by a variable, as `name` has it; what that is made of is replaced first.
    pub(crate) fn with_inputs(&self, name: &mut dyn FnMut(&Self, Filter) -> String) -> Self {
        let mut all = |parts: &[Self]| parts.iter().map(|part| part.with_inputs(name)).collect();
        match self {
            Self::Number(_) | Self::Variable(_) => self.clone(),
            Self::Sum(parts) => Self::Sum(all(parts)),
            Self::Product(parts) => Self::Product(all(parts)),
            Self::Apply(function, of) => of.with_inputs(name).apply(*function),
            Self::Filtered(of, filter) => {
                let of = of.with_inputs(name);
                Self::Variable(name(&of, *filter))
            }
        }
    }

    /// What a filter makes of a variable, of all that are in it.
    pub(crate) fn filtered(&self) -> Vec<&Self> {
        match self {
            Self::Number(_) | Self::Variable(_) => Vec::new(),
            Self::Filtered(of, _) if matches!(**of, Self::Variable(_)) => vec![self],
            Self::Filtered(of, _) | Self::Apply(_, of) => of.filtered(),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().flat_map(Self::filtered).collect(),
        }
    }

    /// What it is called where it is a variable or made of one by filters.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Filtered(of, filter) => format!("{}_{}", of.name(), filter.suffix()),
            Self::Variable(name) => name.clone(),
            other => other.to_string(),
        }
    }
}

/// Parts put together, one value a row, in their order.
fn folded(parts: &[Expr], scene: &Scene, start: f64, by: impl Fn(f64, f64) -> f64) -> Option<Vec<f64>> {
    let mut whole = vec![start; scene.rows()];
    for part in parts {
        if let Expr::Number(number) = part {
            whole.iter_mut().for_each(|whole| *whole = by(*whole, *number));
        } else {
            whole.iter_mut().zip(&*part.values(scene)?).for_each(|(whole, x)| *whole = by(*whole, *x));
        }
    }
    Some(whole)
}

impl Function {
    fn of(self, x: f64) -> f64 {
        match self {
            Self::Abs => x.abs(),
            Self::Tanh => x.tanh(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Positive => x.max(0.0),
            Self::Sign => x.signum(),
        }
    }
}

/// As an effect file has it.
impl Display for Expr {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let joined = |parts: &[Self], by: &str| parts.iter().map(Self::to_string).collect::<Vec<_>>().join(by);
        match self {
            Self::Number(number) if *number < 0.0 => write!(out, "({})", digits(*number)),
            Self::Number(number) => write!(out, "{}", digits(*number)),
            Self::Variable(_) | Self::Filtered(..) => write!(out, "{}", self.name()),
            Self::Sum(parts) => write!(out, "({})", joined(parts, " + ")),
            Self::Product(parts) => write!(out, "{}", joined(parts, " * ")),
            Self::Apply(function, of) => match function {
                Function::Abs => write!(out, "abs({of})"),
                Function::Tanh => write!(out, "tanh({of})"),
                Function::Sin => write!(out, "sin({of})"),
                Function::Cos => write!(out, "cos({of})"),
                Function::Positive => write!(out, "max(0, {of})"),
                Function::Sign => write!(out, "signum({of})"),
            },
        }
    }
}

/// Ten digits: far below what any sum of some dozen terms shows.
fn digits(number: f64) -> String {
    rounded(number).to_string()
}

/// A number as it is written.
pub(crate) fn rounded(number: f64) -> f64 {
    if number == 0.0 || !number.is_finite() {
        return number;
    }
    format!("{number:.9e}").parse().unwrap_or(number)
}

/// Shapes, each times its weight, one value a row; none where one of them has not what it needs.
pub(crate) fn summed<'b>(terms: impl Iterator<Item = (f64, &'b Expr)>, scene: &Scene) -> Option<Vec<f64>> {
    let mut sum = vec![0.0; scene.rows()];
    for (weight, shape) in terms {
        sum.iter_mut().zip(shape.evaluate(scene)?).for_each(|(sum, x)| *sum += weight * x);
    }
    Some(sum)
}
