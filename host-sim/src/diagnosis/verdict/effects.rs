//! What was found, as it is told: parameters with intervals, the share of the gap that goes, what else would do.

use rand_chacha::ChaCha8Rng;

use crate::diagnosis::diagnose::Found;
use crate::diagnosis::evidence::accounted;
use crate::diagnosis::evidence::interval::{self, ParameterEstimate, wilson};
use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::evidence::shrink::gap_closed;
use crate::diagnosis::result::EffectFound;
use crate::diagnosis::selection::INDISTINGUISHABLE;
use crate::diagnosis::verdict::Side;

/// Effects that are listed as indistinguishable at most.
const MOST_RIVALS: usize = 5;

pub(crate) fn effects_of(side: &Side<'_, '_>, draw: &mut ChaCha8Rng) -> Vec<EffectFound> {
    let analysis = side.analysis;
    let (problem, fit) = (&analysis.problem, &analysis.fit);
    let mut additive = 0;
    analysis
        .named
        .iter()
        .map(|named| {
            let candidate = &named.candidate;
            let spec = problem.library[candidate.term.effect].spec();
            let (parameters, gap_closed) = if let Some(fitted) = &candidate.variance {
                let parameters = interval::of_random(problem.library, candidate);
                (parameters, accounted::by_variance(analysis, fitted, draw))
            } else {
                let index = additive;
                additive += 1;
                let parameters = interval::of_term(problem, fit, index, analysis.variance, draw);
                (parameters, gap_closed(problem, fit, index, analysis.variance, draw))
            };
            let mut rivals: Vec<(usize, f64)> = named
                .rivals
                .iter()
                .copied()
                .filter(|(_, evidence)| *evidence > named.evidence - INDISTINGUISHABLE)
                .collect();
            rivals.sort_by(|a, b| b.1.total_cmp(&a.1));
            let mut names: Vec<&'static str> =
                rivals.iter().map(|(effect, _)| problem.library[*effect].spec().name).collect();
            names.dedup();
            names.retain(|name| *name != spec.name);
            names.truncate(MOST_RIVALS);
            EffectFound {
                name: spec.name,
                probability: 0.0,
                parameters,
                gap_closed,
                confirmed: None,
                indistinguishable_from: names,
                load: problem.library[candidate.term.effect].load().map(String::from),
                channel: channel_name(problem.channel),
                strength: (candidate.glrt / analysis.variance).max(0.0).sqrt(),
            }
        })
        .collect()
}

pub(crate) fn exact_effects(found: &Found<'_>) -> Vec<EffectFound> {
    let mut effects = Vec::new();
    if let Some((index, repeats)) = &found.repeats {
        let value = repeats.probability;
        let ci95 = Some(wilson(value, repeats.chances as f64));
        effects.push(EffectFound {
            name: found.library[*index].spec().name,
            probability: 0.0,
            parameters: vec![ParameterEstimate {
                name: found.library[*index].spec().parameters[0].name.into(),
                value: Some(value),
                ci95,
            }],
            gap_closed: accounted::by_repeats(repeats),
            confirmed: None,
            indistinguishable_from: Vec::new(),
            load: None,
            channel: "scalar",
            strength: repeats.glrt.sqrt(),
        });
    }
    if let Some((index, grid)) = &found.grid {
        let step = grid.step_nt;
        let error = found.table.flux_resolution_nt * 1e-3 + 1e-6 * step;
        effects.push(EffectFound {
            name: found.library[*index].spec().name,
            probability: 0.0,
            parameters: vec![ParameterEstimate {
                name: found.library[*index].spec().parameters[0].name.into(),
                value: Some(step),
                ci95: Some([step - error, step + error]),
            }],
            gap_closed: accounted::by_grid(grid),
            confirmed: None,
            indistinguishable_from: Vec::new(),
            load: None,
            channel: "fluxgate",
            strength: (found.table.len() as f64).sqrt(),
        });
    }
    effects
}
