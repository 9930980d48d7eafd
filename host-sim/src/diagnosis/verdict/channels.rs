//! Both channels: how large the gap is, where it lies, and the residuals.

use crate::diagnosis::evidence::localise::{CellExcess, cells, channel_name};
use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::noise::spectrum::welch;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::policy::TRIES;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::result::{ChannelGap, ChannelResiduals, Gap, Verdict};
use crate::diagnosis::selection::Selection;

/// Residual without and with effects, and noise, of a channel.
pub(crate) fn channel_gap(channel: &ChannelFindings<'_>, verdict: Verdict) -> ChannelGap {
    let selection = &channel.selection;
    ChannelGap {
        channel: channel_name(selection.problem.channel),
        residual_rms_nT: rms_nt(&selection.problem, &selection.before),
        residual_after_rms_nT: rms_nt(&selection.problem, &selection.fit),
        noise_floor_rms_nT: selection.noise.std_nt().unwrap_or(0.0),
        verdict,
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

/// The gap of the channel that shows more of it.
pub(crate) fn gap(found: &Findings<'_>, channels: &[ChannelGap]) -> Gap {
    let [scalar, fluxgate] = found.channels();
    let channel = &channels[usize::from(excess_of(fluxgate) > excess_of(scalar))];
    let excess_nt2 = channel.residual_rms_nT.powi(2) - channel.noise_floor_rms_nT.powi(2);
    let log_p = found.channels().into_iter().map(strongest).fold(0.0, f64::min);
    Gap {
        residual_rms_nT: channel.residual_rms_nT,
        noise_floor_rms_nT: channel.noise_floor_rms_nT,
        excess_rms_nT: excess_nt2.max(0.0).sqrt(),
        p_value: if found.exact.is_any() { 0.0 } else { log_p.exp() },
        channel: channel.channel,
    }
}

/// Whitened power of a channel without effects beyond what noise has.
fn excess_of(channel: &ChannelFindings<'_>) -> f64 {
    let Selection { before, variance, problem, .. } = &channel.selection;
    before.sse() / variance - problem.whitening.dof()
}

/// Logarithm of the smallest chance in a channel, all tries counted.
fn strongest(channel: &ChannelFindings<'_>) -> f64 {
    let named = channel.selection.accepted.iter().map(|named| named.log_p);
    let scanned = channel.selection.last_scan.iter().map(|scanned| scanned.log_p);
    let tests = channel.tests.iter().map(|finding| finding.log_p);
    let least = named.chain(scanned).chain(tests).fold(0.0, f64::min);
    (least + TRIES.ln()).min(0.0)
}

/// Where the excess of a channel lies. Weights by the noise of the direction stay, those by random effects do not.
pub(crate) fn cells_of(channel: &ChannelFindings<'_>, found: &Findings<'_>) -> Vec<CellExcess> {
    let Selection { problem, noise, before, variance, .. } = &channel.selection;
    let direction = noise.direction_weights();
    let by_effects = problem.whitening.weights().iter().zip(&direction).map(|(all, noise)| all / noise);
    let residual = before.residual_whitened.iter().zip(by_effects);
    let whitened: Vec<f64> = residual.map(|(z, weight)| z / weight / variance.sqrt()).collect();
    cells(problem, found.table, &whitened)
}

/// Series and spectra of a channel.
pub(crate) fn residuals(channel: &ChannelFindings<'_>, found: &Findings<'_>) -> ChannelResiduals {
    let selection = &channel.selection;
    let problem = &selection.problem;
    let (before, after) = (projected_nt(problem, &selection.before), projected_nt(problem, &selection.fit));
    let rows: Vec<usize> = problem.whitening.rows().collect();
    let on_rows = |values: &[f64]| {
        let mut all = vec![0.0; found.table.len()];
        rows.iter().zip(values).for_each(|(row, value)| all[*row] = *value);
        welch(&all, problem.whitening.blocks())
    };
    let noise = selection.noise.spectrum.as_ref().map_or_else(Vec::new, |spectrum| {
        (1..250).map(|k| [0.02 * f64::from(k), spectrum.at(0.02 * f64::from(k))]).collect()
    });
    ChannelResiduals {
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
