//! Both channels: how large the gap is, where it lies, and the residuals.

use crate::diagnosis::evidence::localise::{CellExcess, cells, channel_name};
use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::noise::periodogram::welch;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::rms;
use crate::diagnosis::policy::TRIES;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::result::{ChannelGap, ChannelResiduals, Gap, Verdict};
use crate::diagnosis::search::recorded::RecordedColumn;
use crate::diagnosis::selection::Selection;
use crate::effects::Channel;

/// Residual without and with effects, and noise, of a channel.
pub(crate) fn channel_gap(channel: &ChannelFindings<'_>, verdict: Verdict, residuals: &ChannelResiduals) -> ChannelGap {
    ChannelGap {
        channel: residuals.channel,
        residual_rms_nT: rms(&residuals.before_nt),
        residual_after_rms_nT: rms(&residuals.after_nt),
        verdict,
        noise_floor_rms_nT: channel.selection.noise.std_nt().unwrap_or(0.0),
    }
}

/// Residual without any effect, nT; one a sample.
fn before_nt(selection: &Selection<'_>, columns: &[RecordedColumn]) -> Vec<f64> {
    let mut residual_nt = selection.problem.residual_nt(&selection.before);
    if selection.problem.channel == Channel::Scalar {
        for column in columns {
            residual_nt.iter_mut().zip(&column.column_nt).for_each(|(nt, of_column)| *nt += of_column);
        }
    }
    without_background(&selection.problem, &residual_nt)
}

/// Values at the rows with the background of each block taken out.
fn without_background(problem: &RegressionProblem<'_>, values: &[f64]) -> Vec<f64> {
    Whitening::new(problem.whitening.blocks(), Predictor::white(1.0), None).apply(values)
}

/// The gap of the channel that has one; of two that have, or have not, of the one that shows more of it.
pub(crate) fn gap(found: &Findings<'_>, channels: &[ChannelGap]) -> Gap {
    let channel = &channels[shown(channels, found.channels().map(excess_of))];
    Gap {
        residual_rms_nT: channel.residual_rms_nT,
        noise_floor_rms_nT: channel.noise_floor_rms_nT,
        excess_rms_nT: channel.excess_rms_nt(),
        p_value: if found.exact.is_any() { 0.0 } else { gap_log_p(found).exp() },
        channel: channel.channel,
    }
}

/// Which channel shows the gap: one without may have more power beyond what was expected than one whose gap has little.
fn shown(channels: &[ChannelGap], excess: [f64; 2]) -> usize {
    let rank = |channel: usize| (channels[channel].verdict != Verdict::NoGap, excess[channel]);
    usize::from(rank(1) > rank(0))
}

/// Logarithm of the chance that noise alone shows as much in any of the channels, all tries counted.
pub(crate) fn gap_log_p(found: &Findings<'_>) -> f64 {
    found.channels().into_iter().map(strongest).fold(0.0, f64::min)
}

/// Whitened power of a channel without effects beyond what noise has.
fn excess_of(channel: &ChannelFindings<'_>) -> f64 {
    let Selection { before, variance, problem, .. } = &channel.selection;
    before.sse() / variance - problem.whitening.dof()
}

/// Logarithm of the smallest chance in a channel, all tries counted.
fn strongest(channel: &ChannelFindings<'_>) -> f64 {
    let least = channel.tests.iter().map(|finding| finding.log_p).fold(strongest_effect(channel), f64::min);
    (least + TRIES.ln()).min(0.0)
}

/// Logarithm of the smallest chance of an effect in a channel, of those that were taken and those that were not.
pub(crate) fn strongest_effect(channel: &ChannelFindings<'_>) -> f64 {
    let Selection { accepted, last_scan, .. } = &channel.selection;
    accepted
        .iter()
        .map(|accepted| accepted.log_p)
        .chain(last_scan.iter().map(|scanned| scanned.log_p))
        .fold(0.0, f64::min)
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

/// Series and spectra of a channel, without effects and with what is named; where nothing is, the two are the same.
pub(crate) fn residuals(channel: &ChannelFindings<'_>, verdict: Verdict, found: &Findings<'_>) -> ChannelResiduals {
    let selection = &channel.selection;
    let problem = &selection.problem;
    let before = before_nt(selection, &found.columns);
    let after = match verdict {
        Verdict::NoGap | Verdict::Unknown => before.clone(),
        Verdict::Explained | Verdict::PartlyExplained => {
            // Fitted as without effects: with all that is left as noise, the 18 terms care little for what is loud.
            let beside_rest = channel.beside_rest.as_ref().map(|beside| problem.fit(&beside.fit.terms));
            without_background(problem, &problem.residual_nt(beside_rest.as_ref().unwrap_or(&selection.fit)))
        }
    };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gap_is_that_of_a_channel_whose_verdict_says_so() {
        let of = |verdicts: [Verdict; 2], excess: [f64; 2]| {
            let gap = |channel, verdict| ChannelGap {
                channel,
                verdict,
                residual_rms_nT: 0.0,
                residual_after_rms_nT: 0.0,
                noise_floor_rms_nT: 0.0,
            };
            shown(&[gap("scalar", verdicts[0]), gap("fluxgate", verdicts[1])], excess)
        };
        let (none, some) = (Verdict::NoGap, Verdict::Unknown);
        // The fluxgate has more power than was expected and no gap, the scalar a gap of little power, and the other way about.
        assert_eq!((of([some, none], [-3.0, 40.0]), of([none, some], [40.0, -3.0])), (0, 1));
        assert_eq!((of([some, Verdict::Explained], [5.0, 6.0]), of([some, some], [6.0, 5.0])), (1, 0));
        assert_eq!((of([none, none], [1.0, 2.0]), of([none, none], [2.0, 2.0])), (1, 0));
    }
}
