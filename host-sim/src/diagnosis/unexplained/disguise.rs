//! Whether a proposal is a known effect that was left out, or not named.

use super::left::Left;
use crate::diagnosis::policy::DISGUISED;
use crate::diagnosis::regression::problem::solve;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::term::{Term, regressors};
use crate::effects::Search;

/// The effect whose shape makes most of a course, nT, as the residual shows it; none where none makes nearly all.
pub(super) fn known_effect(course: &[f64], left: &Left<'_>, named: &[&str]) -> Option<usize> {
    let own = left.swept(&[course.to_vec()]).remove(0);
    let size = dot(&own, &own);
    let share = |index: usize| Some((index, solve(&left.swept(&shapes(index, left)?), &own).0 / size));
    let library = left.problem.library;
    let open = (0..library.len()).filter(|&index| {
        let spec = library[index].spec();
        spec.channel == left.problem.channel && !spec.random && !named.contains(&spec.name)
    });
    let best = open.filter_map(share).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (size > 0.0 && best.1 >= DISGUISED).then_some(best.0)
}

/// What an effect may add: its linear parts, or what one parameter half way to its plausible end does. None of one whose moment,
/// period or axis would have to be found first.
fn shapes(index: usize, left: &Left<'_>) -> Option<Vec<Vec<f64>>> {
    let (library, signals) = (left.problem.library, &left.problem.signals);
    let effect = &library[index];
    let spec = effect.spec();
    let at: Vec<f64> = spec.parameters.iter().map(|parameter| 0.5 * parameter.plausible[1]).collect();
    if spec.search == Search::Linear {
        return Some(regressors(&**effect, signals, &at)).filter(|columns| !columns.is_empty());
    }
    let is_plain = spec.parameters.len() == 1 && !spec.is_momentary();
    is_plain.then(|| vec![Term { effect: index, at, coordinates: Vec::new() }.column(library, signals)])
}
