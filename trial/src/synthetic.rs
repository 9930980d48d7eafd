//! Recordings that are made: drawing what one hides, and making it.

use rand::RngExt;

use crate::answer::{Answer, Hidden, Kind};
use crate::options::TrialOptions;
use crate::random::{self, Random};
use crate::sizing::{sized, sized_mechanism};
use crate::strength::STRENGTHS;
use crate::world::effects::{self, Effect};
use crate::world::target::{self, Dipole};
use crate::world::{self, Change, Last, Recorder, World, foreign};

/// How far about, either way.
const ABOUT: f64 = 0.2;
/// Worlds until one has what an effect needs to reach its strength.
const WORLDS: u32 = 10;
/// Parameters that are tried in each.
const TRIES: usize = 4;
/// Share of the recordings with targets.
const WITH_TARGETS: f64 = 2.0 / 3.0;
/// Effects until one is reached.
const EFFECTS: usize = 12;

/// What a stream of chance is for. The recording and its world come before it.
#[derive(Clone, Copy)]
enum For {
    Answer,
    World,
    Motion,
    /// A second motion, which the diagnosis has not seen.
    OtherMotion,
    Noise,
    OtherNoise,
    Columns,
    Recorder,
    Effect(usize),
    Targets,
    /// Those on the second course.
    OtherTargets,
}

/// Random the answer to a recording.
pub(crate) fn answer(options: &TrialOptions, index: usize) -> Answer {
    let mut draw = stream(options, index, 0, For::Answer);
    let kind = match draw.random::<f64>() {
        p if p < 0.30 => Kind::None,
        p if p < 0.75 => Kind::Single,
        p if p < 0.90 => Kind::Pair,
        _ => Kind::Foreign,
    };
    let mut number = 0;
    for _ in 0..EFFECTS {
        let chosen = chosen(kind, options.withhold.as_deref(), &mut draw);
        let strength = level(kind, &mut draw);
        let aims: Vec<f64> = chosen.iter().map(|_| strength * about(&mut draw)).collect();
        for _ in 0..WORLDS {
            let world = world(options, index, number);
            let hidden = match kind {
                Kind::Foreign => {
                    mechanism(options, index, number, &world, strength, &mut draw).map(|hidden| vec![hidden])
                }
                _ => hide(options, index, number, &world, &chosen, &aims, &mut draw),
            };
            if let Some(hidden) = hidden {
                return describe(options, index, kind, &world, number, hidden);
            }
            number += 1;
        }
    }
    // Nothing reaches its strength in so short a recording.
    describe(options, index, Kind::None, &world(options, index, number), number, Vec::new())
}

/// The recording of an answer, as CSV.
pub(crate) fn recording(options: &TrialOptions, answer: &Answer) -> String {
    let world = world(options, answer.index, answer.world);
    written(options, answer, world, [For::Targets, For::Noise])
}

/// Another one of the same body with the same hidden effects, at the same place, on another course.
pub(crate) fn other_recording(options: &TrialOptions, answer: &Answer) -> String {
    let (index, number) = (answer.index, answer.world);
    let mut draw = stream(options, index, number, For::World);
    let world = World::draw(rows(options), &mut draw, &mut stream(options, index, number, For::OtherMotion));
    written(options, answer, world, [For::OtherTargets, For::OtherNoise])
}

fn written(options: &TrialOptions, answer: &Answer, world: World, [course, noise]: [For; 2]) -> String {
    let of = |purpose: For| stream(options, answer.index, answer.world, purpose);
    let recorder = recorder(options, answer.index, answer.world, &world);
    let (mut changes, mut last): (Vec<Change>, Vec<(Last, Random)>) = (Vec::new(), Vec::new());
    // A mechanism is as large as it was made: without the targets.
    for (slot, hidden) in answer.hidden.iter().enumerate() {
        if let Some(mechanism) = foreign::named(&hidden.name) {
            changes.push((mechanism.change)(&world, &mut of(For::Effect(slot))).times(hidden.parameters["size_nT"]));
        }
    }
    let dipoles = dipoles(options, answer.index, answer.world, &world, course);
    let world = world.with_targets(&dipoles);
    for (slot, hidden) in answer.hidden.iter().enumerate() {
        let draw = || of(For::Effect(slot));
        if let Some(effect) = effects::named(&hidden.name) {
            changes.push(effect.change(&world, &hidden.parameters, &mut draw()));
            last.extend(effect.last(&hidden.parameters).map(|last| (last, draw())));
        }
    }
    let readings = world.record(&changes, last, &mut of(noise));
    world::csv(&world, &readings, &recorder, &mut of(For::Columns))
}

/// The targets of a course, if the recording has any.
fn dipoles(options: &TrialOptions, index: usize, number: u32, world: &World, course: For) -> Vec<Dipole> {
    let is_drawn = stream(options, index, number, For::Targets).random_bool(WITH_TARGETS);
    let mut draw = stream(options, index, number, course);
    _ = draw.random_bool(WITH_TARGETS);
    if options.targets.unwrap_or(is_drawn) { target::draw(world, &mut draw) } else { Vec::new() }
}

fn recorder(options: &TrialOptions, index: usize, number: u32, world: &World) -> Recorder {
    Recorder::draw(options.recorder, world, &mut stream(options, index, number, For::Recorder))
}

fn rows(options: &TrialOptions) -> usize {
    (600.0 * options.minutes).round() as usize
}

fn world(options: &TrialOptions, index: usize, number: u32) -> World {
    let of = |purpose: For| stream(options, index, number, purpose);
    World::draw(rows(options), &mut of(For::World), &mut of(For::Motion))
}

fn stream(options: &TrialOptions, index: usize, world: u32, purpose: For) -> Random {
    let purpose = match purpose {
        For::Answer => 0,
        For::World => 1,
        For::Motion => 2,
        For::OtherMotion => 3,
        For::Noise => 4,
        For::OtherNoise => 5,
        For::Columns => 6,
        For::Recorder => 7,
        For::Effect(slot) => 8 + slot as u64,
        For::Targets => 32,
        For::OtherTargets => 33,
    };
    random::stream(options.seed, ((index as u64) << 24) | (u64::from(world) << 8) | purpose)
}

fn describe(
    options: &TrialOptions,
    index: usize,
    kind: Kind,
    world: &World,
    number: u32,
    hidden: Vec<Hidden>,
) -> Answer {
    Answer {
        index,
        kind,
        motion: world.motion().into(),
        noise: world.noise.colour.into(),
        noise_rms_nt: world.noise.band_rms_nt(),
        fluxgate_noise_rms_nt: world.flux_noise_nt,
        recorder: recorder(options, index, number, world).kind.to_string(),
        world: number,
        hidden,
        targets: dipoles(options, index, number, world, For::Targets).iter().map(|dipole| dipole.seen).collect(),
    }
}

/// The effects to hide: all are equally likely.
fn chosen(kind: Kind, withheld: Option<&str>, draw: &mut Random) -> Vec<&'static Effect> {
    let all: Vec<&Effect> = effects::all().collect();
    let first = draw.random_range(0..all.len());
    let second = (first + draw.random_range(1..all.len())) % all.len();
    match (kind, withheld.and_then(effects::named)) {
        (Kind::Single, Some(withheld)) => vec![withheld],
        (Kind::Single, None) => vec![all[first]],
        (Kind::Pair, _) => vec![all[first], all[second]],
        (Kind::None | Kind::Foreign, _) => Vec::new(),
    }
}

fn level(kind: Kind, draw: &mut Random) -> f64 {
    let strengths = if kind == Kind::Pair { &STRENGTHS[..2] } else { &STRENGTHS };
    strengths[draw.random_range(0..strengths.len())]
}

fn about(draw: &mut Random) -> f64 {
    (1.0 - ABOUT) * libm::pow((1.0 + ABOUT) / (1.0 - ABOUT), draw.random::<f64>())
}

/// All the effects with the strengths asked for, if this world allows.
fn hide(
    options: &TrialOptions,
    index: usize,
    number: u32,
    world: &World,
    chosen: &[&Effect],
    aims: &[f64],
    draw: &mut Random,
) -> Option<Vec<Hidden>> {
    let one = |(slot, (effect, aim)): (usize, (&&Effect, &f64))| {
        let draws = || stream(options, index, number, For::Effect(slot));
        (0..TRIES).find_map(|_| sized(world, effect, (effect.draw)(world, draw)?, *aim, 1.0, draws))
    };
    chosen.iter().zip(aims).enumerate().map(one).collect()
}

fn mechanism(
    options: &TrialOptions,
    index: usize,
    number: u32,
    world: &World,
    aim: f64,
    draw: &mut Random,
) -> Option<Hidden> {
    let all = foreign::all(options.setting);
    let mechanism = all[draw.random_range(0..all.len())];
    sized_mechanism(world, mechanism, aim, || stream(options, index, number, For::Effect(0)))
}
