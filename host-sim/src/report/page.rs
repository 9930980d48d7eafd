//! The page of compensation: the answer, the table, the charts.

use askama::Template;
use towmag::model::{TERM_NAMES, TERM_UNITS};

use super::chart::{self, Chart, Look};
use super::data::{Kind, ReportData, best};
use super::frame::{PageFrame, plotly_js};
use crate::collect::{SECTORS, SectorStd};
use crate::run::{Coefficient, MethodResult};
use crate::text::number::three_digits;

/// Rows a sector needs to be named the loudest: 10 s of them.
const ENOUGH_ROWS: u64 = 100;

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
    dwarfs: bool,
    shifts: Option<String>,
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
            dwarfs: chart::dwarfs(data),
            shifts: chart::shifts(data),
            stretch: chart::stretch_s(data).map(|stretch_s| stretch_s.to_string()),
            time: chart::time(data, &looks),
            spectrum: chart::spectrum(data, &looks),
            heading: chart::heading(data, &looks),
            heading_note: best(&data.methods).and_then(|index| heading_note(&data.methods[index])),
            coefficients: chart::coefficients(&data.methods, &looks),
            coefficient_tables: data.methods.iter().filter_map(coefficient_table).collect(),
        }
    }

    fn predictive(&self) -> bool {
        self.data.kind != Kind::Calibrate
    }
}

fn table<'a>(data: &'a ReportData, looks: &[Look]) -> Vec<TableRow<'a>> {
    let best = best(&data.methods).filter(|_| data.methods.len() > 1);
    let row = |(i, (method, look)): (usize, (&'a MethodResult, &Look))| TableRow {
        name: &method.name,
        colour: look.colour,
        best: best == Some(i),
        before: three_digits(method.std_before_nt),
        after: three_digits(method.std_after_nt),
        ratio: three_digits(method.improvement_ratio()),
        after_update: method.std_after_update_nt.map_or("–".into(), three_digits),
    };
    data.methods.iter().zip(looks).enumerate().map(row).collect()
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
