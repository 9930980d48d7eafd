//! How the formulas depend on each parameter, found by trying: in proportion, in jumps alone, or in any other way.
//!
//! Values of the variables are drawn, always the same ones. What is called linear holds for all of them to a part in 10^9:
//! a formula that is linear but for a place that no draw meets is not found out here; the check of a fit is the recording.

use crate::formula::{BoundFormula, Source};
use crate::parts::{FilterTime, Input, Kind, Parameter};
use crate::variable::Variable;

/// Draws of all variables that each question is asked with.
const DRAWS: usize = 48;
/// Share of the sizes up to which two values are the same.
const SAME: f64 = 1e-9;
/// A change of a parameter, over its range, that is small beside all but jumps.
const SMALL: f64 = 1e-5;
/// Share of the draws in which a jump may be met by that small change.
const MOST_MET: f64 = 0.05;

/// Say of each parameter how the formulas depend on it.
pub(crate) fn classify(parameters: &mut [Parameter], inputs: &[Input], formulas: &[BoundFormula], kind: Kind) {
    let in_filter = |index: usize| inputs.iter().any(|input| input.filter.time() == Some(FilterTime::Parameter(index)));
    let mut linear: Vec<Source> = Vec::new();
    for index in 0..parameters.len() {
        // A reading that is late is in proportion to nothing, and so is the output of a filter to its time.
        if kind != Kind::Delay && !in_filter(index) {
            linear.push(Source::Parameter(index));
            if !Trial::new(parameters, formulas).is_affine_in(&linear) {
                linear.pop();
            }
        }
    }
    // What is there when all of them are 0 is in proportion to none.
    if !Trial::new(parameters, formulas).is_nothing_without(&linear) {
        linear.clear();
    }
    for index in 0..parameters.len() {
        let is_linear = linear.contains(&Source::Parameter(index));
        let is_stepped = !is_linear && !in_filter(index) && Trial::new(parameters, formulas).is_stepped_in(index);
        (parameters[index].is_linear, parameters[index].is_stepped) = (is_linear, is_stepped);
    }
}

/// Whether all formulas are a plane over some of their sources together, whatever the others are.
pub(crate) fn is_affine(parameters: &[Parameter], formulas: &[BoundFormula], sources: &[Source]) -> bool {
    Trial::new(parameters, formulas).is_affine_in(sources)
}

/// Whether the formulas are in proportion to a parameter, alone.
pub(crate) fn is_proportional(parameters: &[Parameter], formulas: &[BoundFormula], index: usize) -> bool {
    let alone = [Source::Parameter(index)];
    let mut trial = Trial::new(parameters, formulas);
    trial.is_affine_in(&alone) && trial.is_nothing_without(&alone)
}

/// Formulas that are tried with drawn values.
struct Trial<'a> {
    parameters: &'a [Parameter],
    formulas: &'a [BoundFormula],
    state: u64,
}

impl<'a> Trial<'a> {
    fn new(parameters: &'a [Parameter], formulas: &'a [BoundFormula]) -> Self {
        Self { parameters, formulas, state: 0x9e37_79b9_7f4a_7c15 }
    }

    /// Whether the formulas are a plane over all `linear` parameters together.
    fn is_affine_in(&mut self, linear: &[Source]) -> bool {
        self.holds(linear, |value, one, other, scale| {
            let sum: Vec<f64> = one.iter().zip(other).map(|(x, y)| x + scale * y).collect();
            let zero = value(&vec![0.0; one.len()]);
            let (of_one, of_other) = (value(one) - zero, scale * (value(other) - zero));
            [of_one + of_other + zero - value(&sum), of_one.abs() + of_other.abs() + zero.abs()]
        })
    }

    /// Whether they are 0 where all `linear` parameters are.
    fn is_nothing_without(&mut self, linear: &[Source]) -> bool {
        self.holds(linear, |value, one, _, _| [value(&vec![0.0; one.len()]), value(one).abs()])
    }

    /// Whether a difference is next to none of a size, both in this order, for every draw. `differs` is given the formula as a
    /// function of the `linear` parameters alone, two points of them, and a number.
    fn holds(
        &mut self,
        linear: &[Source],
        differs: impl Fn(&dyn Fn(&[f64]) -> f64, &[f64], &[f64], f64) -> [f64; 2],
    ) -> bool {
        let formulas = self.formulas;
        let mut met = 0;
        for formula in formulas {
            for _ in 0..DRAWS {
                let at = self.draw(formula);
                let (one, other, scale) = (self.point(linear), self.point(linear), self.uniform(-3.0, 3.0));
                let value = |point: &[f64]| formula.eval(&placed(formula, &at, linear, point));
                let [difference, size] = differs(&value, &one, &other, scale);
                if !(difference.is_finite() && size.is_finite()) {
                    continue;
                }
                met += 1;
                if difference.abs() > SAME * size {
                    return false;
                }
            }
        }
        met > 0
    }

    /// Whether the value never changes with a small change of a parameter, but with a large one.
    fn is_stepped_in(&mut self, index: usize) -> bool {
        let formulas = self.formulas;
        let Parameter { low, high, .. } = self.parameters[index];
        let (mut tried, mut moved, mut far) = (0.0, 0.0, 0.0);
        for formula in formulas {
            let Some(place) = formula.sources.iter().position(|source| *source == Source::Parameter(index)) else {
                continue;
            };
            for _ in 0..DRAWS {
                let mut at = self.draw(formula);
                let mut value = |parameter: f64| {
                    at[place] = parameter;
                    formula.eval(&at)
                };
                let from = self.uniform(low, high - SMALL * (high - low));
                let [here, near] = [from, from + SMALL * (high - low)].map(&mut value);
                let [first, last] = [low, high].map(&mut value);
                tried += 1.0;
                moved += f64::from(u8::from(here != near));
                far += f64::from(u8::from(first != last));
            }
        }
        far > 0.0 && moved <= MOST_MET * tried
    }

    /// Values of everything that a formula is made of.
    fn draw(&mut self, formula: &BoundFormula) -> Vec<f64> {
        formula.sources.iter().map(|source| self.value(source)).collect()
    }

    /// Values of some sources, parameters of either sign.
    fn point(&mut self, sources: &[Source]) -> Vec<f64> {
        let all = self.parameters;
        let most = |index: usize| all[index].low.abs().max(all[index].high.abs());
        let one = |source: &Source| match source {
            Source::Parameter(index) => self.uniform(-most(*index), most(*index)),
            other => self.value(other),
        };
        sources.iter().map(one).collect()
    }

    /// A value that a variable may have on a recording.
    fn value(&mut self, source: &Source) -> f64 {
        match source {
            Source::Variable(Variable::Direction(_)) => self.uniform(-1.0, 1.0),
            Source::Variable(Variable::DirectionRate(_)) => self.uniform(-0.3, 0.3),
            Source::Variable(Variable::Field | Variable::Scalar) => self.uniform(25_000.0, 65_000.0),
            Source::Variable(Variable::Flux(_)) => self.uniform(-65_000.0, 65_000.0),
            Source::Variable(Variable::Time | Variable::RecordingTime) => self.time_s(),
            Source::Variable(Variable::Depth) => self.uniform(0.0, 50.0),
            Source::Variable(Variable::Temperature) => self.uniform(-5.0, 35.0),
            Source::Parameter(index) => {
                let Parameter { low, high, .. } = self.parameters[*index];
                self.uniform(low, high)
            }
            // Of any size and sign.
            Source::Input(_) | Source::Column(_) => {
                let size = libm::pow(10.0, self.uniform(-2.0, 3.0));
                size * self.uniform(-1.0, 1.0)
            }
        }
    }

    /// Within a recording, or where a parameter may have a moment.
    fn time_s(&mut self) -> f64 {
        let count = self.parameters.len();
        let chosen = (self.uniform(0.0, 1.0 + count as f64)) as usize;
        match self.parameters.get(chosen) {
            Some(Parameter { low, high, .. }) => self.uniform(*low, *high),
            None => self.uniform(0.0, 1200.0),
        }
    }

    /// SplitMix64 (Steele, Lea, Flood 2014): a few numbers without a pattern, the same everywhere.
    fn uniform(&mut self, from: f64, to: f64) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        from + unit * (to - from)
    }
}

/// Values of a formula with others for some of its sources.
fn placed(formula: &BoundFormula, at: &[f64], sources: &[Source], values: &[f64]) -> Vec<f64> {
    let of = |(source, &value): (&Source, &f64)| sources.iter().position(|o| o == source).map_or(value, |k| values[k]);
    formula.sources.iter().zip(at).map(of).collect()
}
