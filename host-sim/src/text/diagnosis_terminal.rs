//! A diagnosis on a terminal: the answer first, then what it rests on, in a dozen lines.

use super::diagnosis::{self as words, closed, label, list};
use super::number::three_digits;
use super::{diagnosis_headline as headline, diagnosis_targets as targets, manoeuvre, replay, unexplained};
use crate::diagnosis::{Diagnosis, EffectFound, TargetFound};

/// The whole text, with a newline at the end.
pub fn text(diagnosis: &Diagnosis) -> String {
    let mut lines = headline::lines(diagnosis);
    lines.push(String::new());
    if !words::is_firmware_mismatch(diagnosis) {
        lines.extend(table(diagnosis));
    }
    lines.extend(target_lines(&diagnosis.targets));
    diagnosis.effects.iter().for_each(|effect| lines.extend(effect_lines(diagnosis, effect)));
    lines.extend(diagnosis.description.iter().map(unexplained::text));
    lines.extend(diagnosis.unexplained.iter().map(|rest| format!("Left over: {}.", words::unexplained(rest))));
    lines.extend(diagnosis.rounding.iter().map(|found| format!("Recorded: {}.", words::rounding(found))));
    lines.extend(diagnosis.consequence.iter().map(|meaning| words::consequence(diagnosis, meaning)));
    lines.extend(diagnosis.simulation.iter().map(|used| format!("Held against: {}.", words::simulation(used))));
    lines.extend(words::cut_short(diagnosis).map(String::from));
    lines.extend(diagnosis.exact_replay.iter().map(|session| format!("Exact replay: {}.", replay::session(session))));
    lines.push(next(diagnosis));
    lines.join("\n") + "\n"
}

fn table(diagnosis: &Diagnosis) -> Vec<String> {
    let has_effects = !diagnosis.effects.is_empty();
    let row = |name: &str, [before, after, noise]: [String; 3], verdict: &str| {
        let after = if has_effects { format!("  {after:>12}") } else { String::new() };
        format!("{name:<22}  {before:>8}{after}  {noise:>6}  {verdict}")
    };
    let figures = diagnosis.channels.iter().map(|gap| {
        let figures = [gap.residual_rms_nT, gap.residual_after_rms_nT, gap.noise_floor_rms_nT];
        row(words::sensor(gap.channel), figures.map(three_digits), words::verdict(gap.verdict))
    });
    let heading = row("Residual, nT rms", ["simulated", "with effects", "noise"].map(String::from), "verdict");
    std::iter::once(heading).chain(figures).chain([String::new()]).collect()
}

/// The table of the targets; empty where there are none.
fn target_lines(targets: &[TargetFound]) -> Vec<String> {
    let rows = targets::rows(targets);
    if rows.is_empty() {
        return Vec::new();
    }
    let table: Vec<[String; 4]> = std::iter::once(targets::COLUMNS.map(String::from)).chain(rows).collect();
    let width = |column: usize| table.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3].map(width);
    let line = |row: &[String; 4]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("  {cell:>width$}"));
        cells.collect::<String>()
    };
    let heading = "Targets: signal, and no part of the gap".to_owned();
    let more = targets::more(targets).map(|more| format!("  {more}"));
    std::iter::once(heading).chain(table.iter().map(line)).chain(more).chain([String::new()]).collect()
}

fn effect_lines(diagnosis: &Diagnosis, effect: &EffectFound) -> Vec<String> {
    let specs = &diagnosis.specs;
    let (title, name, probability) = (label(specs, effect.name), effect.name, words::at_work(effect));
    let mut lines = vec![format!("{title} ({name}): probability {probability}")];
    if let Some(main) = words::as_main_cause(diagnosis, effect) {
        lines.push(format!("  {:<16} {main}", "as main cause"));
    }
    lines.extend(words::parameters(specs, effect).map(|(name, value)| format!("  {name:<16} {value}")));
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
