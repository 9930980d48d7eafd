//! Each recording over time: the field, the anomaly with its contacts, the noise, and what would be found.

use towmag_survey::SurveyedTow;

use super::input::SurveyReport;
use crate::report::svg::{Axis, Line, Mark, Plot, path};
use crate::text::clock;

/// Points across the charts of all recordings together, and of one: what keeps the page small and the picture sharp.
const COLUMNS: usize = 3600;
const COLUMNS_EACH: usize = 900;
const COLUMNS_LEAST: usize = 150;

/// A line breaks where no value follows for this long, s.
const GAP_S: f64 = 1.0;

/// A recording.
pub(super) struct Course {
    pub(super) name: String,
    pub(super) date: Option<String>,
    pub(super) charts: Vec<Plot>,
}

pub(super) fn courses(report: &SurveyReport<'_>) -> Vec<Course> {
    let tows = &report.survey.tows;
    let columns = (COLUMNS / tows.len().max(1)).clamp(COLUMNS_LEAST, COLUMNS_EACH);
    tows.iter().enumerate().map(|(index, tow)| course(report, index, tow, columns)).collect()
}

/// One chart of a recording, before it is drawn.
struct Series<'a> {
    name: &'static str,
    title: &'static str,
    unit: &'static str,
    class: &'static str,
    values: &'a [f64],
}

fn course(report: &SurveyReport<'_>, index: usize, tow: &SurveyedTow, columns: usize) -> Course {
    let offset_s = report.offset_s(index);
    let first_s = tow.time_s.iter().copied().find(|time_s| time_s.is_finite());
    let field = if offset_s.is_some() { "Field, nT, over UTC" } else { "Field, nT, over s" };
    let one = |name, title, unit, class, values| Series { name, title, unit, class, values };
    let series = [
        one("Field", field, "nT", "field", &tow.field_nt[..]),
        one("Anomaly", "Anomaly, nT", "nT", "anomaly", &tow.anomaly_nt),
        one("Noise", "Noise of the anomaly, nT", "nT", "noise", &tow.anomaly_std_nt),
        one("Smallest moment", "Smallest moment found, A m²", "A m²", "reach", &tow.smallest_moment_am2),
    ];
    let chart = |series: Series<'_>| {
        let Series { name, title, unit, class, values } = series;
        let x = time_axis(tow, offset_s)?;
        let y = Axis::around(values.iter().copied(), unit, 5)?;
        let d = path(tow.time_s.iter().copied().zip(values.iter().copied()), GAP_S, [&x, &y], columns);
        let marks = if class == "anomaly" { marks(report, index, &x) } else { Vec::new() };
        let lines = vec![Line { name: "", class, d }];
        Some(Plot { label: format!("{name} of {} over time", tow.name), title, class, x, y, lines, marks })
    };
    Course {
        name: tow.name.clone(),
        date: offset_s.zip(first_s).map(|(offset_s, first_s)| format!("{} UTC", clock::date(first_s + offset_s))),
        charts: series.into_iter().filter_map(chart).collect(),
    }
}

fn time_axis(tow: &SurveyedTow, offset_s: Option<f64>) -> Option<Axis> {
    let known = || tow.time_s.iter().copied().filter(|time_s| time_s.is_finite());
    let (low_s, high_s) = (known().next()?, known().next_back()?);
    (high_s > low_s).then(|| Axis::time(low_s, high_s, offset_s, 5))
}

fn marks(report: &SurveyReport<'_>, index: usize, x: &Axis) -> Vec<Mark> {
    let own = report.survey.contacts.iter().filter(|contact| contact.tow == index);
    own.map(|contact| Mark { percent: format!("{:.2}", 100.0 * x.share(contact.time_s)), number: contact.number })
        .collect()
}
