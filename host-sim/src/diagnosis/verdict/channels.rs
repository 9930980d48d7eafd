//! Both channels: how large the gap is, where it lies, and what is drawn of it.

use crate::diagnosis::diagnose::Found;
use crate::diagnosis::evidence::localise::{CellExcess, cells, channel_name};
use crate::diagnosis::noise::spectrum::{self, welch};
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::result::{ChannelGap, EffectFound, Gap, Pictures};
use crate::diagnosis::verdict::Side;

pub(crate) fn channel_gap(side: &Side<'_, '_>) -> ChannelGap {
    let analysis = side.analysis;
    ChannelGap {
        channel: channel_name(analysis.problem.channel),
        residual_rms_nT: rms_nt(&analysis.problem, &analysis.before),
        residual_after_rms_nT: rms_nt(&analysis.problem, &analysis.fit),
        noise_floor_rms_nT: analysis.spectrum.as_ref().map_or(0.0, spectrum::NoiseSpectrum::std_nt),
    }
}

/// Rms of the residual of a fit with the background of each block taken out, nT.
fn rms_nt(problem: &RegressionProblem<'_>, fit: &Fit) -> f64 {
    let projected = projected_nt(problem, fit);
    (dot(&projected, &projected) / projected.len().max(1) as f64).sqrt()
}

fn projected_nt(problem: &RegressionProblem<'_>, fit: &Fit) -> Vec<f64> {
    Whitening::new(problem.whitening.blocks(), Predictor::white(1.0), None).apply(&problem.residual_nt(fit))
}

pub(crate) fn gap(sides: &[Side<'_, '_>], effects: &[EffectFound], channels: &[ChannelGap]) -> Gap {
    let over = |side: &Side<'_, '_>| {
        let squares = dot(&side.analysis.before.residual_whitened, &side.analysis.before.residual_whitened)
            / side.analysis.variance;
        squares - side.analysis.problem.whitening.dof()
    };
    let largest = if over(&sides[1]) > over(&sides[0]) { 1 } else { 0 };
    let channel = &channels[largest];
    let excess = (channel.residual_rms_nT.powi(2) - channel.noise_floor_rms_nT.powi(2)).max(0.0).sqrt();
    let log_p = sides.iter().map(strongest).fold(0.0, f64::min);
    let exact = effects.iter().any(|effect| effect.name == "stale_sample" || effect.name == "fluxgate_quantisation");
    Gap {
        residual_rms_nT: channel.residual_rms_nT,
        noise_floor_rms_nT: channel.noise_floor_rms_nT,
        excess_rms_nT: excess,
        p_value: if exact { 0.0 } else { log_p.exp() },
        channel: channel.channel,
    }
}

/// Logarithm of the smallest chance in a channel, all tries counted.
fn strongest(side: &Side<'_, '_>) -> f64 {
    let named = side.analysis.named.iter().map(|named| named.log_p);
    let scanned = side.analysis.last_scan.iter().map(|(_, _, log_p)| *log_p);
    let tests = side.findings.iter().map(|finding| finding.log_p);
    let least = named.chain(scanned).chain(tests).fold(0.0, f64::min);
    (least + 50.0_f64.ln()).min(0.0)
}

pub(crate) fn cells_of(side: &Side<'_, '_>, found: &Found<'_>) -> Vec<CellExcess> {
    let analysis = side.analysis;
    let weights = analysis.problem.whitening.weights();
    let by_effects = weights.iter().zip(&analysis.noise_weights).map(|(all, noise)| all / noise);
    let whitened: Vec<f64> = analysis
        .before
        .residual_whitened
        .iter()
        .zip(by_effects)
        .map(|(z, weight)| z / weight / analysis.variance.sqrt())
        .collect();
    cells(&analysis.problem, found.table, &whitened)
}

pub(crate) fn pictures(side: &Side<'_, '_>, found: &Found<'_>) -> Pictures {
    let analysis = side.analysis;
    let problem = &analysis.problem;
    let (before, after) = (projected_nt(problem, &analysis.before), projected_nt(problem, &analysis.fit));
    let rows: Vec<usize> = problem.whitening.rows().collect();
    let on_rows = |values: &[f64]| {
        let mut all = vec![0.0; found.table.len()];
        rows.iter().zip(values).for_each(|(row, value)| all[*row] = *value);
        welch(&all, problem.whitening.blocks())
    };
    let noise = analysis.spectrum.as_ref().map_or_else(Vec::new, |spectrum| {
        (1..250).map(|k| [0.02 * f64::from(k), spectrum.at(0.02 * f64::from(k))]).collect()
    });
    Pictures {
        channel: channel_name(problem.channel),
        time_s: rows.iter().map(|&row| found.table.time_s[row]).collect(),
        spectrum_before: on_rows(&before),
        spectrum_after: on_rows(&after),
        spectrum_noise: noise,
        before_nt: before,
        after_nt: after,
        rows,
    }
}
