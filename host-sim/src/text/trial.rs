//! The score of a trial on a terminal: what was asked for and what came, then the rest.

use std::collections::BTreeMap;

use towmag_trial::{DriverScore, Figure, OnScore, Rate, Score, WithheldScore, figures, on_figures};

/// The whole table, with a newline at the end.
pub fn text(score: &Score) -> String {
    let mut lines = asked_and_measured(&figures(score));
    lines.push(String::new());
    for (group, rates) in [("noise", &score.false_alarms_by_noise), ("motion", &score.false_alarms_by_motion)] {
        lines.extend(rates.iter().map(|(name, rate)| line(&format!("False alarms, {group} {name}"), *rate)));
    }
    for bin in &score.singles {
        lines.push(line(&format!("One effect, strength {}: gap seen", bin.strength), bin.detected));
        lines.push(line(&format!("One effect, strength {}: named alone and right", bin.strength), bin.alone_right));
        lines.push(line(&format!("One effect, strength {}: wrong and claimed", bin.strength), bin.wrong_and_claimed));
    }
    lines.extend(score.several.iter().map(|own| line(&format!("{}: at least one found", own.what), own.one)));
    lines.push(line(
        "Outside the library, identifiable, strength 3 and 10: noticed",
        score.foreign_identifiable_noticed_from_3,
    ));
    lines.push(line("Outside the library, strength 1: noticed", score.foreign_noticed_at_1));
    lines.push(line("Targets below 5 nT: listed", score.targets.small_listed));
    lines.extend(by_effect("Parameters within their interval", &score.intervals_cover_by_effect));
    lines.extend(by_effect("Shrink within its interval", &score.shrink.cover_by_effect));
    lines.extend(score.drivers.iter().flat_map(drivers));
    lines.extend(score.withheld.iter().flat_map(withheld));
    lines.join("\n") + "\n"
}

/// The table of a trial on a recording.
pub fn text_on(score: &OnScore) -> String {
    let mut lines = asked_and_measured(&on_figures(score));
    lines.extend([
        String::new(),
        format!("Untouched: {}", score.untouched),
        format!(
            "Residual that strengths are relative to: scalar {:.3} nT rms, fluxgate {:.3} nT rms",
            score.scalar_residual_rms_nt, score.fluxgate_residual_rms_nt
        ),
    ]);
    lines.extend(
        score.named.iter().map(|bin| line(&format!("Put in with strength {}: named", bin.strength), bin.named)),
    );
    lines.extend(score.missed.iter().map(|missed| format!("  not named: {missed}")));
    lines.join("\n") + "\n"
}

fn asked_and_measured(figures: &[Figure]) -> Vec<String> {
    let one =
        |figure: &Figure| row([&figure.what, &figure.asked, &figure.measured, figure.state.word(), &figure.counted]);
    std::iter::once(row(["", "asked for", "measured", "", ""])).chain(figures.iter().map(one)).collect()
}

/// A title, and a line for each effect.
fn by_effect(title: &str, rates: &BTreeMap<String, Rate>) -> Vec<String> {
    let lines = rates.iter().map(|(name, rate)| line(&format!("  {name}"), *rate));
    std::iter::once(title.to_string()).chain(lines).collect()
}

fn row([what, asked, measured, state, counted]: [&str; 5]) -> String {
    format!("{what:<52} {asked:>14} {measured:>9}  {state:<10} {counted}").trim_end().to_string()
}

/// What is said to drive what has no name, in recordings of strength 3 and more.
fn drivers(score: &DriverScore) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
    let mut lines = vec![
        String::new(),
        line("A recorded driver: described", score.recorded_described),
        line("  right driver first", score.recorded_right),
        line("  an effect proposed, of what is no chance", score.proposed_with_driver),
        format!("{:<52} {:>24}", "  share of the gap that it closes, median", number(score.median_closed)),
        line("No recorded driver: none or time first", score.unrecorded_right),
        line("  an effect proposed", score.proposed_without_driver),
        format!("{:<52} {:>24}", "Error of the drivers' probabilities", number(score.calibration_error)),
    ];
    lines.extend(by_effect("Right driver first", &score.right_by_name));
    lines
}

fn withheld(score: &WithheldScore) -> Vec<String> {
    let median = score.median_gap_closed.map_or("-".into(), |share| format!("{share:.2}"));
    vec![
        String::new(),
        line(&format!("Without {}: noticed", score.name), score.noticed),
        line("  explained by others", score.explained_by_others),
        line("With it back: right, or in the stated set", score.named_when_back),
        line("  gap explained", score.explained_when_back),
        format!("{:<52} {median:>24}", "  share of the gap that it closes, median"),
    ]
}

/// "False alarms, noise pink    1 of 60, 0.3 to 8.9 %".
fn line(what: &str, rate: Rate) -> String {
    let [low, high] = rate.ci95.map(|share| 100.0 * share);
    match rate.share() {
        None => format!("{what:<52} {:>24}", "none drawn"),
        Some(share) => {
            let counted = format!("{} of {}, {low:.1} to {high:.1} %", rate.hits, rate.of);
            row([what, "", &format!("{:.1} %", 100.0 * share), "", &counted])
        }
    }
}
