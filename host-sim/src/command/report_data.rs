//! What the page says beside the pictures: facts, warnings, title.

use towmag::Settings;

use crate::coefficients_file::Origin;
use crate::collect::{HeadingStd, SECTORS};
use crate::detection::band_pulse;
use crate::report::{Kind, ReportData, headline};
use crate::run::{Counts, Passed};
use crate::text::clock;
use crate::text::number::{group, three_digits};

/// Above this, coefficients follow the noise more than the body.
const LARGE_CONDITION_NUMBER: f64 = 1e5;

/// Width at half the peak of a target that the page takes as its example, s: 4 m off at 2 m/s.
const TYPICAL_WIDTH_S: f64 = 2.0;

/// Samples on a heading that make it known: 5 s.
const KNOWN_HEADING: u64 = 50;

/// Headings that a calibration should have.
const LEAST_HEADINGS: usize = 4;

/// What the page says of the calibration.
pub(super) struct CalibrationFacts {
    recording: String,
    improvement_ratio: f64,
    condition_number: f64,
}

impl From<&Origin> for CalibrationFacts {
    fn from(origin: &Origin) -> Self {
        Self {
            recording: origin.recording.clone(),
            improvement_ratio: origin.improvement_ratio,
            condition_number: origin.condition_number,
        }
    }
}

/// Everything on the page of a command.
pub(super) fn report_data(
    kind: Kind,
    recording: &str,
    passed: Passed,
    settings: &Settings,
    calibration: Option<&CalibrationFacts>,
) -> ReportData {
    let Passed { counts, uncompensated, methods } = passed;
    let recording = recording.to_string();
    let verb = match kind {
        Kind::Calibrate => "Calibration",
        Kind::Replay => "Replay",
        Kind::Compare => "Comparison",
    };
    let mut warnings = warnings_of(&counts, calibration);
    if kind == Kind::Calibrate {
        warnings.extend(few_headings(&uncompensated.headings));
    }
    ReportData {
        title: format!("{verb}: {recording}"),
        kind,
        headline: headline(&methods, None),
        facts: facts_of(&counts, settings, calibration),
        warnings,
        band_hz: [settings.band_pass.low_hz, settings.band_pass.high_hz],
        recording,
        uncompensated,
        methods,
        detection: Vec::new(),
        targets: None,
        marks: Vec::new(),
        marks_note: None,
        utc_offset_s: counts.utc_offset_s,
        pulse: band_pulse(settings.band_pass, TYPICAL_WIDTH_S).ok(),
    }
}

/// A calibration wants the body on headings all around.
fn few_headings(headings: &HeadingStd) -> Option<String> {
    let known = SECTORS.iter().zip(headings).filter(|(_, sector)| sector.count >= KNOWN_HEADING);
    let known: Vec<&str> = known.map(|(name, _)| *name).collect();
    (known.len() < LEAST_HEADINGS).then(|| {
        format!(
            "Only {} of 8 headings were sailed ({}): off them the coefficients are a guess. Four at right angles are good practice.",
            known.len(),
            known.join(", ")
        )
    })
}

fn facts_of(counts: &Counts, settings: &Settings, calibration: Option<&CalibrationFacts>) -> Vec<(String, String)> {
    let fact = |label: &str, value: String| (label.to_string(), value);
    let band = settings.band_pass;
    let mut facts = vec![
        fact("Rows", group(counts.rows as i64)),
        fact("Rows compensated", group(counts.used_rows as i64)),
        fact("Gaps", format!("{} ({:.1} s)", counts.gaps, counts.gap_s)),
        fact(
            "Heading",
            if counts.recorded_heading { "recorded" } else { "from the fluxgate, magnetic, not levelled" }.into(),
        ),
        fact("Band-pass", format!("{} to {} Hz, {} poles a side", band.low_hz, band.high_hz, band.order)),
        fact("lambda1, lambda2", format!("{}, {}", settings.penalty.lambda1, settings.penalty.lambda2)),
        fact("Forgetting, dual step", format!("{}, {}", settings.forgetting, settings.dual_step)),
    ];
    if let Some((first_s, last_s)) = counts.span_s {
        if let Some(offset_s) = counts.utc_offset_s {
            let [date, time] = [clock::date, clock::seconds].map(|text| text(first_s + offset_s));
            facts.insert(0, fact("Began", format!("{date} {time} UTC")));
        }
        facts.insert(0, fact("Duration", format!("{:.1} min", (last_s - first_s) / 60.0)));
    }
    if let Some(calibration) = calibration {
        facts.push(fact("Calibrated on", calibration.recording.clone()));
        facts.push(fact("Improvement ratio there", three_digits(calibration.improvement_ratio)));
        facts.push(fact("Condition number there", three_digits(calibration.condition_number)));
    }
    facts.push(fact("Program", format!("host-sim {}", env!("CARGO_PKG_VERSION"))));
    facts
}

fn warnings_of(counts: &Counts, calibration: Option<&CalibrationFacts>) -> Vec<String> {
    let mut warnings = counts.bad_rows.sentences();
    let lost = counts.rows - counts.used_rows;
    if lost * 20 > counts.rows {
        let (lost, rows) = (group(lost as i64), group(counts.rows as i64));
        warnings.push(format!(
            "{lost} of {rows} rows could not be compensated: missing or invalid readings, or the row after a gap."
        ));
    }
    if let Some(calibration) = calibration.filter(|c| c.condition_number > LARGE_CONDITION_NUMBER) {
        let number = three_digits(calibration.condition_number);
        warnings.push(format!("The calibration's condition number is {number}: some coefficients follow the noise. Turn the body further on all three axes."));
    }
    warnings
}
