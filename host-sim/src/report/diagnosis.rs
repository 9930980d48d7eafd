//! The page of a diagnosis: the verdict, what to do next, the causes, and the pictures behind them.

use askama::Template;

use super::chart::{self, By, Chart};
use super::frame::{PageFrame, plotly_js};
use super::series::series;
use crate::diagnosis::{ChannelGap, Diagnosis, DriverShare, EffectFound, Verdict};
use crate::text::diagnosis::{self as words, closed, confirmed, list, percent};
use crate::text::diagnosis_json::PROPOSED_EFFECT;
use crate::text::diagnosis_targets;
use crate::text::manoeuvre;
use crate::text::number::three_digits;
use crate::text::unexplained;

/// Everything on the page.
#[derive(Clone, Debug)]
pub struct DiagnosisReport<'a> {
    /// Title of the page.
    pub title: String,
    /// File name of the recording.
    pub recording: String,
    /// What was found.
    pub diagnosis: &'a Diagnosis,
    /// Effects that were taken out of the library.
    pub withheld: &'a [String],
    /// Effects that need a column that the recording lacks, with that column.
    pub untested: Vec<(&'static str, &'static str)>,
    /// What the reader must know before trusting the verdict.
    pub warnings: Vec<String>,
    /// Label and value, shown last.
    pub facts: Vec<(String, String)>,
}

/// `report` as one self-contained HTML page.
///
/// # Errors
///
/// When the template cannot be filled; what it is filled with has no way to fail today.
pub fn render_diagnosis(report: &DiagnosisReport<'_>) -> std::io::Result<String> {
    Page::new(report).render().map_err(std::io::Error::other)
}

#[derive(Template)]
#[template(path = "diagnosis.html")]
struct Page<'a> {
    frame: PageFrame<'a>,
    /// Nothing but the firmware is judged.
    is_firmware: bool,
    has_gap: bool,
    has_after: bool,
    channels: Vec<ChannelRow>,
    cut_short: Option<&'static str>,
    consequence: Option<String>,
    rounding: Option<String>,
    targets: TargetTable,
    next: Next,
    causes_title: &'static str,
    effects: Vec<EffectCard>,
    rest_title: &'static str,
    unexplained: Vec<String>,
    rest: Option<RestSection>,
    candidates: Option<Chart>,
    /// Candidates that are not shown.
    others: usize,
    map: Vec<By>,
    residual: Option<Chart>,
    spectra: Vec<Chart>,
    scalar_colour: &'static str,
    fluxgate_colour: &'static str,
    noise_colour: &'static str,
    limits: Limits,
}

/// What is not explained.
struct RestSection {
    text: String,
    drivers: Vec<(String, String, String)>,
    chart: Option<Chart>,
    map: Option<Chart>,
    confirmed: Option<String>,
    file: Option<&'static str>,
}

/// Drivers that are shown: the others are no more than improbable.
const LEAST_SHOWN: f64 = 0.01;

fn rest(diagnosis: &Diagnosis) -> Option<RestSection> {
    let found = diagnosis.description.as_ref()?;
    let row = |driver: &DriverShare| {
        let width = format!("{:.0}", 100.0 * driver.probability);
        (words::capital(unexplained::what(&driver.input)), percent(driver.probability), width)
    };
    Some(RestSection {
        text: unbroken(&unexplained::text(found)),
        drivers: found.drivers.iter().filter(|driver| driver.probability >= LEAST_SHOWN).map(row).collect(),
        chart: found.curve.as_ref().map(chart::driver),
        map: found.map.as_ref().map(chart::driver_map),
        confirmed: found.confirmed.as_ref().map(confirmed),
        file: found.effect_file.is_some().then_some(PROPOSED_EFFECT),
    })
}

/// One sensor in the table beneath the verdict.
struct ChannelRow {
    name: &'static str,
    before: String,
    after: String,
    noise: String,
    verdict: &'static str,
    /// Class of the verdict in the style sheet.
    state: &'static str,
}

/// The targets.
struct TargetTable {
    columns: [&'static str; 4],
    rows: Vec<[String; 4]>,
    /// What is not listed.
    more: Option<String>,
}

/// What to do next.
struct Next {
    text: String,
    /// For how long, and what it tells apart.
    why: Option<String>,
}

/// An effect that is at work.
struct EffectCard {
    title: String,
    what: String,
    origin: &'static str,
    probability: String,
    /// That it is the main cause, where that is another number.
    main: Option<String>,
    closed: Option<String>,
    /// Width of the bar, percent.
    closed_percent: String,
    held_out: bool,
    confirmed: Option<String>,
    parameters: Vec<(String, String)>,
    alike: Option<String>,
}

/// What this recording cannot show.
struct Limits {
    /// Effects of which next to nothing survives the refit.
    hidden: Option<String>,
    withheld: Option<String>,
    untested: Option<String>,
    /// Each effect with the share of it that survives the refit.
    rows: Vec<(String, String)>,
}

/// Below this share of an effect's power the recording can hardly show it.
const HIDDEN: f64 = 0.02;

impl<'a> Page<'a> {
    fn new(report: &'a DiagnosisReport<'a>) -> Self {
        let diagnosis = report.diagnosis;
        let is_firmware = words::is_firmware_mismatch(diagnosis);
        let series = if is_firmware { Vec::new() } else { series(diagnosis) };
        let has_gap = diagnosis.verdict != Verdict::NoGap;
        Self {
            frame: PageFrame {
                title: &report.title,
                kind: "Diagnosis",
                recording: &report.recording,
                headline: unbroken(&words::sentence(diagnosis)).into(),
                headline_class: headline_class(&words::sentence(diagnosis)),
                warnings: &report.warnings,
                facts: &report.facts,
                plotly_js: plotly_js(),
            },
            is_firmware,
            has_gap,
            has_after: !diagnosis.effects.is_empty(),
            channels: if is_firmware { Vec::new() } else { diagnosis.channels.iter().map(channel_row).collect() },
            cut_short: words::cut_short(diagnosis),
            consequence: diagnosis
                .consequence
                .as_ref()
                .map(|meaning| unbroken(&words::consequence(diagnosis, meaning))),
            rounding: diagnosis.rounding.as_ref().map(|found| unbroken(&words::rounding(found))),
            targets: target_table(diagnosis),
            next: next(diagnosis),
            causes_title: match diagnosis.effects.iter().any(words::is_likely) || diagnosis.effects.is_empty() {
                true => "What causes it",
                false => "What may cause it",
            },
            effects: diagnosis.effects.iter().map(|effect| card(diagnosis, effect)).collect(),
            rest_title: match diagnosis.verdict {
                Verdict::Explained => "A small rest, of little weight beside what is explained",
                Verdict::PartlyExplained => "What no named effect explains",
                _ => "What stands out",
            },
            unexplained: diagnosis.unexplained.iter().map(words::unexplained).collect(),
            rest: rest(diagnosis),
            candidates: chart::candidates(diagnosis),
            others: chart::others(&diagnosis.candidates),
            map: if has_gap { chart::gap_map(diagnosis) } else { Vec::new() },
            residual: chart::gap_residual(&series, &diagnosis.targets),
            spectra: chart::gap_spectra(&series),
            scalar_colour: chart::SCALAR,
            fluxgate_colour: chart::FLUXGATE,
            noise_colour: chart::NOT_SIGNIFICANT,
            limits: limits(report),
        }
    }
}

/// Smaller letters for a longer headline, so that it has two lines on a screen.
fn headline_class(headline: &str) -> &'static str {
    match headline.chars().count() {
        0..=100 => "",
        101..=150 => "long",
        _ => "longest",
    }
}

fn channel_row(gap: &ChannelGap) -> ChannelRow {
    let [before, after, noise] =
        [gap.residual_rms_nT, gap.residual_after_rms_nT, gap.noise_floor_rms_nT].map(three_digits);
    let state = match gap.verdict {
        Verdict::NoGap => "reached",
        Verdict::Explained | Verdict::PartlyExplained => "open",
        Verdict::Unknown => "missed",
    };
    ChannelRow { name: words::sensor(gap.channel), before, after, noise, verdict: words::verdict(gap.verdict), state }
}

fn target_table(diagnosis: &Diagnosis) -> TargetTable {
    TargetTable {
        columns: diagnosis_targets::COLUMNS,
        rows: diagnosis_targets::rows(&diagnosis.targets),
        more: diagnosis_targets::more(&diagnosis.targets),
    }
}

fn next(diagnosis: &Diagnosis) -> Next {
    if let Some(next) = &diagnosis.next_manoeuvre {
        let apart = match next.separates.as_slice() {
            ["unknown"] => "It narrows down what the cause is.".into(),
            names => format!("It tells apart: {}.", list(&diagnosis.specs, names)),
        };
        let why = format!("About {:.0} minutes. {apart}", next.minutes.ceil());
        return Next { text: manoeuvre::next(next), why: Some(why) };
    }
    Next { text: words::advice(diagnosis).into(), why: None }
}

fn card(diagnosis: &Diagnosis, effect: &EffectFound) -> EffectCard {
    let specs = &diagnosis.specs;
    let spec = words::spec(specs, effect.name);
    let title = match &effect.load {
        Some(load) => format!("Current of the load {load}"),
        None => words::label(specs, effect.name),
    };
    let what = spec.map_or("the outputs that the body logged differ from a replay of its inputs", |spec| spec.what);
    EffectCard {
        title,
        what: words::capital(what),
        origin: spec
            .map_or("another version of the firmware, other settings, or a fault of the processor", |spec| spec.origin),
        probability: words::at_work(effect),
        main: words::as_main_cause(diagnosis, effect),
        // The firmware's own outputs are no gap to close.
        closed: spec.map(|_| closed(&effect.gap_closed)),
        closed_percent: format!("{:.0}", 100.0 * effect.gap_closed.fraction.clamp(0.0, 1.0)),
        held_out: effect.gap_closed.held_out,
        confirmed: effect.confirmed.as_ref().map(confirmed),
        parameters: words::parameters(specs, effect).map(|(name, value)| (axis_named(&name), value)).collect(),
        alike: (!effect.indistinguishable_from.is_empty()).then(|| list(specs, &effect.indistinguishable_from)),
    }
}

/// Numbers keep their unit on their line.
fn unbroken(text: &str) -> String {
    [" nT", " %", " ms", " s "]
        .iter()
        .fold(text.into(), |text: String, unit| text.replace(unit, &unit.replacen(' ', "\u{a0}", 1)))
}

/// A parameter as a heading, with the direction of an axis.
fn axis_named(parameter: &str) -> String {
    match parameter {
        "x" => "x, forward".into(),
        "y" => "y, starboard".into(),
        "z" => "z, down".into(),
        other => words::capital(other),
    }
}

fn limits(report: &DiagnosisReport<'_>) -> Limits {
    let specs = &report.diagnosis.specs;
    let mut shares: Vec<(&str, f64)> = report
        .diagnosis
        .candidates
        .iter()
        .filter_map(|candidate| Some((candidate.name, candidate.identifiable_fraction?)))
        .collect();
    shares.sort_by(|a, b| a.1.total_cmp(&b.1));
    let hidden: Vec<&str> = shares.iter().filter(|(_, share)| *share < HIDDEN).map(|(name, _)| *name).collect();
    let withheld: Vec<&str> = report.withheld.iter().map(String::as_str).collect();
    let untested: Vec<String> =
        report.untested.iter().map(|(name, column)| format!("{} (needs {column})", list(specs, &[*name]))).collect();
    let said = |text: String| (!text.is_empty()).then_some(text);
    Limits {
        hidden: said(list(specs, &hidden)),
        withheld: said(list(specs, &withheld)),
        untested: said(untested.join(", ")),
        rows: shares.iter().map(|(name, share)| (words::label(specs, name), percent(*share))).collect(),
    }
}
