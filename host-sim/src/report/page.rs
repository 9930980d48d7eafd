//! The page of compensation: the answer, the table, the charts.

use askama::Template;
use towmag::model::{TERM_NAMES, TERM_UNITS};

use super::chart::{self, Chart, Look};
use super::data::{Kind, ReportData};
use super::frame::{PageFrame, plotly_js};
use super::merit::{Merit, merit};
use crate::collect::{SECTORS, SectorStd};
use crate::run::{Coefficient, MethodResult};
use crate::text::number::three_digits;
use crate::text::residual;

/// Rows a sector needs to be named the loudest: 10 s of them.
const ENOUGH_ROWS: u64 = 100;

/// At 10 Hz.
const ROWS_A_MINUTE: f64 = 600.0;

/// `data` as one self-contained HTML page.
///
/// # Errors
///
/// When the template cannot be filled; what it is filled with has no way to fail today.
pub fn render(data: &ReportData) -> std::io::Result<String> {
    Page::new(data).render().map_err(std::io::Error::other)
}

#[derive(Template)]
#[template(path = "page.html")]
struct Page<'a> {
    frame: PageFrame<'a>,
    data: &'a ReportData,
    rows: Vec<TableRow<'a>>,
    has_after_update: bool,
    has_settled: bool,
    has_kept: bool,
    /// Of the reading before compensation.
    fourth_difference: String,
    pulse: Option<String>,
    sectors: Vec<SectorRow<'a>>,
    sector_methods: Vec<&'a str>,
    merit: Option<Merit<'a>>,
    dwarfs: bool,
    stretch: Option<String>,
    time: Chart,
    spectrum: Option<Chart>,
    heading: Option<Chart>,
    heading_note: Option<String>,
    coefficients: Vec<Chart>,
    coefficient_tables: Vec<CoefficientTable<'a>>,
}

/// One method in the table of the paper.
struct TableRow<'a> {
    name: &'a str,
    colour: &'static str,
    best: bool,
    before: String,
    after: String,
    ratio: String,
    /// After settling.
    settled: String,
    settled_ratio: String,
    kept: String,
    noise_floor: String,
    fourth_difference: String,
    after_update: String,
}

struct CoefficientTable<'a> {
    name: &'a str,
    known: String,
    /// Term, value, standard deviation, unit.
    rows: Vec<[String; 4]>,
}

impl<'a> Page<'a> {
    fn new(data: &'a ReportData) -> Self {
        let looks = chart::looks(&data.methods);
        let kind = match data.kind {
            Kind::Calibrate => "Calibration",
            Kind::Replay => "Replay",
            Kind::Compare => "Comparison",
        };
        Self {
            frame: PageFrame {
                title: &data.title,
                kind,
                recording: &data.recording,
                headline: data.headline.as_str().into(),
                headline_class: "",
                warnings: &data.warnings,
                facts: &data.facts,
                plotly_js: plotly_js(),
            },
            data,
            rows: table(data, &looks),
            // A fit has seen every answer already: there is nothing to set apart.
            has_after_update: data.kind != Kind::Calibrate
                && data.methods.iter().any(|method| method.std_after_update_nt.is_some()),
            has_settled: data.methods.iter().any(|method| method.settled.is_some()),
            has_kept: data.targets.is_some(),
            fourth_difference: or_dash(data.uncompensated.fourth_difference_nt),
            pulse: data.pulse.as_ref().map(residual::sentence),
            sectors: sectors(data),
            sector_methods: compensated(data).map(|method| method.name.as_str()).collect(),
            merit: data.best().and_then(|index| merit(&data.methods[index])),
            dwarfs: chart::dwarfs(data),
            stretch: chart::stretch_s(data).map(|stretch_s| stretch_s.to_string()),
            time: chart::time(data, &looks),
            spectrum: chart::spectrum(data, &looks),
            heading: chart::heading(data, &looks),
            heading_note: data.best().and_then(|index| heading_note(&data.methods[index])),
            coefficients: chart::coefficients(&data.methods, &looks),
            coefficient_tables: data.methods.iter().filter_map(coefficient_table).collect(),
        }
    }

    fn predictive(&self) -> bool {
        self.data.kind != Kind::Calibrate
    }
}

fn table<'a>(data: &'a ReportData, looks: &[Look]) -> Vec<TableRow<'a>> {
    let best = data.best().filter(|_| data.methods.len() > 1);
    let row = |(i, (method, look)): (usize, (&'a MethodResult, &Look))| TableRow {
        name: &method.name,
        colour: look.colour,
        best: best == Some(i),
        before: three_digits(method.std_before_nt),
        after: three_digits(method.std_after_nt),
        ratio: three_digits(method.improvement_ratio()),
        settled: or_dash(method.settled.map(|settled| settled.std_after_nt)),
        settled_ratio: or_dash(method.settled.map(|settled| settled.improvement_ratio())),
        kept: kept(data, method),
        noise_floor: or_dash(method.noise_floor_nt),
        fourth_difference: or_dash(method.fourth_difference_nt),
        after_update: or_dash(method.std_after_update_nt),
    };
    data.methods.iter().zip(looks).enumerate().map(row).collect()
}

/// Three digits, or a dash for what is not known.
fn or_dash(value: Option<f64>) -> String {
    value.map_or("–".into(), three_digits)
}

/// Share of targets that comes through, percent. What does not compensate takes nothing away.
fn kept(data: &ReportData, method: &MethodResult) -> String {
    let Some(targets) = &data.targets else { return "–".into() };
    let of = targets.methods.iter().find(|of| of.method == method.name);
    match (of, method.coefficients.is_none()) {
        (Some(of), _) => format!("{:.0}", 100.0 * of.kept),
        (None, true) => "100".into(),
        (None, false) => "–".into(),
    }
}

/// The methods that compensate.
fn compensated(data: &ReportData) -> impl Iterator<Item = &MethodResult> {
    data.methods.iter().filter(|method| method.coefficients.is_some())
}

/// Improvement ratio of every method on the headings that were sailed.
struct SectorRow<'a> {
    heading: &'a str,
    minutes: String,
    ratios: Vec<String>,
}

fn sectors(data: &ReportData) -> Vec<SectorRow<'_>> {
    let count = |sector: usize| compensated(data).next().map_or(0, |method| method.headings[sector].count);
    let sailed = SECTORS.iter().enumerate().filter(|(sector, _)| count(*sector) >= ENOUGH_ROWS);
    let ratio = |method: &MethodResult, sector: usize| {
        three_digits(method.headings_before[sector].std_nt / method.headings[sector].std_nt)
    };
    let row = |(sector, heading): (usize, &&'static str)| SectorRow {
        heading,
        minutes: format!("{:.1}", count(sector) as f64 / ROWS_A_MINUTE),
        ratios: compensated(data).map(|method| ratio(method, sector)).collect(),
    };
    sailed.map(row).collect()
}

/// Where the method is loudest and where quietest.
fn heading_note(method: &MethodResult) -> Option<String> {
    let known = || SECTORS.iter().zip(&method.headings).filter(|(_, sector)| sector.count >= ENOUGH_ROWS);
    let louder = |a: &(&&str, &SectorStd), b: &(&&str, &SectorStd)| a.1.std_nt.total_cmp(&b.1.std_nt);
    let (loudest, quietest) = (known().max_by(louder)?, known().min_by(louder)?);
    if loudest.0 == quietest.0 {
        return None;
    }
    let [loud, quiet] = [loudest.1.std_nt, quietest.1.std_nt].map(three_digits);
    let (loudest, quietest, name) = (loudest.0, quietest.0, &method.name);
    Some(format!("{name} is loudest heading {loudest} ({loud} nT) and quietest heading {quietest} ({quiet} nT)."))
}

fn coefficient_table(method: &MethodResult) -> Option<CoefficientTable<'_>> {
    let values = method.coefficients.as_ref()?;
    let row = |(i, c): (usize, &Coefficient)| {
        [TERM_NAMES[i].into(), three_digits(c.value), three_digits(c.std), TERM_UNITS[i].into()]
    };
    let certain = values.iter().filter(|c| c.value.abs() > 2.0 * c.std).count();
    let known = format!("{certain} of {} differ from zero by more than 2 STD", values.len());
    Some(CoefficientTable { name: &method.name, known, rows: values.iter().enumerate().map(row).collect() })
}
