//! What a planned tow can tell, as `plan.json` and on a terminal.

use serde::Serialize;

use super::diagnosis::{list, spec};
use super::manoeuvre;
use super::number::three_digits;
use crate::diagnosis::{Alike, NextManoeuvre, PLANNED_STRENGTH, Plan, PlannedEffect, Segment, Separated};
use crate::effects::Spec;
use crate::summary::to_json;

/// Version of the format.
const SCHEMA: u32 = 1;

/// Names of other effects in a row of the table at most.
const MOST_ALIKE: usize = 3;

#[derive(Serialize)]
struct File<'a> {
    schema: u32,
    minutes: f64,
    #[serde(rename = "noise_nT")]
    noise_nt: Option<f64>,
    effects: Vec<Effect<'a>>,
    segments: Vec<SegmentOut<'a>>,
}

#[derive(Serialize)]
struct Effect<'a> {
    name: &'a str,
    channel: &'a str,
    /// Strengths are rms over that of the noise.
    found_from_strength: Option<f64>,
    at_strength_1: Vec<Value<'a>>,
    taken_for: Vec<TakenFor<'a>>,
}

#[derive(Serialize)]
struct Value<'a> {
    name: &'a str,
    value: f64,
}

#[derive(Serialize)]
struct TakenFor<'a> {
    name: &'a str,
    told_apart_from_strength: Option<f64>,
}

#[derive(Serialize)]
struct SegmentOut<'a> {
    separates: Vec<Pair<'a>>,
    text: String,
    minutes: f64,
}

#[derive(Serialize)]
struct Pair<'a> {
    names: [&'a str; 2],
    told_apart_from_strength: f64,
}

/// The text of the file, with a newline at its end.
pub fn json(plan: &Plan) -> String {
    to_json(&File {
        schema: SCHEMA,
        minutes: plan.minutes,
        noise_nt: plan.noise_nt,
        effects: plan.effects.iter().map(effect).collect(),
        segments: plan.segments.iter().map(segment).collect(),
    })
}

fn effect(planned: &PlannedEffect) -> Effect<'_> {
    let taken_for = |alike: &Alike| TakenFor { name: alike.name, told_apart_from_strength: alike.apart_from };
    Effect {
        name: planned.name,
        channel: planned.channel,
        found_from_strength: planned.found_from,
        at_strength_1: planned.at_strength_1.iter().map(|&(name, value)| Value { name, value }).collect(),
        taken_for: planned.alike.iter().map(taken_for).collect(),
    }
}

fn segment(segment: &Segment) -> SegmentOut<'_> {
    let pair = |pair: &Separated| Pair { names: pair.names, told_apart_from_strength: pair.apart_from };
    SegmentOut {
        separates: segment.separates.iter().map(pair).collect(),
        text: advice(segment),
        minutes: segment.minutes,
    }
}

/// What to sail, in sentences.
fn advice(segment: &Segment) -> String {
    let Segment { kind, minutes, .. } = *segment;
    manoeuvre::next(&NextManoeuvre { separates: Vec::new(), kind, repeats_event: false, is_enough: true, minutes })
}

/// The whole text, with a newline at the end: what to add first, then a row an effect.
pub fn text(plan: &Plan) -> String {
    let specs = &plan.specs;
    let noise = plan.noise_nt.map_or("not known".into(), |nt| format!("{} nT rms", three_digits(nt)));
    let mut lines = vec![
        format!("Planned: {} minutes; noise of the scalar {noise}.", three_digits(plan.minutes)),
        answer(plan),
        String::new(),
    ];
    for segment in &plan.segments {
        lines.push(format!("Add {} minutes: {}", three_digits(segment.minutes), advice(segment)));
        lines.extend(segment.separates.iter().map(|pair| {
            format!("  tells apart from strength {}: {}", three_digits(pair.apart_from), list(specs, &pair.names))
        }));
        lines.push(String::new());
    }
    lines.extend(table(plan));
    lines.push(
        "Strength: rms of what an effect adds beside the slow background, over that of the noise. Effects that are"
            .into(),
    );
    lines.push("random from row to row are not in the table.".into());
    lines.join("\n") + "\n"
}

fn answer(plan: &Plan) -> String {
    match plan.segments.iter().map(|segment| segment.separates.len()).sum::<usize>() {
        0 => format!("What it finds at strength {PLANNED_STRENGTH:.0} it tells apart; nothing need be added."),
        1 => format!("At strength {PLANNED_STRENGTH:.0} it finds two effects that it can't tell apart."),
        pairs => {
            format!("At strength {PLANNED_STRENGTH:.0} there are {pairs} pairs of effects that it can't tell apart.")
        }
    }
}

fn table(plan: &Plan) -> Vec<String> {
    let heading = row("effect", "at strength 1", "found from", "until then, may be taken for");
    let rows = plan.effects.iter().map(|effect| {
        let sizes: Vec<String> =
            effect.at_strength_1.iter().filter(|value| is_size(&plan.specs, effect.name, value.0)).map(size).collect();
        let found = effect.found_from.map_or("not".into(), three_digits);
        let told: Vec<String> = effect.alike.iter().take(MOST_ALIKE).map(taken_for).collect();
        row(effect.name, &sizes.join(" "), &found, &told.join(", "))
    });
    std::iter::once(heading).chain(rows).chain([String::new()]).collect()
}

fn row(name: &str, size: &str, found: &str, alike: &str) -> String {
    format!("{name:<28}{size:<44}{found:>10}  {alike}").trim_end().into()
}

/// Whether a parameter of an effect says how large it is, and not where, when or how.
fn is_size(specs: &[&Spec], effect: &str, name: &str) -> bool {
    spec(specs, effect).is_none_or(|spec| {
        let linear = spec.linear_parameters();
        linear.is_empty() || linear.iter().any(|&index| spec.parameters[index].name == name)
    })
}

fn size(&(name, value): &(&'static str, f64)) -> String {
    format!("{name}={}", three_digits(value))
}

fn taken_for(alike: &Alike) -> String {
    match alike.apart_from {
        Some(strength) => format!("{} to {}", alike.name, three_digits(strength)),
        None => format!("{} always", alike.name),
    }
}
