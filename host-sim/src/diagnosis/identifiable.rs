//! How much of an effect the refit of the 18 terms and the background leaves on a recording.

use super::diagnose::Found;
use super::select::Analysis;
use super::span::dot;
use super::term::{Term, is_timing, signatures};
use super::whiten::Whitener;
use crate::effects::Channel;

/// Share of the whitened power of the effect that survives, for its values in the fit or for typical ones. `None` for
/// what has no signature.
pub(super) fn fraction(found: &Found<'_>, name: &str) -> Option<f64> {
    let index = found.library.iter().position(|effect| effect.spec().name == name)?;
    let spec = found.library[index].spec();
    let analysis = if spec.channel == Channel::Scalar { &found.scalar } else { &found.fluxgate };
    if spec.random {
        // Added noise is in no span: what the background takes is all that goes.
        return Some(analysis.bench.whitener.freedom() / analysis.bench.whitener.samples().max(1) as f64);
    }
    let columns = columns_of(analysis, index, name);
    let before = Whitener::without_background(&analysis.bench.whitener);
    let (mut whole, mut left) = (0.0, 0.0);
    for column in &columns {
        let mean = column.iter().sum::<f64>() / column.len().max(1) as f64;
        let centred: Vec<f64> = column.iter().map(|x| x - mean).collect();
        let power = before.apply(&centred);
        let power = dot(&power, &power);
        if power > 0.0 {
            let mut swept = analysis.bench.whitener.apply(column);
            analysis.before.span.sweep(&mut swept);
            whole += 1.0;
            left += (dot(&swept, &swept) / power).min(1.0);
        }
    }
    (whole > 0.0).then(|| left / whole)
}

fn columns_of(analysis: &Analysis<'_>, index: usize, name: &str) -> Vec<Vec<f64>> {
    let bench = &analysis.bench;
    if let Some(at) = analysis.fit.terms.iter().position(|term| term.effect == index) {
        return vec![analysis.fit.columns[at].clone()];
    }
    let middle_s = bench.signals.recording_time_s(bench.signals.len() / 2);
    let at = match name {
        "scalar_lag" | "averaging_window" | "scalar_lowpass" | "eddy_lag" => vec![0.05],
        "clock_drift" => vec![20.0],
        "sample_slip" => vec![middle_s, 1.0],
        "permanent_step" => vec![middle_s, 0.0, 0.0, 0.0],
        "mains_alias" => vec![1.0, 0.0, 0.0],
        "load_current" => vec![0.0, 0.0, 0.0, 10.0, 0.3, 0.0],
        _ => vec![0.0; bench.library[index].spec().parameters.len()],
    };
    if is_timing(name) {
        let term = Term { effect: index, at, coordinates: Vec::new() };
        return vec![term.column(bench.library, &bench.signals)];
    }
    signatures(&*bench.library[index], &bench.signals, &at)
}
