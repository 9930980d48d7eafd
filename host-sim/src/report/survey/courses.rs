//! Each recording over time: the field, the anomaly with its contacts, the noise, and what would be found.

use towmag_survey::SurveyedTow;

use super::SurveyReport;
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

fn course(report: &SurveyReport<'_>, index: usize, tow: &SurveyedTow, columns: usize) -> Course {
    let offset_s = report.offset_s(index);
    let first_s = tow.time_s.iter().copied().find(|time_s| time_s.is_finite());
    let kind = if offset_s.is_some() { 0 } else { 1 };
    let series: [(&str, [&'static str; 2], &'static str, &'static str, &[f64]); 4] = [
        ("Field", ["Field, nT, over UTC", "Field, nT, over s"], "nT", "field", &tow.field_nt),
        ("Anomaly", ["Anomaly, nT", "Anomaly, nT"], "nT", "anomaly", &tow.anomaly_nt),
        ("Noise", ["Noise of the anomaly, nT", "Noise of the anomaly, nT"], "nT", "noise", &tow.anomaly_std_nt),
        ("Smallest moment", ["Smallest moment found, A m²"; 2], "A m²", "reach", &tow.smallest_moment_am2),
    ];
    let chart = |(name, titles, unit, class, values): (&str, [&'static str; 2], _, &'static str, &[f64])| {
        let x = time_axis(tow, offset_s)?;
        let y = Axis::around(values.iter().copied(), unit, 5)?;
        let d = path(tow.time_s.iter().copied().zip(values.iter().copied()), GAP_S, [&x, &y], columns);
        let marks = if class == "anomaly" { marks(report, index, &x) } else { Vec::new() };
        let lines = vec![Line { name: "", class, d }];
        Some(Plot {
            label: format!("{name} of {} over time", tow.name),
            title: titles[kind],
            class,
            x,
            y,
            lines,
            marks,
        })
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
