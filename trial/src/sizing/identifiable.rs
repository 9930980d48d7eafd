//! How well an effect could be found on a recording, were all but its presence known: the root of twice the log likelihood
//! ratio of the true effect. The axis on which a diagnosis can be judged.

use super::background::{basis, without_background};
use super::difference::difference_nt;
use super::projection::{Column, beside, length, term_columns};
use crate::random::Random;
use crate::world::effects::{self, Channel, Effect, Parameters};
use crate::world::{Noise, World};

/// Of a hidden effect.
pub(super) fn identifiable(
    world: &World,
    effect: &Effect,
    parameters: &Parameters,
    draws: &impl Fn() -> Random,
) -> f64 {
    let own_nt = || difference_nt(world, effect, parameters, draws);
    match effect.name {
        "sample_jitter" => {
            // Early and late by as much: what the error makes of the slope.
            let late = [("lag_s".to_string(), parameters["sigma_s"])].into();
            let lag = effects::named("scalar_lag", &[]).expect("an effect of the trial");
            let slope_nt = difference_nt(world, lag, &late, draws);
            of_variance(&world.noise, &slope_nt.iter().map(|nt| nt * nt).collect::<Vec<f64>>())
        }
        "dead_zone" => {
            let variance = parameters["noise_nT"].powi(2);
            let inside: Vec<f64> = own_nt().iter().map(|&nt| if nt == 0.0 { 0.0 } else { variance }).collect();
            of_variance(&world.noise, &inside)
        }
        "fluxgate_quantisation" => {
            let variance = parameters["step_nT"].powi(2) / 12.0;
            of_variance(&Noise::white(world.flux_noise_nt), &vec![variance; world.rows()])
        }
        "stale_sample" => of_repeats(&world.noise, &own_nt(), parameters["probability"]),
        _ => of_change(world, effect.channel, &own_nt()),
    }
}

/// Of a change that is known: its length, whitened, beside the 18 terms and the background.
pub(super) fn of_change(world: &World, channel: Channel, change_nt: &[f64]) -> f64 {
    match channel {
        Channel::Fluxgate => {
            let noise_nt = world.flux_noise_nt.hypot(world.noise.band_rms_nt());
            length(&without_background(change_nt)) / noise_nt
        }
        Channel::Scalar => {
            let terms = term_columns(world).into_iter().map(|term| (0, term));
            let white = |(start, mut values): (usize, Vec<f64>)| {
                // As far as the filter smears a block.
                values.resize((values.len() + world.noise.whitening.len()).min(change_nt.len() - start), 0.0);
                Column::unit(start, world.noise.whitened(&values))
            };
            let columns: Vec<Column> = terms.chain(basis(change_nt.len())).map(white).collect();
            length(&beside(&world.noise.whitened(&without_background(change_nt)), &columns))
        }
    }
}

/// Of noise that grows by a known variance at each row.
fn of_variance(noise: &Noise, added: &[f64]) -> f64 {
    let innovation = noise.innovation_nt * noise.innovation_nt;
    let grown = |row: usize| -> f64 {
        let reach = noise.whitening.iter().enumerate().take(row + 1);
        reach.map(|(k, weight)| weight * weight * added[row - k]).sum::<f64>() / innovation
    };
    (0..added.len()).map(grown).map(|grown| grown - grown.ln_1p()).sum::<f64>().max(0.0).sqrt()
}

/// Of repeats: each row is a reading or, with a known probability, an exact repeat.
fn of_repeats(noise: &Noise, difference_nt: &[f64], probability: f64) -> f64 {
    let gain = |&nt: &f64| {
        let off = nt / noise.innovation_nt;
        let is_repeat = nt != 0.0;
        // A repeat is as far off as the reading has moved on; any other row speaks against it a little.
        if is_repeat { (0.5 * off * off + probability.ln()).max(0.0) } else { (1.0 - probability).ln() }
    };
    (2.0 * difference_nt.iter().map(gain).sum::<f64>()).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_growth_of_white_noise_is_the_sum_over_the_rows() {
        let strength = of_variance(&Noise::white(1.0), &[1.0; 100]);
        let innovation = Noise::white(1.0).innovation_nt.powi(2);
        let exact = (100.0 * (1.0 / innovation - (1.0 + 1.0 / innovation).ln())).sqrt();
        assert!((strength - exact).abs() < 1e-9);
    }
}
