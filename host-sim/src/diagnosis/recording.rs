//! A recording as it is diagnosed: what does not change however often it is searched.

use towmag::model::TERMS;

use super::base::{BaseFit, blocks_of, filled};
use super::reconstruct::direction_noise::DirectionNoise;
use super::reconstruct::prepared::Prepared;
use super::reconstruct::reconstruction::Reconstruction;
use super::rounding::Rounding;
use crate::effects::Library;
use crate::simulator::signals::Signals;

/// A recording, and the clean signals that it gives as it was read.
pub(super) struct Recording<'a> {
    pub(super) table: &'a Prepared,
    pub(super) rounding: Rounding,
    pub(super) reconstruction: Reconstruction,
    pub(super) start: Signals,
    pub(super) direction_noise: DirectionNoise,
}

impl<'a> Recording<'a> {
    pub(super) fn of(table: &'a Prepared, coefficients: [f64; TERMS]) -> Self {
        let reconstruction = Reconstruction::of(table);
        let of_field =
            |field_nt: &[f64]| Signals::new(reconstruction.trajectory(table, &table.flux_nt, field_nt), coefficients);
        // The field of the first is what was read, interference and all: that of a loud body is off by as much as shows.
        let first = of_field(&filled(&table.to_explain_nt()));
        let (library, blocks) = (Library::default(), blocks_of(first.epochs_s(), &table.usable));
        let base = BaseFit::of(&library, &first, table, &blocks, &vec![0.0; table.len()]);
        let start = of_field(&base.field_nt);
        let direction_noise = DirectionNoise::of(table, &reconstruction, &start);
        Self { table, rounding: Rounding::of(table), reconstruction, start, direction_noise }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};
    use statrs::statistics::Statistics;

    use super::*;
    use crate::diagnosis::diagnose::simulated::{in_white_noise, recorded};

    #[test]
    fn the_field_is_told_from_the_interference_of_a_loud_body() {
        let table = recorded("land_calibration.toml");
        let recording = Recording::of(&table, [0.0; TERMS]);
        // It is the same all the time but for 0.2 nT, and a constant that no heading tells from interference.
        let (read_nt, field_nt) = (filled(&table.scalar_nt).std_dev(), (&recording.start.rows().field_nt).std_dev());
        assert!(field_nt < 0.02 * read_nt, "{field_nt} nT rms, the reading {read_nt} nT");
    }

    #[test]
    fn a_level_that_one_heading_does_not_tell_is_not_made_up() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let time_s: Vec<f64> = (0..2400).map(|row| 0.1 * f64::from(row)).collect();
        let direction = |s: &f64| [0.4 + 0.01 * (0.9 * s).sin(), 0.01 * (1.1 * s).cos(), 0.9];
        let flux_nt = time_s.iter().map(|s| direction(s).map(|c| 50_000.0 * c + 0.5 * draw())).collect();
        let scalar_nt = time_s.iter().map(|_| 50_000.0 + 20.0 * draw()).collect();
        let table = Prepared { usable: vec![true; 2400], flux_nt, scalar_nt, time_s, ..Prepared::default() };
        let recording = Recording::of(&table, [0.0; TERMS]);
        let off_nt = |field_nt: &[f64]| field_nt.iter().map(|nt| (nt - 50_000.0).abs()).fold(0.0, f64::max);
        let library = Library::default();
        let problem = in_white_noise(&recording, &library);
        let by_fit_nt = off_nt(&problem.residual_nt(&problem.fit(&[])));
        let told_nt = off_nt(&recording.start.rows().field_nt);
        assert!(by_fit_nt > 5_000.0 && told_nt < 1_500.0, "{by_fit_nt} nT off by the fit, {told_nt} nT as told");
    }
}
