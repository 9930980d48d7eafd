//! What is printed.

use std::io::IsTerminal;

use host_sim::command::{MethodTable, TowResult};
use host_sim::detection::{Combination, Detection};
use host_sim::summary::{Summary, to_json};

use super::options::ResultArgs;
use super::say::{print, say, warn};

/// The table of the paper, over the whole tow and from the third minute on.
pub(super) fn show_table(table: &MethodTable) {
    let MethodTable { calibration, calibration_improvement_ratio, tows, .. } = table;
    say(format_args!("Calibrated on {calibration}, improvement ratio {calibration_improvement_ratio:.3}"));
    for TowResult { scenario, whole, late, late_bound_improvement_ratio } in tows {
        say(format_args!("\n{scenario:<14} {:>25} {:>30}", "whole tow", "from the third minute on"));
        say(format_args!(
            "{:<14} {:>12} {:>12} {:>17} {:>12}",
            "method", "after (nT)", "improvement", "after (nT)", "improvement"
        ));
        for (whole, late) in whole.iter().zip(late) {
            say(format_args!(
                "{:<14} {:>12.4} {:>12.4} {:>17.4} {:>12.4}",
                whole.method, whole.std_after_nT, whole.improvement_ratio, late.std_after_nT, late.improvement_ratio
            ));
        }
        say(format_args!(
            "Improvement of the best 18 fixed coefficients in hindsight: {late_bound_improvement_ratio:.4}."
        ));
    }
    say(format_args!("\nStandard deviations in the band, strictly predictive."));
}

/// What the methods leave of injected anomalies.
pub(super) fn show_detection(combination: &Combination) {
    let Combination { calibration, recording, bound_nT, methods } = combination;
    say(format_args!("\n{calibration} -> {recording}: bound {bound_nT:.3} nT"));
    say(format_args!(
        "{:<14} {:>11} {:>12} {:>6} {:>11} {:>11} {:>10}",
        "method", "after/bound", "output/bound", "kept", "kept strong", "distortion", "detection"
    ));
    for of in methods {
        let Detection { method, residual_over_bound, end_to_end_over_bound, kept, distortion, detection, .. } = of;
        let strong = of.kept_strong.map_or("-".into(), |kept| format!("{kept:.3}"));
        say(format_args!(
            "{method:<14} {residual_over_bound:>11.3} {end_to_end_over_bound:>12.3} {kept:>6.3} {strong:>11} \
             {distortion:>11.3} {detection:>10.3}"
        ));
    }
    say(format_args!("Kept strong: of the anomalies whose peak is at least ten times the bound."));
}

/// The summary as JSON, or the table of the paper and where the rest is.
pub(super) fn show(
    result: &ResultArgs,
    whole: &impl serde::Serialize,
    methods: &[Summary],
    targets: Option<&Combination>,
    heading: &str,
) {
    if let Some(first) = methods.first() {
        warn(&first.bad_rows.sentences());
        warn(&first.warnings);
    }
    if result.json {
        print(to_json(whole));
        return;
    }
    if !heading.is_empty() {
        say(heading);
    }
    let columns = Columns { settled: methods.iter().any(|method| method.settled.is_some()), targets };
    say(columns.titles());
    for method in methods {
        say(columns.line_of(method));
    }
    if columns.settled {
        say("Settled: from the third minute on.");
    }
    if targets.is_some() {
        say(
            "Kept: of dipoles of 5 to 15 nT that were added. What is quiet because it takes targets away is no better.",
        );
    }
    say(format_args!("Standard deviations in the band, over {} rows of {}.", methods[0].used_rows, methods[0].rows));
    point_to_report(result);
}

/// Which columns the table has beside those that it always has.
struct Columns<'a> {
    /// The figures from the third minute on.
    settled: bool,
    /// What is left of targets.
    targets: Option<&'a Combination>,
}

impl Columns<'_> {
    fn titles(&self) -> String {
        let settled =
            if self.settled { format!(" {:>13} {:>11}", "settled (nT)", "improvement") } else { String::new() };
        let kept = if self.targets.is_some() { "  kept" } else { "" };
        format!(
            "{:<14} {:>11} {:>10} {:>11}{settled}{kept} {:>17}",
            "method", "before (nT)", "after (nT)", "improvement", "after update (nT)"
        )
    }

    fn line_of(&self, of: &Summary) -> String {
        let Summary { method, std_before_nT, std_after_nT, improvement_ratio, std_after_update_nT, .. } = of;
        let settled = match &of.settled {
            Some(settled) => format!(" {:>13.4} {:>11.4}", settled.std_after_nT, settled.improvement_ratio),
            None if self.settled => format!(" {:>13} {:>11}", "-", "-"),
            None => String::new(),
        };
        let kept = self.targets.map_or(String::new(), |targets| {
            let detection = targets.methods.iter().find(|of| of.method == *method);
            detection.map_or("     -".into(), |of| format!(" {:>5.2}", of.kept))
        });
        format!(
            "{method:<14} {std_before_nT:>11.4} {std_after_nT:>10.4} {improvement_ratio:>11.4}{settled}{kept} \
             {std_after_update_nT:>17.4}"
        )
    }
}

/// For a person, not for a script.
pub(super) fn point_to_report(result: &ResultArgs) {
    if std::io::stdout().is_terminal() {
        say(format_args!("Open {} in a browser.", result.out.join("report.html").display()));
    }
}
