//! The score of a trial on a terminal.

use super::{Rate, Score, WithheldScore};

/// The whole table, with a newline at the end.
pub fn text(score: &Score) -> String {
    let mut lines =
        vec![line("False alarms", score.false_alarms), line("Gap seen where something is hidden", score.detected)];
    for bin in &score.singles {
        let [low, high] = bin.strength;
        let of = format!("Single, strength {low} to {high:.0}");
        lines.push(line(&format!("{of}: seen"), bin.detected));
        lines.push(line(&format!("{of}: right or in set"), bin.right_or_in_set));
        lines.push(line(&format!("{of}: right alone"), bin.alone_right));
        lines.push(line(&format!("{of}: wrong, claimed"), bin.wrong_and_claimed));
    }
    lines.extend([
        line("Pairs: both right or in set", score.pairs_both),
        line("Pairs: at least one", score.pairs_one),
        line("Outside the library: noticed", score.foreign_noticed),
        line("  of strength 3 and more", score.foreign_noticed_from_3),
        line("Outside the library: explained away", score.foreign_explained),
        line("Parameters within their 95 % interval", score.intervals_cover),
        format!("{:<44} {:>9.3}", "Calibration error of the probabilities", score.calibration_error),
    ]);
    lines.extend(score.withheld.iter().flat_map(withheld));
    lines.join("\n") + "\n"
}

fn withheld(score: &WithheldScore) -> Vec<String> {
    let median = score.median_gap_closed.map_or("-".into(), |share| format!("{share:.2}"));
    vec![
        line(&format!("Without {}: noticed", score.name), score.noticed),
        line("  explained by others", score.explained_by_others),
        line("With it back: right or in set", score.named_when_back),
        line("  gap explained", score.explained_when_back),
        format!("{:<44} {median:>9}", "  share of the gap that it closes, median"),
    ]
}

/// "False alarms    1 of 60    0.3 to 8.9 %".
fn line(what: &str, rate: Rate) -> String {
    if rate.of == 0 {
        return format!("{what:<44} {:>9}", "none drawn");
    }
    let [low, high] = rate.ci95.map(|share| 100.0 * share);
    format!("{what:<44} {:>3} of {:<3} {low:>5.1} to {high:.1} %", rate.hits, rate.of)
}
