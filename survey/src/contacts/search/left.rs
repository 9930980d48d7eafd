//! What is left beside the candidates.

use super::{Located, Search};
use crate::contacts::dipole::weighed;
use crate::contacts::noise::Noise;
use crate::contacts::stretch::Stretch;
use crate::contacts::way::Spot;
use crate::contacts::whitening::{Transform, Whitener};

/// Anomalies are followed to so many distances, where they have less than 1e-4 of their peak.
const REACH: f64 = 30.0;

impl Search<'_> {
    /// The anomalies of all candidates, nT a row.
    pub(in crate::contacts) fn anomaly_nt(&self) -> Vec<f64> {
        let mut minus_nt = vec![0.0; self.field_nt.len()];
        self.found.iter().for_each(|located| self.take_off(&mut minus_nt, located, [0.0; 5]));
        minus_nt.iter().map(|nt| -nt).collect()
    }

    /// The stretches without the contacts found so far.
    pub(in crate::contacts) fn left(&self) -> Vec<Stretch> {
        let mut field_nt = self.without_body_nt();
        self.found.iter().for_each(|located| self.take_off(&mut field_nt, located, [0.0; 5]));
        self.stretches.iter().map(|stretch| stretch.with(&field_nt)).collect()
    }

    /// How badly the contacts found describe the field, beside such noise: twice the logarithm of the likelihood with the other sign, but
    /// for a constant. What strong iron leaves on a way that is not the body's is in few rows and far beyond the noise, so it has a heavy
    /// tail (Cauchy's).
    pub(in crate::contacts) fn misfit(&self, noise: &Noise) -> f64 {
        let of = |(left, transform): (Stretch, &Transform)| {
            let whitened = Whitener::new(transform, &noise.spectrum).whitened(&left.values);
            whitened.iter().map(|z| (z * z).ln_1p()).sum::<f64>()
        };
        2.0 * self.left().into_iter().zip(&self.transforms).map(of).sum::<f64>()
    }

    /// The stretches without contacts that are as likely as those found: so what is left has all of the noise.
    pub(super) fn left_as_noise(&self) -> Vec<Stretch> {
        let mut field_nt = self.without_body_nt();
        self.found.iter().for_each(|located| self.take_off(&mut field_nt, located, located.deviation));
        self.stretches.iter().map(|stretch| stretch.with(&field_nt)).collect()
    }

    fn take_off(&self, field_nt: &mut [f64], located: &Located, deviation: [f64; 5]) {
        let dipole = located.fitted.dipole;
        let rows = self.way.rows_about(&dipole, REACH);
        let spots: Vec<Spot> = rows.clone().map(|row| self.way.spot_of_row(row)).collect();
        let columns = dipole.columns(&self.way, &spots);
        let linear_nt: Vec<f64> = (0..spots.len())
            .map(|k| weighed([0, 1, 2].map(|profile: usize| columns[profile][k]), dipole.amplitudes_nt))
            .collect();
        let beyond_nt = dipole.second_order_nt(&self.way, &spots, &linear_nt);
        let sizes: [f64; 5] = std::array::from_fn(|k| deviation[k] + dipole.amplitudes_nt.get(k).unwrap_or(&0.0));
        for (k, row) in rows.enumerate() {
            field_nt[row] -=
                beyond_nt[k] + columns.iter().zip(sizes).map(|(column, size)| column[k] * size).sum::<f64>();
        }
    }

    /// The field without what compensation has wrong.
    fn without_body_nt(&self) -> Vec<f64> {
        self.field_nt.iter().zip(&self.body_nt).map(|(field, body)| field - body).collect()
    }
}
