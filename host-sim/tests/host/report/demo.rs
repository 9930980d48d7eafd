//! Data as a survey gives it, made by formula: legs on four headings with turns between them, swell, a target, a gap.

use host_sim::detection::band_pulse;
use host_sim::report::{Kind, ReportData, headline};
use host_sim::run::{Coefficient, MethodCollector, MethodResult, MethodRow, RecordingCollector, Row};
use towmag::filter::BandPassDesign;

const TURN_S: f64 = 60.0;
const LEG_S: f64 = 540.0;

/// What a method leaves: a share of the interference, by heading, and how fast that share fades as it adapts.
struct Method {
    name: &'static str,
    left: f64,
    left_when_turned: f64,
    fades_in_s: f64,
    has_update: bool,
}

const METHODS: [Method; 4] = [
    Method { name: "fixed", left: 0.18, left_when_turned: 0.30, fades_in_s: f64::INFINITY, has_update: false },
    Method { name: "rls", left: 0.04, left_when_turned: 0.12, fades_in_s: 900.0, has_update: true },
    Method { name: "saddle-point", left: 0.025, left_when_turned: 0.10, fades_in_s: 400.0, has_update: true },
    Method { name: "adaptive", left: 0.01, left_when_turned: 0.05, fades_in_s: 120.0, has_update: true },
];

/// Uniform in -1 to 1, the same on every run.
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}

fn heading_deg(time_s: f64) -> f64 {
    let leg = (time_s / (LEG_S + TURN_S)).floor();
    let into_turn = ((time_s - leg * (LEG_S + TURN_S) - LEG_S) / TURN_S).max(0.0);
    20.0 + 90.0 * (leg + into_turn) + 6.0 * (time_s / 9.0).sin()
}

/// Direction of the field in a body that rolls with the swell.
fn flux_nt(time_s: f64) -> [f64; 3] {
    let (sine, cosine) = (0.1 * (time_s * 0.95).sin()).sin_cos();
    [20_000.0, 15_000.0 * cosine + 40_000.0 * sine, 40_000.0 * cosine - 15_000.0 * sine]
}

fn interference_nt(time_s: f64) -> f64 {
    let towards = (heading_deg(time_s).to_radians() - 0.6).cos();
    let swell = (time_s * 0.95).sin() * (1.0 + 0.4 * (time_s / 37.0).sin());
    (12.0 + 6.0 * towards) * swell + 4.0 * (time_s * 1.9 + 1.0).sin()
}

/// A wreck's nail box: one pulse, a few seconds long.
fn target_nt(time_s: f64) -> f64 {
    2.5 * (-((time_s - 1_234.0) / 3.0).powi(2)).exp()
}

fn row(time_s: f64, noise_nt: f64) -> Row {
    let interference_nt = interference_nt(time_s);
    let constant_and_geology_nt =
        48_215.0 + 22.0 * (time_s / 700.0).sin() + 60.0 * (heading_deg(time_s).to_radians()).cos();
    Row {
        time_s,
        heading_deg: Some(heading_deg(time_s)),
        flux_nt: Some(flux_nt(time_s)),
        scalar_nt: constant_and_geology_nt + interference_nt + target_nt(time_s) + noise_nt,
        band_passed_nt: (time_s > 30.0).then_some(interference_nt + target_nt(time_s) + noise_nt),
    }
}

fn method_row(method: &Method, row: &Row, noise_nt: f64) -> MethodRow {
    let turned = (row.heading_deg.unwrap_or(0.0) - 20.0).to_radians().sin().abs();
    let adapting = (-row.time_s / method.fades_in_s).exp();
    let left = method.left + (method.left_when_turned - method.left) * turned.max(adapting);
    let residual_nt = left * interference_nt(row.time_s + 0.3) + target_nt(row.time_s) + noise_nt;
    MethodRow {
        compensated_nt: row.scalar_nt - interference_nt(row.time_s) + left * interference_nt(row.time_s) - 731.0,
        residual_nt,
        residual_after_update_nt: method.has_update.then_some(0.9 * residual_nt),
    }
}

fn coefficients(spread: f64) -> [Coefficient; 18] {
    std::array::from_fn(|i| {
        let unit = [12.0, 3e-4, 2e-5][usize::from(i >= 3) + usize::from(i >= 9)];
        let value = unit * ((i * i) as f64 * 1.3 + 0.4).sin() * (1.0 + 0.1 * spread);
        Coefficient { value, std: unit * 0.08 * spread * (1.0 + (i % 4) as f64) }
    })
}

/// A report of `kind` on `rows` epochs.
pub(crate) fn report(kind: Kind, rows: u32) -> ReportData {
    let methods: &[Method] = if kind == Kind::Compare { &METHODS } else { &METHODS[2..3] };
    let mut noise = Noise(1);
    let mut recording = RecordingCollector::new(10.0);
    let mut collectors: Vec<_> = methods.iter().map(|_| MethodCollector::new(10.0)).collect();
    for tick in (0..rows).filter(|tick| !(14_000..14_900).contains(tick)) {
        let noise_nt = 0.05 * noise.next();
        let row = row(f64::from(tick) * 0.1, noise_nt);
        recording.push(&row);
        for (collector, method) in collectors.iter_mut().zip(methods) {
            collector.push(&row, &method_row(method, &row, noise_nt));
        }
    }
    let finish = |(i, (collector, method)): (usize, (&MethodCollector, &Method))| {
        collector.finish(method.name, Some(coefficients(1.0 + i as f64)))
    };
    let methods: Vec<MethodResult> = collectors.iter().zip(methods).enumerate().map(finish).collect();
    ReportData {
        detection: Vec::new(),
        targets: None,
        marks: Vec::new(),
        marks_note: None,
        utc_offset_s: None,
        pulse: band_pulse(BandPassDesign::default(), 2.0).ok(),
        title: "towmag: line_07 <North & South>.csv".into(),
        kind,
        recording: "line_07 <North & South>.csv".into(),
        facts: facts(rows),
        warnings: vec!["1 gap of 90 s: the band-pass settled anew after it, which costs 300 rows.".into()],
        headline: headline(&methods, None),
        band_hz: [0.1, 0.9],
        uncompensated: recording.finish(),
        methods,
    }
}

fn facts(rows: u32) -> Vec<(String, String)> {
    let fact = |label: &str, value: String| (label.to_owned(), value);
    vec![
        fact("Duration", format!("{} s", rows / 10)),
        fact("Rows", rows.to_string()),
        fact("Used rows", rows.saturating_sub(1_500).to_string()),
        fact("Gaps", "1 (90 s)".into()),
        fact("Band", "0.1 to 0.9 Hz".into()),
        fact("Settings", "lambda1 0.001, lambda2 0.025, forgetting 0.9999, dual step 0.9".into()),
        fact(
            "Coefficients",
            "/survey/2026-05-12/a_rather_long_directory_name/calibration_after_the_new_tail/coefficients.toml".into(),
        ),
        fact("Version", "0.1.0".into()),
    ]
}
