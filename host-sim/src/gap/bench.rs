//! One channel of a recording on the bench: what was read, what the simulator allows for, and joint fits of effects.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use rayon::prelude::*;
use towmag::compensation::TERMS;

use super::span::{Span, dot, explained, gram_of};
use super::term::{
    Library, Term, depends_on_coefficients, is_timing, moved, neighbours, smooth_parameters, tried_parameters,
};
use super::whiten::Whitener;
use super::world::UNIT_FIELD_NT;
use crate::simulator::effect::{Channel, Kind};
use crate::simulator::signals::{Signals, World};

/// Iterations of a joint fit.
const ITERATIONS: usize = 8;
/// A fit has converged when a step promises less than this of the sum of squares.
const CONVERGED: f64 = 0.02;
/// Steps of parameters that are tried end here, of the smallest useful one: many edges together tell parts of a row.
const FINEST: f64 = 0.12;

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

    /// Fit jointly, from the values that the terms have. Parameters that must be tried out stay as they are.
    pub(super) fn fit(&self, terms: &[Term]) -> Fit {
        let mut terms = terms.to_vec();
        let mut signals = self.signals.clone();
        let mut coefficients = self.fitted_of(&signals);
        let mut sensitivity: Option<Vec<Vec<f64>>> = None;
        let mut best: Option<(f64, Vec<Term>, Vec<f64>)> = None;
        let mut step = 1.0;
        let mut result: Option<(f64, Fit)> = None;
        for iteration in 0..ITERATIONS {
            let columns: Vec<Vec<f64>> = terms.par_iter().map(|term| term.column(self.library, &signals)).collect();
            let residual = self.whitener.apply(&self.residual(&coefficients, &columns));
            let sse = dot(&residual, &residual);
            if let Some((before, terms_before, coefficients_before)) = &best
                && sse > *before * (1.0 + 1e-9) + 1e-6
                && step > 0.05
                && iteration + 1 < ITERATIONS
            {
                // Too far: half the way back.
                let back = |new: &mut f64, old: f64| *new = old + 0.5 * (*new - old);
                for (term, old) in terms.iter_mut().zip(terms_before) {
                    term.at.iter_mut().zip(&old.at).for_each(|(new, &old)| back(new, old));
                    term.coordinates.iter_mut().zip(&old.coordinates).for_each(|(new, &old)| back(new, old));
                }
                coefficients.iter_mut().zip(coefficients_before).for_each(|(new, &old)| back(new, old));
                signals = self.signals_with(&coefficients);
                step *= 0.5;
                continue;
            }
            best = Some((sse, terms.clone(), coefficients.clone()));
            if sensitivity.is_none() || iteration <= 2 {
                sensitivity = Some(self.sensitivity(&terms, &signals, &coefficients));
            }
            let (span, first_column) = self.span_of(&terms, &signals, &columns, sensitivity.as_deref().unwrap_or(&[]));
            let change = span.solve(&residual);
            let mut rest = residual;
            span.sweep(&mut rest);
            let promised = sse - dot(&rest, &rest);
            let fit =
                Fit { terms: terms.clone(), coefficients: coefficients.clone(), columns, span, first_column, rest };
            if terms.is_empty() {
                let fitted = coefficients.iter().zip(&change).map(|(c, d)| c + d).collect();
                return Fit { coefficients: fitted, ..fit };
            }
            let converged = promised < CONVERGED && iteration > 0;
            // A fit that runs away is known by what it leaves, not by what its linearisation promises.
            if result.as_ref().is_none_or(|(best, _)| sse <= *best) {
                result = Some((sse, fit));
            }
            if converged {
                break;
            }
            step = 1.0;
            self.advance(&mut terms, &mut coefficients, &change);
            signals = self.signals_with(&coefficients);
        }
        let (sse, fit) = result.expect("at least one iteration");
        self.unless_run_away(sse, fit)
    }

    /// A fit that leaves far more than its linearisation says did not converge: what it leaves is what counts.
    fn unless_run_away(&self, sse: f64, fit: Fit) -> Fit {
        if sse <= 1.02 * fit.sse() + 20.0 {
            return fit;
        }
        let rest = self.whitener.apply(&self.residual(&fit.coefficients, &fit.columns));
        Fit { rest, ..fit }
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

    /// The directions of everything in a fit but one term.
    pub(super) fn fit_held(&self, others: &[Term], fit: &Fit, index: usize) -> Span {
        let mut columns = fit.columns.clone();
        columns.remove(index);
        let sensitivity = self.sensitivity(&fit.terms, &self.signals, &fit.coefficients);
        self.span_of(others, &self.signals, &columns, &sensitivity).0
    }

    /// Columns of the parameters of a term, at a fit.
    pub(super) fn own_columns(&self, fit: &Fit, index: usize) -> Vec<Vec<f64>> {
        let term = &fit.terms[index];
        let mut columns = term.signatures(self.library, &self.signals);
        columns.extend(self.derivatives(term, &self.signals, &fit.columns[index]));
        columns
    }

    fn fitted_of(&self, signals: &Signals) -> Vec<f64> {
        let coefficients = &signals.world().coefficients;
        (0..self.refitted.len())
            .map(|k| if k < 3 { coefficients[k] } else { coefficients[k] * UNIT_FIELD_NT })
            .collect()
    }

    /// Refitted columns as the terms make them, then the columns of each term.
    fn span_of(
        &self,
        terms: &[Term],
        signals: &Signals,
        columns: &[Vec<f64>],
        sensitivity: &[Vec<f64>],
    ) -> (Span, Vec<usize>) {
        let mut raw: Vec<Vec<f64>> = self.refitted.clone();
        for (column, more) in raw.iter_mut().zip(sensitivity) {
            column.iter_mut().zip(more).for_each(|(x, d)| *x += d);
        }
        let mut first = Vec::with_capacity(terms.len());
        for (term, column) in terms.iter().zip(columns) {
            first.push(raw.len());
            raw.extend(term.signatures(self.library, signals));
            raw.extend(self.derivatives(term, signals, column));
        }
        let whitened: Vec<Vec<f64>> = raw.par_iter().map(|column| self.whitener.apply(column)).collect();
        (Span::of(&whitened), first)
    }

    /// Derivatives by the smooth parameters of a term.
    fn derivatives(&self, term: &Term, signals: &Signals, _column: &[f64]) -> Vec<Vec<f64>> {
        let name = term.name(self.library);
        let parameters = self.library[term.effect].spec().parameters;
        smooth_parameters(name, &term.at, self.duration_s())
            .into_iter()
            .map(|(index, step)| {
                let shifted = |by: f64| {
                    let mut other = term.clone();
                    let [low, high] = parameters[index].range;
                    other.at[index] = (other.at[index] + by).clamp(low, high);
                    (other.at[index], other.column(self.library, signals))
                };
                let ((to, above), (from, below)) = (shifted(step), shifted(-step));
                let width = (to - from).max(f64::MIN_POSITIVE);
                above.iter().zip(&below).map(|(a, b)| (a - b) / width).collect()
            })
            .collect()
    }

    fn advance(&self, terms: &mut [Term], coefficients: &mut [f64], change: &[f64]) {
        let mut at = coefficients.len();
        coefficients.iter_mut().zip(change).for_each(|(c, d)| *c += d);
        for term in terms {
            let spec = self.library[term.effect].spec();
            for coordinate in &mut term.coordinates {
                *coordinate += change[at];
                at += 1;
            }
            for (index, _) in smooth_parameters(spec.name, &term.at, self.duration_s()) {
                let [low, high] = spec.parameters[index].range;
                let furthest = 0.25 * (spec.parameters[index].plausible[1] - spec.parameters[index].plausible[0]);
                term.at[index] = (term.at[index] + change[at].clamp(-furthest, furthest)).clamp(low, high);
                at += 1;
            }
        }
    }

    /// How what the terms add depends on each refitted coefficient, all terms together; empty when it does not.
    fn sensitivity(&self, terms: &[Term], signals: &Signals, coefficients: &[f64]) -> Vec<Vec<f64>> {
        let name = |term: &&Term| term.name(self.library);
        if self.refitted.is_empty() || !terms.iter().any(|term| depends_on_coefficients(term.name(self.library))) {
            return Vec::new();
        }
        let mut sums = vec![vec![0.0; signals.len()]; self.refitted.len()];
        let timing: Vec<&Term> = terms.iter().filter(|term| is_timing(name(term))).collect();
        if !timing.is_empty() {
            let (none, each) = self.units();
            let base: Vec<Vec<f64>> = timing.iter().map(|term| term.column(self.library, none)).collect();
            sums.par_iter_mut().zip(each).for_each(|(sum, unit)| {
                for (term, base) in timing.iter().zip(&base) {
                    let column = term.column(self.library, unit);
                    sum.iter_mut().zip(column.iter().zip(base)).for_each(|(s, (x, b))| *s += x - b);
                }
            });
        }
        for term in terms.iter().filter(|term| name(term) == "second_order") {
            let base = term.column(self.library, signals);
            sums.par_iter_mut().enumerate().for_each(|(k, sum)| {
                let mut other = coefficients.to_vec();
                other[k] += 1.0;
                let column = term.column(self.library, &self.signals_with(&other));
                sum.iter_mut().zip(column.iter().zip(&base)).for_each(|(s, (x, b))| *s += x - b);
            });
        }
        sums
    }

    fn units(&self) -> (&Signals, &[Signals]) {
        let (none, each) = self.units.get_or_init(|| {
            let with =
                |coefficients: [f64; TERMS]| Signals::new(World { coefficients, ..self.signals.world().clone() });
            let unit = |k: usize| {
                let mut fitted = vec![0.0; TERMS];
                fitted[k] = 1.0;
                with(self.eq4(&fitted))
            };
            (with([0.0; TERMS]), (0..TERMS).into_par_iter().map(unit).collect())
        });
        (none, each)
    }

    /// A joint fit, and once more with the tried parameters of one of its terms at their best, if that leaves less.
    pub(super) fn fit_tried(&self, terms: &[Term], index: usize, widest: f64) -> Fit {
        let fit = self.fit(terms);
        let term = &terms[index];
        if tried_parameters(term.name(self.library), &term.at, self.duration_s()).is_empty() {
            return fit;
        }
        let mut terms = fit.terms.clone();
        terms[index] = self.tried(&fit, index, widest);
        let again = self.fit(&terms);
        if again.sse() < fit.sse() { again } else { fit }
    }

    /// Try out the parameters of a term that act at whole rows, by halving steps, the other terms' directions swept out.
    /// Returns the term at its best and what it explains then.
    pub(super) fn tried(&self, fit: &Fit, index: usize, widest: f64) -> Term {
        let mut term = fit.terms[index].clone();
        let name = term.name(self.library);
        if tried_parameters(name, &term.at, self.duration_s()).is_empty() {
            return term;
        }
        let mut columns = fit.columns.clone();
        columns.remove(index);
        let others: Vec<Term> =
            fit.terms.iter().enumerate().filter(|(k, _)| *k != index).map(|(_, t)| t.clone()).collect();
        let sensitivity = self.sensitivity(&others, &self.signals, &fit.coefficients);
        let (span, _) = self.span_of(&others, &self.signals, &columns, &sensitivity);
        let mut target = self.whitener.apply(&self.residual(&fit.coefficients, &columns));
        span.sweep(&mut target);
        let mut gain = self.gain(&mut term, &span, &target);
        let mut scale = widest;
        while scale > FINEST {
            let mut better = false;
            for at in neighbours(name, &term.at, self.duration_s(), scale) {
                let mut other = Term { at, ..term.clone() };
                let other_gain = self.gain(&mut other, &span, &target);
                if other_gain > gain + 1e-9 {
                    (term, gain, better) = (other, other_gain, true);
                }
            }
            if !better {
                scale *= 0.5;
            }
        }
        term
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

    /// How far each tried parameter of a term can move before it explains `less` less, everything linear fitted again.
    pub(super) fn limits(&self, fit: &Fit, index: usize, less: f64) -> Vec<(usize, [f64; 2])> {
        let term = &fit.terms[index];
        let name = term.name(self.library);
        let steps = tried_parameters(name, &term.at, self.duration_s());
        if steps.is_empty() {
            return Vec::new();
        }
        let others: Vec<Term> =
            fit.terms.iter().enumerate().filter(|(k, _)| *k != index).map(|(_, t)| t.clone()).collect();
        let span = self.fit_held(&others, fit, index);
        let mut columns = fit.columns.clone();
        columns.remove(index);
        let mut target = self.whitener.apply(&self.residual(&fit.coefficients, &columns));
        span.sweep(&mut target);
        let best = self.gain(&mut term.clone(), &span, &target);
        let side = |parameter: usize, step: f64| {
            let mut by = step;
            for _ in 0..10 {
                let mut other = term.clone();
                other.at = moved(name, &term.at, parameter, by, self.duration_s());
                if self.gain(&mut other, &span, &target) < best - less {
                    break;
                }
                by *= 1.6;
            }
            term.at[parameter] + by
        };
        steps
            .into_iter()
            .map(|(parameter, step)| (parameter, [side(parameter, -step), side(parameter, step)]))
            .collect()
    }

    /// Covariance of the parameters of a term as fitted (coordinates, then smooth ones), for noise of unit variance.
    pub(super) fn covariance(&self, fit: &Fit, index: usize) -> DMatrix<f64> {
        let first = fit.first_column[index];
        let term = &fit.terms[index];
        let name = term.name(self.library);
        let count = term.coordinates.len() + smooth_parameters(name, &term.at, self.duration_s()).len();
        fit.span.covariance().view((first, first), (count, count)).into_owned()
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
