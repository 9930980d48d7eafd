//! Mechanisms that are not in the library, for what the diagnosis says of the unknown.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use crate::simulator::SAMPLE_RATE_HZ;
use crate::simulator::effect::Draw;
use crate::simulator::signals::Signals;

/// Their names; none is that of an effect.
pub(super) const NAMES: [&str; 3] = ["telegraph_signal", "wandering_tone", "fin_with_backlash"];

/// One of them at unit size, nT, one value a row.
pub(super) fn change_nt(name: &str, signals: &Signals, draw: &mut Draw) -> Vec<f64> {
    match name {
        "telegraph_signal" => telegraph(signals.len(), draw),
        "wandering_tone" => wandering_tone(signals.len(), draw),
        _ => fin_with_backlash(signals, draw),
    }
}

/// A contact that makes and breaks: two levels, exponential times between, 3 to 20 s in the mean.
fn telegraph(rows: usize, draw: &mut Draw) -> Vec<f64> {
    let chance = 1.0 / (SAMPLE_RATE_HZ * draw.random_range(3.0..20.0));
    let mut level = 1.0;
    (0..rows)
        .map(|_| {
            if draw.random_bool(chance) {
                level = -level;
            }
            level
        })
        .collect()
}

/// A motor whose speed is not governed: a tone of 0.5 to 2.5 Hz that wanders by a tenth of it within a minute.
fn wandering_tone(rows: usize, draw: &mut Draw) -> Vec<f64> {
    let middle_hz: f64 = draw.random_range(0.5..2.5);
    let (mut away_hz, mut cycles) = (0.0, 0.0);
    let keep = 1.0 - 1.0 / (60.0 * SAMPLE_RATE_HZ);
    let step_hz = 0.1 * middle_hz * (1.0 - keep * keep).sqrt();
    (0..rows)
        .map(|_| {
            let normal: f64 = StandardNormal.sample(draw);
            away_hz = keep * away_hz + step_hz * normal;
            cycles += (middle_hz + away_hz) / SAMPLE_RATE_HZ;
            libm::sin(std::f64::consts::TAU * cycles)
        })
        .collect()
}

/// A steel fin with play: it follows the body's attitude only once that has taken up the play, half to one and a half of
/// the attitude's own rms.
fn fin_with_backlash(signals: &Signals, draw: &mut Draw) -> Vec<f64> {
    let axis = draw.random_range(0..3_usize);
    let drive: Vec<f64> = signals.rows().direction.iter().map(|direction| direction[axis]).collect();
    let mean = drive.iter().sum::<f64>() / drive.len().max(1) as f64;
    let rms = (drive.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / drive.len().max(1) as f64).sqrt();
    let play = rms * draw.random_range(0.5..1.5);
    let mut at = drive.first().copied().unwrap_or(0.0);
    drive
        .iter()
        .map(|&x| {
            at = at.clamp(x - play, x + play);
            at - x
        })
        .collect()
}
