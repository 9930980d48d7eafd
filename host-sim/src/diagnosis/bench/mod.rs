//! One channel of a recording on the bench: what was read, what the simulator allows for, and joint fits of effects.

mod columns;
mod fit;
mod tried;

use std::sync::OnceLock;

use rayon::prelude::*;
use towmag::model::TERMS;

use super::span::{Span, dot, explained, gram_of};
use super::term::{Library, Term};
use super::whiten::Whitener;
use super::world::UNIT_FIELD_NT;
use crate::effects::{Channel, Kind};
use crate::simulator::signals::Signals;

/// A linear parameter beyond this many times what is plausible is no finding.
const BEYOND_PLAUSIBLE: f64 = 20.0;

/// Everything about a channel but the effects.
pub(super) struct Bench<'a> {
    pub(super) library: &'a Library,
    pub(super) channel: Channel,
    /// Signals with the coefficients of the latest fit.
    pub(super) signals: Signals,
    /// What was read, one a row, nT; not a number where nothing was.
    pub(super) reading: Vec<f64>,
    /// Columns that are refitted whatever the effects: the 18 terms, or none.
    pub(super) refitted: Vec<Vec<f64>>,
    pub(super) whitener: Whitener,
    /// Signals of the field without coefficients, and with one of them each.
    units: OnceLock<(Signals, Vec<Signals>)>,
}

/// A joint fit of some effects, of the refitted columns and of the background.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub(super) terms: Vec<Term>,
    /// Coefficients of the refitted columns.
    pub(super) coefficients: Vec<f64>,
    /// What each term adds, one a row, nT.
    pub(super) columns: Vec<Vec<f64>>,
    /// Whitened columns of everything fitted, as a span, and the first column of each term in it.
    pub(super) span: Span,
    pub(super) first_column: Vec<usize>,
    /// What is left: whitened, swept.
    pub(super) rest: Vec<f64>,
}

impl Fit {
    /// Sum of squares left.
    pub(super) fn sse(&self) -> f64 {
        dot(&self.rest, &self.rest)
    }

    /// All terms but one.
    pub(super) fn others(&self, index: usize) -> Vec<Term> {
        let mut others = self.terms.clone();
        others.remove(index);
        others
    }
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        library: &'a Library,
        channel: Channel,
        signals: Signals,
        reading: Vec<f64>,
        whitener: Whitener,
    ) -> Self {
        let refitted = if channel == Channel::Scalar { eighteen_terms(&signals) } else { Vec::new() };
        Self { library, channel, signals, reading, refitted, whitener, units: OnceLock::new() }
    }

    /// Length of the recording, s.
    pub(super) fn duration_s(&self) -> f64 {
        self.signals.epochs_s().last().copied().unwrap_or(0.0).max(1.0)
    }

    /// Coefficients of a fit in the units of eq. (4).
    pub(super) fn eq4(&self, fitted: &[f64]) -> [f64; TERMS] {
        let mut coefficients = [0.0; TERMS];
        for (k, value) in fitted.iter().enumerate().take(TERMS) {
            coefficients[k] = if k < 3 { *value } else { *value / UNIT_FIELD_NT };
        }
        coefficients
    }

    /// Signals with other coefficients.
    fn signals_with(&self, fitted: &[f64]) -> Signals {
        if self.channel == Channel::Fluxgate {
            return self.signals.clone();
        }
        let mut world = self.signals.world().clone();
        world.coefficients = self.eq4(fitted);
        Signals::new(world)
    }

    /// Adopt the coefficients of a fit.
    pub(super) fn adopt(&mut self, fit: &Fit) {
        self.signals = self.signals_with(&fit.coefficients);
    }

    /// Whether all parameters of a term are such as may be.
    pub(super) fn is_plausible(&self, term: &Term) -> bool {
        let spec = self.library[term.effect].spec();
        spec.parameters.iter().zip(term.parameters(self.library)).all(|(parameter, value)| {
            let widest = match parameter.kind {
                Kind::Linear => parameter.plausible.map(|end| end * BEYOND_PLAUSIBLE),
                _ => parameter.range,
            };
            value.is_finite()
                && (parameter.kind == Kind::Cyclic
                    || parameter.name == "time_s"
                    || (value >= widest[0] && value <= widest[1]))
        })
    }

    /// Reading less everything fitted, nT.
    fn residual(&self, coefficients: &[f64], columns: &[Vec<f64>]) -> Vec<f64> {
        let mut residual = self.reading.clone();
        for (column, coefficient) in self.refitted.iter().zip(coefficients) {
            residual.iter_mut().zip(column).for_each(|(r, x)| *r -= coefficient * x);
        }
        for column in columns {
            residual.iter_mut().zip(column).for_each(|(r, x)| *r -= x);
        }
        residual
    }

    /// The residual of a fit, nT, one a row.
    pub(super) fn residual_nt(&self, fit: &Fit) -> Vec<f64> {
        self.residual(&fit.coefficients, &fit.columns)
    }

    fn fitted_of(&self, signals: &Signals) -> Vec<f64> {
        let coefficients = &signals.world().coefficients;
        (0..self.refitted.len())
            .map(|k| if k < 3 { coefficients[k] } else { coefficients[k] * UNIT_FIELD_NT })
            .collect()
    }

    /// What a term explains of a swept target; sets its coordinates to their best.
    pub(super) fn gain(&self, term: &mut Term, span: &Span, target: &[f64]) -> f64 {
        let signatures = term.signatures(self.library, &self.signals);
        if signatures.is_empty() {
            let mut column = self.whitener.apply(&term.column(self.library, &self.signals));
            span.sweep(&mut column);
            return 2.0 * dot(&column, target) - dot(&column, &column);
        }
        let swept = self.swept(&signatures, span);
        let (gain, coordinates, _) = solve(&swept, target);
        term.coordinates = coordinates;
        gain
    }

    /// Columns whitened and swept.
    pub(super) fn swept(&self, columns: &[Vec<f64>], span: &Span) -> Vec<Vec<f64>> {
        columns
            .par_iter()
            .map(|column| {
                let mut whitened = self.whitener.apply(column);
                span.sweep(&mut whitened);
                whitened
            })
            .collect()
    }
}

/// What columns explain of a target, with which coefficients, and how many of them are independent.
pub(super) fn solve(columns: &[Vec<f64>], target: &[f64]) -> (f64, Vec<f64>, usize) {
    let gram = gram_of(&columns.iter().map(|column| &column[..]).collect::<Vec<_>>());
    let q = nalgebra::DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, target)));
    let (gain, coefficients, rank) = explained(&gram, &q);
    (gain, coefficients.as_slice().to_vec(), rank)
}

/// The 18 columns of eq. (4) with the true derivative; induced and eddy ones per 50,000 nT.
fn eighteen_terms(signals: &Signals) -> Vec<Vec<f64>> {
    let rows = signals.rows();
    let mut columns: Vec<Vec<f64>> = (0..TERMS).map(|_| Vec::with_capacity(signals.len())).collect();
    for row in 0..signals.len() {
        let (c, rate, scale) = (rows.direction[row], rows.direction_rate[row], rows.field_nt[row] / UNIT_FIELD_NT);
        let mut next = 0;
        let mut push = |value: f64| {
            columns[next].push(value);
            next += 1;
        };
        c.iter().for_each(|&cosine| push(cosine));
        for i in 0..3 {
            (i..3).for_each(|j| push(scale * c[i] * c[j]));
        }
        for cosine in c {
            rate.iter().for_each(|change| push(scale * cosine * change));
        }
    }
    columns
}
