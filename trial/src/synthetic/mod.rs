//! Recordings that are made: drawing what one hides, and making it.

mod draft;
mod kinds;

use rand::RngExt;

use crate::answer::{Answer, Hidden, Kind};
use crate::options::TrialOptions;
use crate::random::Random;
use crate::sizing::{sized, sized_mechanism};
use crate::world::effects::{self, Effect};
use crate::world::{self, Change, World, foreign};
use draft::{Draft, For};

/// Worlds until one has what an effect needs to reach its strength.
const WORLDS: u32 = 10;
/// Parameters that are tried in each.
const TRIES: usize = 4;
/// Effects until one is reached.
const EFFECTS: usize = 12;

/// The answer to a recording.
pub(crate) fn answer(options: &TrialOptions, index: usize) -> Answer {
    let mut draft = Draft { options, index, number: 0 };
    let mut draw = draft.stream(For::Answer);
    let own = options.own_effects();
    let drawn = kinds::kind(&mut draw);
    let kind = options.only.unwrap_or(drawn);
    for _ in 0..EFFECTS {
        let chosen = kinds::effects(kind, options.withhold.as_deref(), &own, &mut draw);
        let aims = kinds::aims(kind, &mut draw);
        for _ in 0..WORLDS {
            let world = draft.world(For::Motion);
            let hidden = match kind {
                Kind::Foreign => mechanism(draft, &world, aims[0], &mut draw).map(|hidden| vec![hidden]),
                _ => hide(draft, &world, &chosen, &aims, &mut draw),
            };
            if let Some(hidden) = hidden {
                return describe(draft, kind, &world, hidden);
            }
            draft.number += 1;
        }
    }
    // Nothing reaches its strength in so short a recording.
    describe(draft, Kind::None, &draft.world(For::Motion), Vec::new())
}

/// The recording of an answer, as CSV.
pub(crate) fn recording(options: &TrialOptions, answer: &Answer) -> String {
    written(options, answer, [For::Motion, For::Targets, For::Noise])
}

/// A simulation of its track, without what it hides, as CSV.
pub(crate) fn simulation(options: &TrialOptions, answer: &Answer) -> String {
    let draft = Draft { options, index: answer.index, number: answer.world };
    world::simulation(&draft.world(For::Motion), &mut draft.stream(For::Simulation))
}

/// Another one of the same body with the same hidden effects, at the same place, on another course.
pub(crate) fn other_recording(options: &TrialOptions, answer: &Answer) -> String {
    written(options, answer, [For::OtherMotion, For::OtherTargets, For::OtherNoise])
}

fn written(options: &TrialOptions, answer: &Answer, [motion, course, noise]: [For; 3]) -> String {
    let draft = Draft { options, index: answer.index, number: answer.world };
    let world = draft.world(motion);
    let recorder = draft.recorder(&world);
    let mut changes: Vec<Change> = Vec::new();
    // A mechanism is as large as it was made: without the targets.
    for (slot, hidden) in answer.hidden.iter().enumerate() {
        if let Some(mechanism) = foreign::named(&hidden.name) {
            let change = (mechanism.change)(&world, &mut draft.stream(For::Effect(slot)));
            changes.push(change.times(hidden.parameters["size_nT"]));
        }
    }
    let dipoles = draft.dipoles(&world, course);
    let world = world.with_targets(&dipoles);
    let (of_effects, last) =
        effects::changes(&world, &answer.hidden, &options.own_effects(), |slot| draft.stream(For::Effect(slot)));
    changes.extend(of_effects);
    let readings = world.record(&changes, last, &mut draft.stream(noise));
    world::csv(&world, &readings, &recorder, [For::Columns, For::Tilt].map(|purpose| draft.stream(purpose)))
}

fn describe(draft: Draft<'_>, kind: Kind, world: &World, hidden: Vec<Hidden>) -> Answer {
    Answer {
        index: draft.index,
        kind,
        minutes: draft.minutes(),
        motion: world.motion().into(),
        noise: world.noise.name(),
        noise_rms_nt: world.noise.band_rms_nt(),
        fluxgate_noise_rms_nt: world.flux_noise_nt,
        recorder: draft.recorder(world).kind.to_string(),
        world: draft.number,
        drivers: if let [one] = &hidden[..] { world::drivers::of(world, one) } else { Vec::new() },
        is_random: hidden.iter().any(world::drivers::is_random),
        hidden,
        targets: draft.dipoles(world, For::Targets).iter().map(|dipole| dipole.seen).collect(),
    }
}

/// All the effects with the strengths asked for, if this world allows.
fn hide(draft: Draft<'_>, world: &World, chosen: &[&Effect], aims: &[f64], draw: &mut Random) -> Option<Vec<Hidden>> {
    let one = |(slot, (effect, aim)): (usize, (&&Effect, &f64))| {
        let draws = || draft.stream(For::Effect(slot));
        (0..TRIES).find_map(|_| sized(world, effect, effect.drawn(world, draw)?, *aim, 1.0, draws))
    };
    chosen.iter().zip(aims).enumerate().map(one).collect()
}

fn mechanism(draft: Draft<'_>, world: &World, aim: f64, draw: &mut Random) -> Option<Hidden> {
    let all = foreign::all(draft.options.setting);
    let mechanism = all[draw.random_range(0..all.len())];
    sized_mechanism(world, mechanism, aim, || draft.stream(For::Effect(0)))
}
