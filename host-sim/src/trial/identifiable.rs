//! How well an effect could be found on a recording, were all but its presence known: the root of twice the log likelihood
//! ratio of the true effect. The axis on which a diagnosis can be judged.

use nalgebra::{DMatrix, DVector};

use super::size::difference_nt;
use super::slow::{basis, without};
use super::world::effects::{Channel, Effect, Parameters};
use super::world::{Draw, Noise, World, terms};

/// Added to each squared length, so that terms that say the same do no harm.
const RIDGE: f64 = 1e-10;

/// Of a hidden effect.
pub(super) fn identifiable(world: &World, effect: &Effect, parameters: &Parameters, draws: &impl Fn() -> Draw) -> f64 {
    let difference_nt = || difference_nt(world, effect, parameters, draws);
    match effect.name {
        "sample_jitter" => {
            // Early and late by as much: what the error makes of the slope.
            let late = [("lag_s".to_string(), parameters["sigma_s"])].into();
            let lag = super::world::effects::named("scalar_lag").expect("an effect of the trial");
            let slope_nt = super::size::difference_nt(world, lag, &late, draws);
            of_variance(&world.noise, &slope_nt.iter().map(|nt| nt * nt).collect::<Vec<f64>>())
        }
        "dead_zone" => {
            let variance = parameters["noise_nT"].powi(2);
            let inside: Vec<f64> = difference_nt().iter().map(|&nt| if nt == 0.0 { 0.0 } else { variance }).collect();
            of_variance(&world.noise, &inside)
        }
        "fluxgate_quantisation" => {
            let variance = parameters["step_nT"].powi(2) / 12.0;
            of_variance(&Noise::white(world.flux_noise_nt), &vec![variance; world.rows()])
        }
        "stale_sample" => of_repeats(&world.noise, &difference_nt(), parameters["probability"]),
        _ => of_change(world, effect.channel, &difference_nt()),
    }
}

/// Of a change that is known: its length, whitened, beside the 18 terms and the background.
pub(super) fn of_change(world: &World, channel: Channel, change_nt: &[f64]) -> f64 {
    match channel {
        Channel::Fluxgate => {
            let noise_nt = world.flux_noise_nt.hypot(world.noise.band_rms_nt());
            length(&without(change_nt)) / noise_nt
        }
        Channel::Scalar => {
            let mut columns = term_columns(world);
            columns.extend(basis(change_nt.len()).into_iter().map(|(start, values)| {
                let mut column = vec![0.0; change_nt.len()];
                column[start..start + values.len()].copy_from_slice(&values);
                column
            }));
            let columns: Vec<Vec<f64>> = columns.iter().map(|column| unit(world.noise.whitened(column))).collect();
            length(&beside(&world.noise.whitened(&without(change_nt)), &columns))
        }
    }
}

/// The 18 terms at the rows, without their slow part.
pub(super) fn term_columns(world: &World) -> Vec<Vec<f64>> {
    let rows: Vec<[f64; 18]> =
        world.directions().iter().zip(world.rates()).map(|(&direction, rate)| terms(direction, rate)).collect();
    (0..18).map(|k| without(&rows.iter().map(|row| row[k]).collect::<Vec<f64>>())).collect()
}

/// What of a series no column takes; the columns have unit length.
pub(super) fn beside(series: &[f64], columns: &[Vec<f64>]) -> Vec<f64> {
    let all = DMatrix::from_fn(series.len(), columns.len(), |row, column| columns[column][row]);
    let series = DVector::from_column_slice(series);
    let mut gram = all.tr_mul(&all);
    (0..columns.len()).for_each(|k| gram[(k, k)] += RIDGE);
    let Some(factor) = gram.cholesky() else { return vec![0.0; series.len()] };
    let taken = factor.solve(&all.tr_mul(&series));
    (series - all * taken).as_slice().to_vec()
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

fn length(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

pub(super) fn unit(values: Vec<f64>) -> Vec<f64> {
    let length = length(&values).max(1e-300);
    values.into_iter().map(|value| value / length).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_no_column_takes_counts() {
        let columns = [vec![1.0, 0.0, 0.0], vec![0.6, 0.8, 0.0]];
        assert!((length(&beside(&[3.0, 4.0, 5.0], &columns)) - 5.0).abs() < 1e-6);
    }

    #[test]
    fn known_growth_of_white_noise_is_the_sum_over_the_rows() {
        let strength = of_variance(&Noise::white(1.0), &[1.0; 100]);
        let innovation = Noise::white(1.0).innovation_nt.powi(2);
        let exact = (100.0 * (1.0 / innovation - (1.0 + 1.0 / innovation).ln())).sqrt();
        assert!((strength - exact).abs() < 1e-9);
    }
}
