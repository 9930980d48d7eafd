//! Whether what is named beside a large rest is more likely a piece of it: one input, in whatever shape, then makes the whole gap likelier
//! than the named effects and the best shapes beside them. A bias of the fluxgate, say, is a drift with the temperature and whatever that
//! leaves; by the direction of the field it is three numbers.

use rayon::prelude::*;

use super::left::Left;
use super::time;
use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::policy::OUTDONE_LEAST_GAIN;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::result::{ChannelGap, Diagnosis, EffectFound, Verdict};
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::inputs;
use crate::diagnosis::shapes::scene::Scene;
use crate::effects::{Channel, Library};

/// The channels in which nothing that is named stands.
pub(crate) fn outdone(found: &Findings<'_>, diagnosis: &Diagnosis) -> Vec<Channel> {
    let own = Library::default();
    let is_outdone = |channel: &&ChannelFindings<'_>| {
        let name = channel_name(channel.selection.problem.channel);
        let is_partly = |gap: &ChannelGap| gap.channel == name && gap.verdict == Verdict::PartlyExplained;
        let named: Vec<&EffectFound> = diagnosis.effects.iter().filter(|effect| effect.channel == name).collect();
        // A column that was recorded is an input itself, and who brings an effect knows more than this program.
        let is_open =
            |effect: &&EffectFound| effect.load.is_none() && effect.column.is_none() && own.spec(effect.name).is_some();
        diagnosis.channels.iter().any(is_partly)
            && named.iter().all(is_open)
            && is_outdone_by_shapes(channel, &named, found)
    };
    let outdone = found.channels().into_iter().filter(is_outdone);
    outdone.map(|channel| channel.selection.problem.channel).collect()
}

fn is_outdone_by_shapes(channel: &ChannelFindings<'_>, named: &[&EffectFound], found: &Findings<'_>) -> bool {
    let names: Vec<&str> = named.iter().map(|effect| effect.name).collect();
    let (beside, alone) = (Left::of(channel, &names), Left::of(channel, &[]));
    if beside.fit.terms.is_empty() {
        return false;
    }
    let best = |left: &Left<'_>| best(left, &Scene::of(&left.problem.signals, found.table));
    best(&alone) > gain_of_named(channel, &beside, &alone) + best(&beside) + OUTDONE_LEAST_GAIN
}

/// Logarithm of how much likelier the best shapes of any input make what is left.
fn best(left: &Left<'_>, scene: &Scene) -> f64 {
    let recorded = inputs::groups(scene, left.problem.channel).into_iter().flatten();
    let groups: Vec<Group> = recorded.chain(time::trends(scene)).collect();
    let gain =
        |group: Group| group.weighed((&left.problem, &left.fit.projection), &left.z, scene).map(|(gain, ..)| gain);
    groups.into_par_iter().filter_map(gain).reduce(|| 0.0, f64::max)
}

/// The same of the effects that are named, by the Bayesian information criterion, the noise's size free as it is with shapes.
fn gain_of_named(channel: &ChannelFindings<'_>, beside: &Left<'_>, alone: &Left<'_>) -> f64 {
    let samples = alone.z.len() as f64;
    let is_named = |effect: usize| beside.fit.terms.iter().any(|term| term.effect == effect);
    let accepted = channel.named_from().accepted.iter().map(|accepted| &accepted.candidate);
    let price = accepted
        .filter(|candidate| is_named(candidate.term.effect))
        .map(|candidate| 0.5 * candidate.dof * samples.ln() + candidate.trials_factor.ln());
    0.5 * samples * (dot(&alone.z, &alone.z) / dot(&beside.z, &beside.z)).ln() - price.sum::<f64>()
}
