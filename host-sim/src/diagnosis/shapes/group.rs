//! Shapes of one input, as a residual would show them.

use rayon::prelude::*;
use statrs::statistics::Statistics;

use super::expression::{Expr, var};
use super::ridge::{Products, Ridge};
use super::scene::Scene;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::regression::products::norm;
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::result::DriverForm;

/// Turns of the residual in time that say what a group explains by chance, which keeps the colour of both.
const TURNS: usize = 12;
/// A column of which the fit leaves less than this share of its norm is nothing of its own.
const LEAST_LEFT: f64 = 1e-4;

/// Shapes of one input that are fitted together.
pub(crate) struct Group {
    /// In the contract's words, or a column's name.
    pub(crate) input: String,
    pub(crate) form: DriverForm,
    pub(crate) shapes: Vec<Expr>,
    /// What it is drawn over.
    pub(crate) over: Expr,
    /// Ways that were tried of which this is the best one.
    pub(crate) tried: f64,
    /// Those of its shapes, the first ones, that have nothing of the input: what they do alone, it must outdo.
    pub(crate) without_input: usize,
}

/// The shapes of a group that show beside everything fitted.
pub(crate) struct Shown {
    pub(crate) shapes: Vec<Expr>,
    /// The columns that the residual would show of them, one value a sample, scaled to about one norm.
    pub(crate) columns: Vec<Vec<f64>>,
    /// What they were scaled by.
    pub(crate) scales: Vec<f64>,
}

impl Group {
    /// The shapes that have nothing of the input, as a group; none where all have.
    pub(crate) fn without_input(&self) -> Option<Self> {
        let shapes = self.shapes[..self.without_input].to_vec();
        (!shapes.is_empty()).then(|| Self { shapes, without_input: 0, ..self.bare() })
    }

    /// Whether its shapes mean the same on another recording: what is drawn over time is made of this one's own.
    pub(crate) fn is_portable(&self) -> bool {
        self.over != var("t")
    }

    /// The same without its shapes.
    pub(crate) fn bare(&self) -> Self {
        Self { input: self.input.clone(), shapes: Vec::new(), over: self.over.clone(), ..*self }
    }

    /// Logarithm of how much likelier it makes a whitened residual, all ways counted that were tried, with what of it shows and the fit of
    /// that; none where nothing shows.
    pub(crate) fn weighed(
        &self,
        (problem, fitted): (&RegressionProblem<'_>, &Projection),
        z: &[f64],
        scene: &Scene,
    ) -> Option<(f64, Shown, Ridge)> {
        let shown = self.shown(problem, fitted, scene)?;
        let ridge = Ridge::of(&Products::new(&shown.columns, z));
        Some((ridge.best().1 - self.tried.ln(), shown, ridge))
    }

    /// What of it shows; none where nothing does.
    pub(crate) fn shown(&self, problem: &RegressionProblem<'_>, fitted: &Projection, scene: &Scene) -> Option<Shown> {
        let evaluated = self.shapes.iter().filter_map(|shape| Some((shape, shape.evaluate(scene)?)));
        let (shapes, raw): (Vec<&Expr>, Vec<Vec<f64>>) =
            evaluated.filter(|(_, column)| column.iter().all(|x| x.is_finite())).unzip();
        let (swept, whole): (Vec<Vec<f64>>, Vec<f64>) =
            raw.par_iter().map(|column| problem.swept(column, fitted)).unzip();
        let shows = |k: &usize| whole[*k] > 0.0 && norm(&swept[*k]) > LEAST_LEFT * whole[*k];
        let kept: Vec<usize> = (0..swept.len()).filter(shows).collect();
        let samples = (problem.whitening.samples() as f64).sqrt();
        let scales: Vec<f64> = kept.iter().map(|&k| samples / whole[k]).collect();
        let scaled = |(&k, scale): (&usize, &f64)| swept[k].iter().map(|x| x * scale).collect();
        let columns: Vec<Vec<f64>> = kept.iter().zip(&scales).map(scaled).collect();
        let shapes = kept.iter().map(|&k| shapes[k].clone()).collect();
        (!columns.is_empty()).then_some(Shown { shapes, columns, scales })
    }
}

impl Shown {
    /// Mean and spread of the gain on a residual that is turned round in time.
    pub(crate) fn gain_by_chance(&self, ridge: &Ridge, z: &[f64]) -> (f64, f64) {
        let gains: Vec<f64> = ridge.gains_of_turned(&self.columns, z, TURNS).collect();
        ((&gains).mean(), (&gains).population_std_dev())
    }
}

/// A gain over what chance gives.
pub(crate) fn net_gain(gain: f64, (mean, spread): (f64, f64)) -> f64 {
    gain - mean.max(0.0) - 2.0 * spread
}
