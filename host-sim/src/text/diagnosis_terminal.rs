//! A diagnosis on a terminal: the answer first, then what it rests on, in a dozen lines.

use super::diagnosis::{self as words, closed, label, list, percent};
use super::number::three_digits;
use super::{manoeuvre, replay};
use crate::diagnosis::{Diagnosis, EffectFound};
use crate::effects::Spec;

/// The whole text, with a newline at the end.
pub fn text(diagnosis: &Diagnosis) -> String {
    let mut lines = vec![words::sentence(diagnosis), String::new()];
    if !words::is_firmware_mismatch(diagnosis) {
        lines.extend(table(diagnosis));
    }
    diagnosis.effects.iter().for_each(|effect| lines.extend(effect_lines(&diagnosis.specs, effect)));
    lines.extend(diagnosis.unexplained.iter().map(|rest| format!("Left over: {}.", words::unexplained(rest))));
    lines.extend(diagnosis.rounding.iter().map(|found| format!("Recorded: {}.", words::rounding(found))));
    lines.extend(diagnosis.exact_replay.iter().map(|session| format!("Exact replay: {}.", replay::session(session))));
    lines.push(next(diagnosis));
    lines.join("\n") + "\n"
}

fn table(diagnosis: &Diagnosis) -> Vec<String> {
    let has_effects = !diagnosis.effects.is_empty();
    let row = |name: &str, [before, after, noise]: [String; 3]| {
        let after = if has_effects { format!("{after:>14}") } else { String::new() };
        format!("{name:<22}{before:>10}{after}{noise:>8}")
    };
    let figures = diagnosis.channels.iter().map(|gap| {
        let figures = [gap.residual_rms_nT, gap.residual_after_rms_nT, gap.noise_floor_rms_nT];
        row(words::sensor(gap.channel), figures.map(three_digits))
    });
    let heading = row("Residual, nT rms", ["simulated", "with effects", "noise"].map(String::from));
    std::iter::once(heading).chain(figures).chain([String::new()]).collect()
}

fn effect_lines(specs: &[&Spec], effect: &EffectFound) -> Vec<String> {
    let (title, name, probability) = (label(specs, effect.name), effect.name, percent(effect.probability));
    let mut lines = vec![format!("{title} ({name}): probability {probability}")];
    for estimate in &effect.parameters {
        let (name, value) = words::parameter(specs, effect, estimate);
        lines.push(format!("  {name:<16} {value}"));
    }
    if !effect.parameters.is_empty() {
        lines.push(format!("  {:<16} {}", "closes the gap by", closed(&effect.gap_closed)));
    }
    if let Some(on_second) = &effect.confirmed {
        lines.push(format!("  {:<16} {}", "on the second", words::confirmed(on_second)));
    }
    if !effect.indistinguishable_from.is_empty() {
        lines.push(format!("  could as well be {}", list(specs, &effect.indistinguishable_from)));
    }
    lines
}

fn next(diagnosis: &Diagnosis) -> String {
    match &diagnosis.next_manoeuvre {
        Some(next) => format!("Next, about {} min: {}", next.minutes, manoeuvre::next(next)),
        None => format!("Next: {}", words::advice(diagnosis)),
    }
}
