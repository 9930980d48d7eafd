//! The 18 coefficients of a body.

use rand_distr::{Distribution, StandardNormal};
use towmag::filter::{BandPassDesign, BandPassState};
use towmag::model::TERMS;

use super::InterferenceSource;
use crate::effects::Draw;
use crate::simulator::signals::{Signals, Trajectory};

impl InterferenceSource {
    /// The coefficients: given or drawn, scaled to the uncompensated standard deviation if there is one.
    pub(super) fn of_body(&self, world: &Trajectory, draw: &mut Draw) -> [f64; TERMS] {
        let unscaled = self.coefficients.unwrap_or_else(|| drawn(draw));
        let Some(asked_nt) = self.uncompensated_std_nt else { return unscaled };
        let signals = Signals::new(world.clone(), unscaled);
        let found_nt = band_passed_std_nt((0..signals.len()).map(|row| signals.interference(row).total_nt()));
        // A body that never moves has no interference in the band, however strong.
        let scale = if found_nt > 0.0 { asked_nt / found_nt } else { 1.0 };
        unscaled.map(|coefficient| scale * coefficient)
    }
}

/// Terms of the size that a steel-framed body has: tens of nT, parts in a hundred of the field, milliseconds.
fn drawn(draw: &mut Draw) -> [f64; TERMS] {
    let mut gauss = |rms: f64| -> f64 {
        let unit: f64 = StandardNormal.sample(draw);
        rms * unit
    };
    std::array::from_fn(|term| match term {
        0..3 => gauss(50.0),
        3..9 => gauss(0.004),
        _ => gauss(0.003),
    })
}

/// Standard deviation in the band of the published method, 0.1 to 0.9 Hz, by the core's own filter, nT.
pub(crate) fn band_passed_std_nt(values_nt: impl Iterator<Item = f64>) -> f64 {
    let band_pass = BandPassDesign::default().build().expect("the default is a valid design");
    let mut state = None;
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value_nt in values_nt {
        let input = [value_nt as f32];
        let state = state.get_or_insert_with(|| BandPassState::steady(&input));
        let [passed] = band_pass.step(state, &input).map(f64::from);
        (count, sum, squares) = (count + 1.0, sum + passed, squares + passed * passed);
    }
    let mean = sum / count;
    (squares / count - mean * mean).max(0.0).sqrt()
}
