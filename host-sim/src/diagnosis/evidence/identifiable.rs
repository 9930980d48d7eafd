//! How much of an effect the refit of the 18 terms and the background leaves on a recording.

use crate::diagnosis::diagnose::Found;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::regression::term::{Term, is_timing, regressors};
use crate::diagnosis::selection::Analysis;
use crate::effects::Channel;

/// Share of the whitened power of the effect that survives, for its values in the fit or for typical ones. `None` for
/// what has no signature.
pub(crate) fn fraction(found: &Found<'_>, name: &str) -> Option<f64> {
    let index = found.library.iter().position(|effect| effect.spec().name == name)?;
    let spec = found.library[index].spec();
    let analysis = if spec.channel == Channel::Scalar { &found.scalar } else { &found.fluxgate };
    if spec.random {
        // Added noise is in no span: what the background takes is all that goes.
        return Some(analysis.problem.whitening.dof() / analysis.problem.whitening.samples().max(1) as f64);
    }
    let columns = columns_of(analysis, index, name);
    let before = Whitening::without_background(&analysis.problem.whitening);
    let (mut whole, mut left) = (0.0, 0.0);
    for column in &columns {
        let mean = column.iter().sum::<f64>() / column.len().max(1) as f64;
        let centred: Vec<f64> = column.iter().map(|x| x - mean).collect();
        let power = before.apply(&centred);
        let power = dot(&power, &power);
        if power > 0.0 {
            let mut projected = analysis.problem.whitening.apply(column);
            analysis.before.projection.project_out(&mut projected);
            whole += 1.0;
            left += (dot(&projected, &projected) / power).min(1.0);
        }
    }
    (whole > 0.0).then(|| left / whole)
}

fn columns_of(analysis: &Analysis<'_>, index: usize, name: &str) -> Vec<Vec<f64>> {
    let problem = &analysis.problem;
    if let Some(at) = analysis.fit.terms.iter().position(|term| term.effect == index) {
        return vec![analysis.fit.columns[at].clone()];
    }
    let middle_s = problem.signals.recording_time_s(problem.signals.len() / 2);
    let at = match name {
        "scalar_lag" | "averaging_window" | "scalar_lowpass" | "eddy_lag" => vec![0.05],
        "clock_drift" => vec![20.0],
        "sample_slip" => vec![middle_s, 1.0],
        "permanent_step" => vec![middle_s, 0.0, 0.0, 0.0],
        "mains_alias" => vec![1.0, 0.0, 0.0],
        "load_current" => vec![0.0, 0.0, 0.0, 10.0, 0.3, 0.0],
        _ => vec![0.0; problem.library[index].spec().parameters.len()],
    };
    if is_timing(name) {
        let term = Term { effect: index, at, coordinates: Vec::new() };
        return vec![term.column(problem.library, &problem.signals)];
    }
    regressors(&*problem.library[index], &problem.signals, &at)
}
