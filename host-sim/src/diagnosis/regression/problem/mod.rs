//! One channel of a recording as a regression problem: what was read, what the simulator allows for, and joint fits of
//! effects.

mod columns;
mod discrete;
mod fit;

use std::sync::{Arc, OnceLock};

use rayon::prelude::*;
use towmag::model::TERMS;

use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::policy::BEYOND_PLAUSIBLE;
use crate::diagnosis::regression::products::{dot, gram_of, norm};
use crate::diagnosis::regression::projection::{Projection, explained};
use crate::diagnosis::regression::term::Term;
use crate::effects::{Channel, Domain, Kind, Library, Parameter};
use crate::simulator::signals::Signals;
use crate::simulator::signals::tolles_lawson::{self, UNIT_FIELD_NT};

/// Everything about a channel but the effects. It is never changed: with other noise or coefficients it is another one, which
/// shares what stays the same.
#[derive(Clone)]
pub(crate) struct RegressionProblem<'a> {
    pub(crate) library: &'a Library,
    pub(crate) channel: Channel,
    /// Signals with the coefficients about which it is linearised.
    pub(crate) signals: Arc<Signals>,
    /// What was read, one a row, nT; not a number where nothing was.
    reading_nt: Arc<[f64]>,
    /// Columns that are refitted whatever the effects: the 18 terms, or none.
    pub(crate) nuisance_columns: Arc<[Vec<f64>]>,
    pub(crate) whitening: Arc<Whitening>,
    /// Signals of the field without coefficients, and with one of them each.
    units: Arc<OnceLock<(Signals, Vec<Signals>)>>,
}

/// A joint fit of some effects, of the refitted columns and of the background.
#[derive(Clone, Debug)]
pub(crate) struct Fit {
    pub(crate) terms: Vec<Term>,
    /// Coefficients of the refitted columns.
    pub(crate) coefficients: Vec<f64>,
    /// What each term adds, one a row, nT.
    pub(crate) columns: Vec<Vec<f64>>,
    /// Whitened columns of everything fitted, as a span, and the first column of each term in it.
    pub(crate) projection: Projection,
    pub(crate) first_column: Vec<usize>,
    /// What is left: whitened, swept.
    pub(crate) residual_whitened: Vec<f64>,
}

impl Fit {
    /// Sum of squares left.
    pub(crate) fn sse(&self) -> f64 {
        dot(&self.residual_whitened, &self.residual_whitened)
    }

    /// All terms but one.
    pub(crate) fn others(&self, index: usize) -> Vec<Term> {
        let mut others = self.terms.clone();
        others.remove(index);
        others
    }
}

impl<'a> RegressionProblem<'a> {
    pub(crate) fn new(
        library: &'a Library,
        channel: Channel,
        signals: Signals,
        reading_nt: Vec<f64>,
        whitening: Arc<Whitening>,
    ) -> Self {
        let nuisance_columns = if channel == Channel::Scalar { eighteen_terms(&signals) } else { Vec::new() };
        Self {
            library,
            channel,
            signals: Arc::new(signals),
            reading_nt: reading_nt.into(),
            nuisance_columns: nuisance_columns.into(),
            whitening,
            units: Arc::default(),
        }
    }

    /// The same with another noise model.
    pub(crate) fn whitened_by(&self, whitening: &Arc<Whitening>) -> Self {
        Self { whitening: Arc::clone(whitening), ..self.clone() }
    }

    /// The same, linearised about the coefficients of a fit.
    pub(crate) fn linearised_at(&self, fit: &Fit) -> Self {
        Self { signals: self.signals_with(&fit.coefficients), ..self.clone() }
    }

    /// The same with the 18 terms held at the coefficients of its signals, as far as the readings are without them already.
    pub(crate) fn holding_terms(&self, holds: bool) -> Self {
        if holds { Self { nuisance_columns: Arc::default(), ..self.clone() } } else { self.clone() }
    }

    /// Whether the 18 terms are held although they are the channel's.
    pub(crate) fn holds_terms(&self) -> bool {
        self.channel == Channel::Scalar && self.nuisance_columns.is_empty()
    }

    /// The same with other readings, one a row, nT.
    pub(crate) fn with_reading(&self, reading_nt: Vec<f64>) -> Self {
        Self { reading_nt: reading_nt.into(), ..self.clone() }
    }

    /// Length of the recording, s.
    pub(crate) fn duration_s(&self) -> f64 {
        self.signals.epochs_s().last().copied().unwrap_or(0.0).max(1.0)
    }

    /// Coefficients of a fit in the units of eq. (4).
    pub(crate) fn eq4(&self, fitted: &[f64]) -> [f64; TERMS] {
        if fitted.is_empty() {
            return *self.signals.coefficients();
        }
        let mut coefficients = [0.0; TERMS];
        for (k, value) in fitted.iter().enumerate().take(TERMS) {
            coefficients[k] = if k < 3 { *value } else { *value / UNIT_FIELD_NT };
        }
        coefficients
    }

    /// Signals with other coefficients.
    fn signals_with(&self, fitted: &[f64]) -> Arc<Signals> {
        if self.nuisance_columns.is_empty() {
            return Arc::clone(&self.signals);
        }
        Arc::new(self.signals.with_coefficients(self.eq4(fitted)))
    }

    /// Whether all parameters of a term are such as may be.
    pub(crate) fn is_plausible(&self, term: &Term) -> bool {
        let spec = self.library[term.effect].spec();
        spec.parameters.iter().zip(term.parameters(self.library)).all(|(parameter, value)| {
            let widest = match parameter.kind {
                Kind::Linear => beyond_plausible(parameter),
                _ => parameter.range,
            };
            value.is_finite()
                && (matches!(parameter.domain, Domain::Cyclic { .. })
                    || parameter.domain == Domain::Moment
                    || (value >= widest[0] && value <= widest[1]))
        })
    }

    /// What was read, one a row, nT; not a number where nothing was.
    pub(crate) fn reading_nt(&self) -> &[f64] {
        &self.reading_nt
    }

    /// Reading less everything fitted, nT.
    fn residual(&self, coefficients: &[f64], columns: &[Vec<f64>]) -> Vec<f64> {
        let mut residual = self.reading_nt.to_vec();
        for (column, coefficient) in self.nuisance_columns.iter().zip(coefficients) {
            residual.iter_mut().zip(column).for_each(|(r, x)| *r -= coefficient * x);
        }
        for column in columns {
            residual.iter_mut().zip(column).for_each(|(r, x)| *r -= x);
        }
        residual
    }

    /// What a fit says of the refitted columns together, nT, one a row.
    pub(crate) fn interference_nt(&self, fit: &Fit) -> Vec<f64> {
        self.of_coefficients(&fit.coefficients, &[])
    }

    /// What its sensor would read with a term and without noise, nT, one a row; of the fluxgate beside its magnitude.
    pub(crate) fn read_nt(&self, term: &Term) -> Vec<f64> {
        let mut reading_nt = match self.channel {
            Channel::Scalar => self.signals.scalar_at_rows_nt().to_vec(),
            Channel::Fluxgate => vec![0.0; self.signals.len()],
        };
        let added_nt = term.column(self.library, &self.signals);
        reading_nt.iter_mut().zip(added_nt).for_each(|(reading, nt)| *reading += nt);
        reading_nt
    }

    /// What a random effect adds to the variance of each row, nT^2; none of one that is not random.
    pub(crate) fn random_nt2(&self, term: &Term) -> Option<Vec<f64>> {
        self.library[term.effect].variance(&self.signals, &term.at).map(|change| change.scalar_nt)
    }

    /// The residual of a fit, nT, one a row.
    pub(crate) fn residual_nt(&self, fit: &Fit) -> Vec<f64> {
        self.residual(&fit.coefficients, &fit.columns)
    }

    fn fitted_of(&self, signals: &Signals) -> Vec<f64> {
        let coefficients = signals.coefficients();
        (0..self.nuisance_columns.len())
            .map(|k| if k < 3 { coefficients[k] } else { coefficients[k] * UNIT_FIELD_NT })
            .collect()
    }

    /// What a term explains of a swept target; sets its coordinates to their best.
    pub(crate) fn glrt(&self, term: &mut Term, projection: &Projection, target: &[f64]) -> f64 {
        let regressors = term.regressors(self.library, &self.signals);
        if regressors.is_empty() {
            let mut column = self.whitening.apply(&term.column(self.library, &self.signals));
            projection.project_out(&mut column);
            return 2.0 * dot(&column, target) - dot(&column, &column);
        }
        let projected = self.projected(&regressors, projection);
        let (glrt, coordinates, _) = solve(&projected, target);
        term.coordinates = coordinates;
        glrt
    }

    /// Columns whitened and swept.
    pub(crate) fn projected(&self, columns: &[Vec<f64>], projection: &Projection) -> Vec<Vec<f64>> {
        columns.par_iter().map(|column| self.swept(column, projection).0).collect()
    }

    /// One of them, and its norm before it was swept.
    pub(crate) fn swept(&self, column: &[f64], projection: &Projection) -> (Vec<f64>, f64) {
        let mut swept = self.whitening.apply(column);
        let whole = norm(&swept);
        projection.project_out(&mut swept);
        (swept, whole)
    }
}

/// Far beyond the plausible values of a linear parameter, away from 0, but not beyond its range.
fn beyond_plausible(parameter: &Parameter) -> [f64; 2] {
    let ([low, high], [from, to]) = (parameter.plausible, parameter.range);
    [low.min(low * BEYOND_PLAUSIBLE).max(from), high.max(high * BEYOND_PLAUSIBLE).min(to)]
}

/// What columns explain of a target, with which coefficients, and how many of them are independent.
pub(crate) fn solve(columns: &[impl AsRef<[f64]>], target: &[f64]) -> (f64, Vec<f64>, usize) {
    let columns: Vec<&[f64]> = columns.iter().map(AsRef::as_ref).collect();
    let q = nalgebra::DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, target)));
    let gram = gram_of(&columns);
    let (glrt, coefficients, rank) = explained(&gram, &q);
    (glrt, coefficients.as_slice().to_vec(), rank)
}

/// The 18 columns of eq. (4) with the true derivative; induced and eddy ones per 50,000 nT.
fn eighteen_terms(signals: &Signals) -> Vec<Vec<f64>> {
    let rows = signals.rows();
    let mut columns: Vec<Vec<f64>> = (0..TERMS).map(|_| Vec::with_capacity(signals.len())).collect();
    for row in 0..signals.len() {
        let field = rows.field_nt[row] / UNIT_FIELD_NT;
        let values = tolles_lawson::columns(field, rows.direction[row], rows.direction_rate[row]);
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }
    columns
}
