//! How much of an effect the refit of the 18 terms and the background leaves on a recording.

use crate::diagnosis::diagnose::Found;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::regression::term::{Term, regressors};
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
    let columns = columns_of(analysis, index);
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

fn columns_of(analysis: &Analysis<'_>, index: usize) -> Vec<Vec<f64>> {
    let problem = &analysis.problem;
    if let Some(at) = analysis.fit.terms.iter().position(|term| term.effect == index) {
        return vec![analysis.fit.columns[at].clone()];
    }
    let effect = &problem.library[index];
    let at = effect.typical(&problem.signals);
    let regressors = regressors(&**effect, &problem.signals, &at);
    if regressors.is_empty() {
        let term = Term { effect: index, at, coordinates: Vec::new() };
        return vec![term.column(problem.library, &problem.signals)];
    }
    regressors
}
