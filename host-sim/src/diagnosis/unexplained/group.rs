//! Shapes that one input drives, held against what is left.

use nalgebra::DVector;

use super::expression::Expr;
use super::left::Left;
use super::ridge::{Folded, Ridge};
use super::scene::Scene;
use crate::diagnosis::regression::projection::{dot, norm};
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
}

impl Group {
    /// The same without its shapes.
    pub(crate) fn bare(&self) -> Self {
        Self { input: self.input.clone(), shapes: Vec::new(), over: self.over.clone(), ..*self }
    }
}

/// A group held against a residual.
pub(crate) struct Judged {
    pub(crate) group: Group,
    /// Shapes that show, and the columns that the residual would show of them, scaled to about one norm, with the scales.
    pub(crate) shapes: Vec<Expr>,
    pub(crate) scales: Vec<f64>,
    pub(crate) folded: Folded,
    /// That does best on parts held out.
    pub(crate) prior: f64,
    /// Logarithm of how much likelier it makes the residual.
    pub(crate) gain: f64,
    /// The same of the residual turned round in time: mean and spread.
    pub(crate) by_chance: (f64, f64),
    /// Reduction of the sum of squares on parts held out.
    pub(crate) taken: f64,
}

impl Judged {
    /// Of the group on a residual; none where none of its shapes shows.
    pub(crate) fn of(group: Group, left: &Left<'_>, scene: &Scene) -> Option<Self> {
        let evaluated = group.shapes.iter().filter_map(|shape| Some((shape, shape.evaluate(scene)?)));
        let (shapes, raw): (Vec<&Expr>, Vec<Vec<f64>>) =
            evaluated.filter(|(_, column)| column.iter().all(|x| x.is_finite())).unzip();
        let whole: Vec<f64> = raw.iter().map(|column| norm(&left.problem.whitening.apply(column))).collect();
        let swept = left.swept(&raw);
        let shows = |k: &usize| whole[*k] > 0.0 && norm(&swept[*k]) > LEAST_LEFT * whole[*k];
        let kept: Vec<usize> = (0..swept.len()).filter(shows).collect();
        if kept.is_empty() {
            return None;
        }
        let samples = (left.z.len() as f64).sqrt();
        let scales: Vec<f64> = kept.iter().map(|&k| samples / whole[k]).collect();
        let columns: Vec<Vec<f64>> =
            kept.iter().zip(&scales).map(|(&k, scale)| swept[k].iter().map(|x| x * scale).collect()).collect();
        let folded = Folded::new(&columns, &left.z, &left.parts);
        let ridge = Ridge::of(&folded.all);
        let (prior, gain) = ridge.best();
        let (tighter, taken) = folded.held_out(prior);
        let turned: Vec<f64> = (1..=TURNS).map(|k| turned_gain(&ridge, &columns, &left.z, k)).collect();
        Some(Self {
            shapes: kept.iter().map(|&k| shapes[k].clone()).collect(),
            taken,
            by_chance: mean_and_spread(&turned),
            gain: gain - group.tried.ln(),
            group,
            scales,
            folded,
            prior: tighter,
        })
    }

    /// Gain over what chance gives, in standard deviations of that.
    pub(crate) fn beyond_chance(&self) -> f64 {
        (self.gain - self.by_chance.0) / self.by_chance.1.max(2.0)
    }

    /// Share of the sum of squares that one plain column would have to take to gain as much.
    pub(crate) fn share_by_evidence(&self) -> f64 {
        1.0 - (-2.0 * self.net_gain().max(0.0) / self.folded.all.n.max(1.0)).exp()
    }

    /// Gain over what chance gives.
    pub(crate) fn net_gain(&self) -> f64 {
        self.gain - self.by_chance.0.max(0.0) - 2.0 * self.by_chance.1
    }
}

fn turned_gain(ridge: &Ridge, columns: &[Vec<f64>], z: &[f64], turn: usize) -> f64 {
    let mut turned = z.to_vec();
    turned.rotate_left(z.len() * turn / (TURNS + 1));
    let q = DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, &turned)));
    ridge.gain_of(&q, dot(z, z))
}

fn mean_and_spread(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt())
}
