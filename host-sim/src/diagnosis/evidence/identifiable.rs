//! How much of an effect the refit of the 18 terms and the background leaves on a recording.

use crate::diagnosis::findings::Findings;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::selection::Selection;

/// Share of the whitened power of the effect that survives, for its values in the fit or for typical ones. `None` for
/// what has no signature.
pub(crate) fn fraction(found: &Findings<'_>, name: &str) -> Option<f64> {
    let index = found.library.iter().position(|effect| effect.spec().name == name)?;
    let spec = found.library[index].spec();
    let selection = &found.channel(spec.channel).selection;
    if spec.random {
        // Added noise is in no span: what the background takes is all that goes.
        return Some(selection.problem.whitening.dof() / selection.problem.whitening.samples().max(1) as f64);
    }
    let before = Whitening::without_background(&selection.problem.whitening);
    let shares = columns_of(selection, index).into_iter().filter_map(|column| surviving(selection, &before, &column));
    let (count, sum) = shares.fold((0.0, 0.0), |(count, sum), share| (count + 1.0, sum + share));
    (count > 0.0).then(|| sum / count)
}

/// Share of the whitened power of a column that background and 18 terms leave; none of a column without power.
fn surviving(selection: &Selection<'_>, before: &Whitening, column: &[f64]) -> Option<f64> {
    let mean = column.iter().sum::<f64>() / column.len().max(1) as f64;
    let centred: Vec<f64> = column.iter().map(|x| x - mean).collect();
    let whole = before.apply(&centred);
    let power = dot(&whole, &whole);
    let mut projected = selection.problem.whitening.apply(column);
    selection.before.projection.project_out(&mut projected);
    (power > 0.0).then(|| (dot(&projected, &projected) / power).min(1.0))
}

fn columns_of(selection: &Selection<'_>, index: usize) -> Vec<Vec<f64>> {
    let problem = &selection.problem;
    if let Some(at) = selection.fit.terms.iter().position(|term| term.effect == index) {
        return vec![selection.fit.columns[at].clone()];
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
