//! What was found, as it is told: parameters with intervals, the share of the gap that goes, what else would do.

use rand_chacha::ChaCha8Rng;

use crate::diagnosis::evidence::accounted;
use crate::diagnosis::evidence::interval::{self, ParameterEstimate, TWO_SIGMA, wilson};
use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::evidence::shrink::{GapClosed, gap_closed};
use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::policy::{EPOCH_S, INDISTINGUISHABLE, INFLATION, MOST_RIVALS};
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::result::EffectFound;
use crate::diagnosis::selection::{Accepted, Selection};
use crate::effects::{Effect, Parameter, Search};

/// The effects of a channel, in the order of acceptance.
pub(crate) fn effects_of(channel: &ChannelFindings<'_>, draw: &mut ChaCha8Rng) -> Vec<EffectFound> {
    let selection = channel.named_from();
    let (mut additive, mut random) = (0.., 0..);
    selection
        .accepted
        .iter()
        .map(|accepted| {
            let (parameters, gap_closed) = match &accepted.candidate.variance {
                Some(_) => {
                    let parameters = interval::of_random(selection.problem.library, accepted);
                    (parameters, accounted::by_variance(&selection.whitened(), random.next().unwrap_or_default(), draw))
                }
                None => of_term(channel, additive.next().unwrap_or_default(), draw),
            };
            effect_found(selection, accepted, parameters, gap_closed)
        })
        .collect()
}

/// Parameters and share of the additive term with this index.
fn of_term(channel: &ChannelFindings<'_>, index: usize, draw: &mut ChaCha8Rng) -> (Vec<ParameterEstimate>, GapClosed) {
    let Selection { problem, fit, variance, sensor_variance, .. } = channel.named_from();
    let parameters = interval::of_term(problem, fit, index, (*variance, channel.beside_rest.is_some()), draw);
    (parameters, gap_closed(problem, fit, index, [*variance, *sensor_variance], draw))
}

fn effect_found(
    selection: &Selection<'_>,
    accepted: &Accepted,
    parameters: Vec<ParameterEstimate>,
    gap_closed: GapClosed,
) -> EffectFound {
    let effect = &selection.problem.library[accepted.candidate.term.effect];
    EffectFound {
        name: effect.spec().name,
        probability: 0.0,
        parameters,
        gap_closed,
        confirmed: None,
        indistinguishable_from: alike(&selection.problem, accepted),
        load: effect.load().map(String::from),
        regressor: regressor(&**effect),
        column: None,
        channel: channel_name(selection.problem.channel),
        is_noise_without_edge: accepted.candidate.variance.is_some() && effect.spec().search != Search::Cone,
        strength: (accepted.candidate.glrt / selection.variance).max(0.0).sqrt(),
    }
}

/// The column that a user asked for, of an effect that it drives.
fn regressor(effect: &dyn Effect) -> Option<String> {
    effect.recorded().filter(|recorded| recorded.is_asked).map(|recorded| recorded.column)
}

/// Names of the effects that would do nearly as well, the best first.
fn alike(problem: &RegressionProblem<'_>, accepted: &Accepted) -> Vec<&'static str> {
    let name = |effect: usize| problem.library[effect].spec().name;
    let near = |(_, evidence): &&(usize, f64)| *evidence > accepted.evidence - INDISTINGUISHABLE;
    let mut rivals: Vec<&(usize, f64)> = accepted.rivals.iter().filter(near).collect();
    rivals.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut names: Vec<&'static str> = rivals.into_iter().map(|(effect, _)| name(*effect)).collect();
    names.dedup();
    names.retain(|other| *other != name(accepted.candidate.term.effect));
    names.truncate(MOST_RIVALS);
    names
}

/// The recorded columns that were taken off.
pub(crate) fn column_effects<'b>(found: &'b Findings<'_>) -> impl Iterator<Item = EffectFound> + 'b {
    found.columns.iter().map(|column| {
        let effect = &found.library[column.term.effect];
        let linear = effect.spec().parameters.iter().zip(&column.term.coordinates).zip(&column.half_widths);
        let estimate = |((parameter, &value), half): ((&Parameter, &f64), &f64)| ParameterEstimate {
            name: parameter.name.into(),
            value: Some(value),
            ci95: Some([value - half, value + half]),
        };
        // Of a column that was asked for, the delay, which was tried row by row.
        let delay = effect.spec().parameters.iter().skip(column.term.coordinates.len());
        let delay_s = column.way.delay_s;
        let delay = delay.map(|parameter| estimate(((parameter, &delay_s), &EPOCH_S)));
        EffectFound {
            name: effect.spec().name,
            probability: 0.0,
            parameters: linear.map(estimate).chain(delay).collect(),
            regressor: regressor(&**effect),
            gap_closed: column.closed,
            confirmed: None,
            indistinguishable_from: Vec::new(),
            load: effect.load().map(String::from),
            column: Some(column.way),
            channel: channel_name(effect.spec().channel),
            is_noise_without_edge: false,
            strength: column.strength,
        }
    })
}

/// The effects that need no fit.
pub(crate) fn exact_effects(found: &Findings<'_>) -> Vec<EffectFound> {
    let one = |index: usize, value: f64, ci95: [f64; 2], gap_closed: GapClosed, strength: f64| {
        let spec = found.library[index].spec();
        let name = spec.parameters[0].name.into();
        EffectFound {
            name: spec.name,
            probability: 0.0,
            parameters: vec![ParameterEstimate { name, value: Some(value), ci95: Some(ci95) }],
            gap_closed,
            confirmed: None,
            indistinguishable_from: Vec::new(),
            load: None,
            regressor: None,
            column: None,
            channel: channel_name(spec.channel),
            // What is exact leaves no doubt.
            is_noise_without_edge: false,
            strength,
        }
    };
    let repeats = found.exact.repeats.as_ref().map(|(index, repeats)| {
        let ci95 = wilson(repeats.probability, repeats.chances);
        one(*index, repeats.probability, ci95, accounted::by_repeats(repeats), repeats.glrt.sqrt())
    });
    let multiples = found.exact.multiples.as_ref().map(|(index, grid)| {
        let error_nt = TWO_SIGMA * INFLATION * grid.step_error_nt;
        let ci95 = [grid.step_nt - error_nt, grid.step_nt + error_nt];
        one(*index, grid.step_nt, ci95, accounted::by_grid(grid), (found.table.len() as f64).sqrt())
    });
    repeats.into_iter().chain(multiples).collect()
}
