//! The recording without any effect: a first fit of the 18 terms, and what follows from it before any search.

use std::sync::Arc;

use nalgebra::DVector;
use towmag::model::TERMS;

use super::noise::blocks::{Block, blocks};
use super::noise::whitening::{Predictor, Whitening};
use super::policy::{COEFFICIENT_PRIOR_NT, COMMON_FIELD, REPEATS_GLRT};
use super::reconstruct::prepared::{Prepared, fill_holes};
use super::reconstruct::smooth::slow;
use super::regression::problem::{Fit, RegressionProblem};
use super::regression::products::{dot, gram_of};
use super::rounding::Rounding;
use super::search::repeats::{Repeats, repeats};
use crate::effects::{Channel, Library};
use crate::simulator::signals::{LONGEST_STEP_S, Signals};

/// Window of the slow part of the field, rows.
const SLOW_ROWS: usize = 60;

/// A first fit of the 18 terms, without any effect.
pub(super) struct BaseFit {
    /// In the units of eq. (4).
    pub(super) coefficients: [f64; TERMS],
    /// Reading less interference, nT, holes bridged.
    pub(super) field_nt: Vec<f64>,
    /// What the model says of each row, nT.
    model_nt: Vec<f64>,
    /// Interference, nT.
    interference_nt: Vec<f64>,
}

impl BaseFit {
    /// `targets_nt` is what targets add at each row, nT: they are quicker than the slow part of the field.
    pub(super) fn of(
        library: &Library,
        signals: &Signals,
        table: &Prepared,
        blocks: &[Block],
        targets_nt: &[f64],
    ) -> Self {
        let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
        let reading_nt = table.to_explain_nt();
        let problem =
            RegressionProblem::new(library, Channel::Scalar, signals.clone(), reading_nt, Arc::new(whitening))
                .holding_terms(table.beyond.held.is_some());
        let fit = problem.fit(&[]);
        let coefficients = problem.eq4(&fit.coefficients);
        let interference_nt = problem.interference_nt(&fit);
        let field_nt = field_nt(&problem, fit);
        let beside_nt: Vec<f64> = field_nt.iter().zip(targets_nt).map(|(field, target)| field - target).collect();
        let slow_nt = slow(&beside_nt, SLOW_ROWS);
        let mut model_nt: Vec<f64> = slow_nt.iter().zip(&interference_nt).map(|(slow, more)| slow + more).collect();
        model_nt.iter_mut().zip(&table.beyond.scalar_nt).for_each(|(model, more)| *model += more);
        model_nt.iter_mut().zip(targets_nt).for_each(|(model, target)| *model += target);
        Self { coefficients, field_nt, model_nt, interference_nt }
    }

    /// Scalar readings that repeat the one before more often than rounding makes them, of the rows that are known.
    pub(super) fn repeats(&self, table: &Prepared, rounding: &Rounding, is_known: &[bool]) -> Option<Repeats> {
        let found = repeats(table, &rounding.scalar_steps_nt(), &differences(&self.model_nt), is_known);
        (found.glrt > REPEATS_GLRT).then_some(found)
    }

    /// Magnitude of the fluxgate vector, less the field that the scalar gives where the two share more than a slow
    /// background; one a row, nT.
    pub(super) fn fluxgate_magnitude_nt(&self, table: &Prepared, blocks: &[Block]) -> Vec<f64> {
        let mut alone = table.magnitudes_nt();
        alone.iter_mut().zip(&table.beyond.magnitude_nt).for_each(|(alone, simulated)| *alone -= simulated);
        let reading_nt = table.to_explain_nt();
        let field_nt = |row: usize| reading_nt[row] - self.interference_nt[row];
        let less: Vec<f64> = (0..table.len()).map(|row| alone[row] - field_nt(row)).collect();
        let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
        let power = |column: &[f64]| {
            let projected = whitening.apply(column);
            dot(&projected, &projected)
        };
        if power(&less) < COMMON_FIELD * power(&alone) { less } else { alone }
    }
}

/// The field, nT, one a row, holes bridged: the reading less the interference of a fit of the 18 terms alone. Of coefficients that the recording does not tell,
/// as the level of the interference on few headings, the fit has any; here they are small.
fn field_nt(problem: &RegressionProblem<'_>, fit: Fit) -> Vec<f64> {
    let variance = fit.sse() / problem.whitening.dof().max(1.0);
    let columns: Vec<Vec<f64>> =
        problem.nuisance_columns.iter().map(|column| problem.whitening.apply(column)).collect();
    let slices: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let mut gram = gram_of(&slices);
    let along = &gram * DVector::from_column_slice(&fit.coefficients);
    (0..columns.len()).for_each(|k| gram[(k, k)] += variance / COEFFICIENT_PRIOR_NT.powi(2));
    let known = gram.cholesky().map_or_else(|| DVector::zeros(columns.len()), |gram| gram.solve(&along));
    filled(&problem.residual_nt(&Fit { coefficients: known.as_slice().to_vec(), ..fit }))
}

/// The usable rows whose scalar is a reading of its own.
pub(super) fn fresh_rows(table: &Prepared, repeats: Option<&Repeats>) -> Vec<bool> {
    let mut fresh = table.usable.clone();
    if let Some(repeats) = repeats {
        repeats.rows.iter().for_each(|&row| fresh[row] = false);
        // Whether the first reading after a hole repeats what is not there cannot be known.
        (1..table.len()).filter(|&row| !table.usable[row - 1]).for_each(|row| fresh[row] = false);
    }
    fresh
}

/// Blocks of the usable rows.
pub(super) fn blocks_of(epochs_s: &[f64], usable: &[bool]) -> Vec<Block> {
    blocks(epochs_s, usable, LONGEST_STEP_S + 1e-6)
}

/// A column with its holes bridged.
pub(super) fn filled(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    fill_holes(&mut values);
    values
}

fn differences(values: &[f64]) -> Vec<f64> {
    (0..values.len()).map(|k| if k == 0 { 0.0 } else { values[k] - values[k - 1] }).collect()
}
