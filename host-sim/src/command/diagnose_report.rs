//! What the page of a diagnosis says beside the findings: facts, warnings, what could not be tested.

use super::diagnose_options::DiagnoseOptions;
use crate::diagnosis::{Diagnosis, Prepared};
use crate::effects::Column;
use crate::effects::Library;
use crate::message::file_name;
use crate::report::DiagnosisReport;
use crate::text::diagnosis as words;
use crate::text::number::group;
use crate::text::replay;

/// Rows per minute.
const ROWS_PER_MIN: f64 = 600.0;
/// Valid rows below which weak effects do not show, minutes.
const SHORT_MIN: f64 = 10.0;

/// Everything on the page.
pub(super) fn diagnosis_report<'a>(
    recording: &str,
    table: &Prepared,
    options: &'a DiagnoseOptions<'_>,
    diagnosis: &'a Diagnosis,
) -> DiagnosisReport<'a> {
    let recording = recording.to_string();
    let used = table.usable.iter().filter(|&&usable| usable).count();
    DiagnosisReport {
        title: format!("Diagnosis: {recording}"),
        recording,
        diagnosis,
        withheld: &options.withheld,
        untested: untested(table),
        warnings: warnings(table, used),
        facts: facts(table, used, options, diagnosis),
    }
}

fn untested(table: &Prepared) -> Vec<(&'static str, &'static str)> {
    let lacks = |column: Column| match column {
        Column::Depth => table.depth_m.is_none().then_some("depth_m"),
        Column::Temperature => table.temperature_deg_c.is_none().then_some("temperature_degC"),
    };
    Library::default().specs().filter_map(|spec| Some((spec.name, lacks(spec.needs?)?))).collect()
}

fn warnings(table: &Prepared, used: usize) -> Vec<String> {
    let rows = table.len();
    let mut warnings = table.bad_rows.sentences();
    let minutes = used as f64 / ROWS_PER_MIN;
    if minutes < SHORT_MIN {
        warnings.push(format!(
            "Only {minutes:.1} minutes of valid rows: weak effects do not show. Better are 10 minutes with manoeuvres."
        ));
    }
    let lost = rows - used;
    if lost * 20 > rows {
        let (lost, rows) = (group(lost as i64), group(rows as i64));
        warnings.push(format!("{lost} of {rows} rows could not be used: missing or invalid readings."));
    }
    warnings
}

fn facts(table: &Prepared, used: usize, options: &DiagnoseOptions<'_>, diagnosis: &Diagnosis) -> Vec<(String, String)> {
    let fact = |label: &str, value: String| (label.to_string(), value);
    let minutes = table.time_s.last().zip(table.time_s.first()).map_or(0.0, |(last, first)| (last - first) / 60.0);
    let recorded = |name: &str, there: bool| there.then(|| name.to_string());
    let mut columns: Vec<String> = [
        recorded("heading", table.heading_deg.is_some()),
        recorded("depth", table.depth_m.is_some()),
        recorded("temperature", table.temperature_deg_c.is_some()),
    ]
    .into_iter()
    .flatten()
    .collect();
    columns.extend(table.currents_a.iter().map(|(load, _)| format!("current of {load}")));
    let columns = if columns.is_empty() { "none".into() } else { columns.join(", ") };
    let mut facts = vec![
        fact("Duration", format!("{minutes:.1} min")),
        fact("Rows", group(table.len() as i64)),
        fact("Rows used", group(used as i64)),
        fact("Recorded beside the sensors", columns),
        fact("Effects in the library", (diagnosis.specs.len() - options.withheld.len()).to_string()),
    ];
    facts.extend(options.coefficients.map(|path| fact("Coefficients", file_name(path))));
    facts.extend(options.confirm.map(|path| fact("Second recording", file_name(path))));
    facts.extend(diagnosis.simulation.iter().map(|used| fact("Held against", words::simulation(used))));
    facts.extend(diagnosis.exact_replay.iter().map(|session| fact("Exact replay", replay::session(session))));
    facts.push(fact("Seed", options.seed.to_string()));
    facts.push(fact("Program", format!("host-sim {}", env!("CARGO_PKG_VERSION"))));
    facts
}
