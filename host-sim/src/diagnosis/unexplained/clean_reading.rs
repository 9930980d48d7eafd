//! The clean reading where the reading itself drives what is left. The 18 terms take a part of such an effect, often the larger one, and the
//! reading that they make is wrong by that: of a delay that follows the reading by tens of nT. So what shapes of the reading explain is
//! taken off, the terms are fitted anew, and the shapes are made of the reading that these make, until nothing is gained.

use rayon::prelude::*;

use super::drivers::is_beyond_chance;
use super::judged::Judged;
use super::left::Left;
use crate::diagnosis::policy::PROPOSAL_LEAST_GAIN;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::shapes::inputs;
use crate::diagnosis::shapes::scene::Scene;
use crate::effects::Channel;

/// Fits at most: what a family closes of a delay that follows the reading has mostly stopped rising after three.
const MOST_ROUNDS: usize = 8;

/// The variables of a recording, with the clean reading beside what that family of the reading's shapes explains which explains most.
pub(super) fn scene(left: &Left<'_>, table: &Prepared) -> Scene {
    let start = Scene::of(&left.problem.signals, table);
    if left.problem.channel == Channel::Fluxgate {
        return start;
    }
    let families = (0..inputs::of_reading(&start).len()).into_par_iter();
    let refitted = families.filter_map(|family| refitted(left, table, &start, family));
    refitted.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(start, |(_, scene)| scene)
}

/// Beside what one family explains, and the gain of that; none where it does not explain more than at the start.
fn refitted(left: &Left<'_>, table: &Prepared, start: &Scene, family: usize) -> Option<(f64, Scene)> {
    let mut own = of_family(left, start, family)?;
    let mut best = None;
    for _ in 0..MOST_ROUNDS {
        let scene = Scene::of(&left.signals_beside(&own.course(best.as_ref().unwrap_or(start))?), table);
        let better = of_family(left, &scene, family).filter(|next| next.gain > own.gain + PROPOSAL_LEAST_GAIN);
        let Some(better) = better else { break };
        (own, best) = (better, Some(scene));
    }
    best.map(|scene| (own.gain, scene))
}

/// A family of the reading's shapes on what is left, if it does more than chance.
fn of_family(left: &Left<'_>, scene: &Scene, family: usize) -> Option<Judged> {
    let group = inputs::of_reading(scene).into_iter().nth(family)?;
    Judged::of(group, left, scene).filter(is_beyond_chance)
}
