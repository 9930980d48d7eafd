//! `second_order`: the interfering vector also turns the field. `s' = s + scale (|F c + Bd| - F - A beta)`.

use super::parts::{dot, linear, scalar_by_row};
use crate::effects::{Change, CoefficientDependence, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::{Signals, vector_nt};

/// The effect `second_order`. The part of the permanent magnetisation alone lies in the span of the 18 terms.
#[derive(Debug)]
pub struct SecondOrder;

const PARAMETERS: &[Parameter] = &[linear("scale", "", 100.0, 2.0)];

const SPEC: Spec = Spec {
    name: "second_order",
    title: "second-order interference",
    what: "the exact length of the disturbed field in place of its projection on the undisturbed one",
    origin: "eq. (4) is linear; a strong body needs the next order, |Bd across|^2 / 2F",
    source: "0.015 nT at 40 nT across the field, 0.4 nT at 200, 10 nT at 1000 (arXiv 2212.09899)",
    model: "the exact `\\|F c + Bd\\| - F` in place of its linearisation, `scale` times the difference",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Nonlinear,
    ..Spec::BASE
};

impl Effect for SecondOrder {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        scalar_by_row(signals, |row| parameters[0] * rest_nt(signals, row))
    }
}

/// `|F c + Bd| - F - c . Bd`, written so that 50,000 nT do not cancel: `(|Bd|^2 - (c . Bd)^2) / (|F c + Bd| + F + c . Bd)`.
fn rest_nt(signals: &Signals, row: usize) -> f64 {
    let rows = signals.rows();
    let (field_nt, c) = (rows.field_nt[row], rows.direction[row]);
    let parts = vector_nt(signals.coefficients(), field_nt, c, rows.direction_rate[row]);
    let bd: [f64; 3] = std::array::from_fn(|i| parts[0][i] + parts[1][i] + parts[2][i]);
    let along_nt = dot(c, bd);
    let whole: [f64; 3] = std::array::from_fn(|i| field_nt * c[i] + bd[i]);
    (dot(bd, bd) - along_nt * along_nt) / (dot(whole, whole).sqrt() + field_nt + along_nt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{signals, trajectory};

    #[test]
    fn it_is_the_exact_length_less_the_linear_one() {
        let signals = signals();
        let change = SecondOrder.change(&signals, &[1.0], &mut no_draw()).scalar_nt;
        let beta = signals.coefficients();
        for row in (0..signals.len()).step_by(7) {
            let (f, c, d) =
                (signals.rows().field_nt[row], signals.rows().direction[row], signals.rows().direction_rate[row]);
            // The symmetric matrix, written out.
            let m = [[beta[3], beta[4] / 2.0, beta[5] / 2.0], [beta[4] / 2.0, beta[6], beta[7] / 2.0]];
            let m = [m[0], m[1], [beta[5] / 2.0, beta[7] / 2.0, beta[8]]];
            let bd: [f64; 3] = std::array::from_fn(|i| {
                beta[i] + (0..3).map(|j| f * m[i][j] * c[j] + f * beta[9 + 3 * i + j] * d[j]).sum::<f64>()
            });
            let exact: f64 = (0..3).map(|i| (f * c[i] + bd[i]).powi(2)).sum::<f64>().sqrt();
            assert!((change[row] - (exact - signals.scalar_at_rows_nt()[row])).abs() < 1e-6);
        }
    }

    #[test]
    fn across_the_field_it_is_the_square_over_twice_the_field() {
        let mut trajectory = trajectory();
        let mut coefficients = [0.0; 18];
        coefficients[0] = 1000.0;
        trajectory.direction.fill([0.0, 0.0, 1.0]);
        let change = SecondOrder.change(&Signals::new(trajectory, coefficients), &[1.0], &mut no_draw()).scalar_nt;
        assert!(change.iter().all(|nt| (nt - 10.0).abs() < 0.01), "{}", change[0]);
    }
}
