//! The adaptive method: the f32 core against the equations in f64, and a day in which much goes wrong.

use super::reference::adaptive::Adaptive;
use super::reference::{Batch, FrontEnd, Vector};
use host_sim::simulator::{Course, EarthField, Motion, Scenario, Target, sample_calibration};
use towmag::estimate::{Adaptation, Calibration, CalibrationResult};
use towmag::model::Coefficients;
use towmag::{Epoch, Method, Pipeline, Settings};

/// What the requirement allows, nT rms.
const ALLOWED_NT: f64 = 0.001;

fn settings() -> Settings {
    Settings { method: Method::Adaptive, ..Settings::default() }
}

/// A tow in waves after `seed`, with the body of the sample a little changed.
fn tow(seed: u64, duration_s: f64) -> Scenario {
    let course = Course { first_heading_deg: 20.0, leg_s: 160.0, turn_s: 40.0, turn_deg: 130.0, alternates: false };
    let mut coefficients = sample_calibration().coefficients;
    coefficients[0] += 9.0;
    coefficients[5] -= 0.0004;
    Scenario {
        seed,
        duration_s,
        motion: Motion::tow(course, [6.0, 4.0, 5.0], seed),
        field: EarthField {
            strength_nt: 52_379.0,
            inclination_deg: 68.0,
            declination_deg: 4.0,
            geology_nt: 20.0,
            geology_period_s: 1700.0,
        },
        coefficients,
        targets: Vec::new(),
        scalar_noise_nt: 0.05,
        flux_noise_nt: 1.0,
    }
}

fn calibrate(scenario: &Scenario) -> CalibrationResult {
    let mut calibration = Calibration::new(&Settings::default()).unwrap();
    scenario.samples().for_each(|sample| _ = calibration.step(&sample.epoch));
    calibration.solve().unwrap()
}

/// The same calibration in f64: Gram matrix, least-squares solution, root mean square of the residual.
fn calibrate_f64(scenario: &Scenario) -> (Batch, Vector, f64) {
    let (mut front_end, mut batch, mut squares, mut rows) = (FrontEnd::default(), Batch::default(), 0.0, 0.0);
    for sample in scenario.samples() {
        if let Some(row) = front_end.step(&sample.epoch).filter(|row| row.settled) {
            batch.add(&row.x, row.y);
            squares += row.y * row.y;
            rows += 1.0;
        }
    }
    let solution = super::reference::solve(&batch.gram, &batch.q);
    let noise_nt = ((squares - batch.q.dot(&solution)) / rows).sqrt();
    (batch, solution, noise_nt)
}

/// Coefficients of a sensor that was moved.
fn elsewhere(coefficients: &[f64; 18]) -> [f64; 18] {
    std::array::from_fn(|i| -1.5 * coefficients[i] + if i < 3 { 60.0 } else { 0.004 })
}

/// Dropouts, targets, and an hour after the start a sensor that sits elsewhere.
fn troubled() -> impl Iterator<Item = Epoch> {
    let mut first = tow(3, 7200.0);
    first.targets = (1..70).map(|k| Target { time_s: 97.0 * f64::from(k), peak_nt: 8.0, width_s: 1.5 }).collect();
    let mut second = first.clone();
    second.coefficients = elsewhere(&first.coefficients);
    let before: Vec<Epoch> = first.samples().take(36_000).map(|sample| sample.epoch).collect();
    let after: Vec<Epoch> = second.samples().skip(36_000).map(|sample| sample.epoch).collect();
    before.into_iter().chain(after).map(|epoch| {
        let dropped = epoch.tick % 997 == 996 || epoch.tick % 20_000 > 19_700;
        Epoch { scalar_pt: epoch.scalar_pt.filter(|_| !dropped), ..epoch }
    })
}

/// In the 23 minutes after the move nearly nothing is known to begin with, and two members that disagree are equally
/// probable: rounding decides. There, the difference is held to a hundredth of the residual.
#[test]
fn two_hours_against_f64() {
    let scenario = sample_calibration();
    let (batch, solution, noise_nt) = calibrate_f64(&scenario);
    let mut oracle = Adaptive::new(&batch.gram, solution, noise_nt);
    let mut core = Pipeline::new(&settings(), calibrate(&scenario).prior()).unwrap();
    let mut front_end = FrontEnd::default();
    let mut parts = [(0.0, 0.0, 0.0); 2];
    for epoch in troubled() {
        let output = core.step(&epoch);
        let Some(row) = front_end.step(&epoch) else { continue };
        let residual_nt = f64::from(output.compensated.unwrap().residual_nt);
        let difference_nt = residual_nt - (row.y - row.x.dot(&oracle.beta));
        let (count, residual, difference) = &mut parts[usize::from((36_000..50_000).contains(&epoch.tick))];
        *count += 1.0;
        *residual += residual_nt * residual_nt;
        *difference += difference_nt * difference_nt;
        if row.settled {
            oracle.update(&row.x, row.y);
        }
    }
    let [rms, lost] =
        parts.map(|(count, residual, difference)| [residual, difference].map(|sum| f64::sqrt(sum / count)));
    println!(
        "adaptive: difference of the residual {:.6} nT rms of {:.3} nT over two hours; in the 23 minutes after the \
              move {:.6} nT of {:.3} nT",
        rms[1], rms[0], lost[1], lost[0]
    );
    assert!(rms[1] <= ALLOWED_NT && lost[1] <= 0.01 * lost[0], "{rms:?} {lost:?}");
}

/// Residual over what the best fixed coefficients leave of the same epochs in hindsight, between two times.
struct Window {
    span_s: std::ops::Range<f64>,
    batch: Batch,
    squares: f64,
    residual: f64,
}

impl Window {
    fn new(span_s: std::ops::Range<f64>) -> Self {
        Self { span_s, batch: Batch::default(), squares: 0.0, residual: 0.0 }
    }

    fn add(&mut self, row: &super::reference::Observation, residual_nt: f64) {
        self.batch.add(&row.x, row.y);
        self.squares += row.y * row.y;
        self.residual += residual_nt * residual_nt;
    }

    fn ratio(&self) -> f64 {
        let bound = self.squares - self.batch.q.dot(&super::reference::solve(&self.batch.gram, &self.batch.q));
        (self.residual / bound).sqrt()
    }
}

const DAY_S: f64 = 86_400.0;
const NOON_S: f64 = 43_200.0;

/// Coefficients whose permanent part turns by 46 degrees in a day, and other ones from noon on.
fn turning(before: &Scenario, after: &Scenario, time_s: f64) -> [f64; 18] {
    let mut beta = if time_s < NOON_S { before.coefficients } else { after.coefficients };
    let (sin, cos) = libm::sincos(time_s / DAY_S * 0.8);
    (beta[0], beta[1]) = (cos * beta[0] - sin * beta[1], sin * beta[0] + cos * beta[1]);
    beta
}

/// A day: coefficients that turn, a sensor that is moved at noon, dropouts, spikes of 3,000 nT.
fn day() -> impl Iterator<Item = Epoch> {
    let before = Scenario { seed: 70, ..tow(7, DAY_S) };
    let after = Scenario { coefficients: elsewhere(&before.coefficients), ..before.clone() };
    let quiet = Scenario { coefficients: [0.0; 18], ..before.clone() };
    let epochs: Vec<Epoch> = quiet.samples().map(|sample| sample.epoch).collect();
    epochs.into_iter().map(move |epoch| {
        let time_s = f64::from(epoch.tick) / 10.0;
        let body = Scenario { coefficients: turning(&before, &after, time_s), ..before.clone() };
        let spike_nt = if epoch.tick % 7001 == 7000 { 3000.0 } else { 0.0 };
        let added_pt = ((body.interference_at_nt(time_s) + spike_nt) * 1000.0).round() as i32;
        let dropped = epoch.tick % 997 == 996 || epoch.tick % 40_000 > 39_700;
        Epoch { scalar_pt: epoch.scalar_pt.map(|pt| pt + added_pt).filter(|_| !dropped), ..epoch }
    })
}

/// No divergence; near the bound two minutes after the move, on half of the headings, and soon as good as before.
#[test]
fn a_day_with_a_move_at_noon() {
    let mut core = Pipeline::new(&settings(), calibrate(&sample_calibration()).prior()).unwrap();
    let mut front_end = FrontEnd::default();
    // Two minutes after the filter has settled, by the half hour; and the quarter of an hour after the move.
    let mut windows: Vec<Window> = (0..48)
        .map(|k| 1800.0 * f64::from(k))
        .map(|from_s| Window::new(from_s + 155.0..from_s + 1800.0))
        .chain([Window::new(NOON_S + 120.0..NOON_S + 1020.0)])
        .collect();
    let mut surprised = 0;
    for epoch in day() {
        let output = core.step(&epoch);
        let (Some(compensated), Some(row)) = (output.compensated, front_end.step(&epoch)) else { continue };
        assert!(compensated.residual_nt.abs() < 1e5, "diverges at tick {}", epoch.tick);
        surprised += u32::from(core.quality().unwrap().adaptation == Adaptation::Surprised);
        // A spike rings in the filter for 20 s.
        let quiet = row.settled && epoch.tick % 7001 > 300 && epoch.tick % 7001 < 7000;
        let time_s = f64::from(epoch.tick) / 10.0;
        for window in windows.iter_mut().filter(|window| quiet && window.span_s.contains(&time_s)) {
            window.add(&row, compensated.residual_nt.into());
        }
    }
    let ratios: Vec<f64> = windows.iter().map(Window::ratio).collect();
    println!("residual over the hindsight bound, by the half hour, and after the move: {ratios:.3?}");
    println!("{surprised} epochs surprised");
    let (after_move, half_hours) = ratios.split_last().unwrap();
    assert!(half_hours.iter().all(|&ratio| ratio <= 1.09) && *after_move <= 1.05, "{ratios:.3?}");
    let mean = half_hours.iter().sum::<f64>() / half_hours.len() as f64;
    assert!(mean <= 1.05, "{mean:.3}");
}

/// Without any calibration it gets there as well, and says how it stands.
#[test]
fn from_nothing() {
    let scenario = tow(5, 1200.0);
    let mut core = Pipeline::new(&settings(), Coefficients::ZERO).unwrap();
    assert_eq!(core.quality().unwrap().adaptation, Adaptation::Waiting);
    let outputs: Vec<_> = scenario.samples().map(|sample| core.step(&sample.epoch)).collect();
    let late: Vec<f64> =
        outputs[6000..].iter().filter_map(|output| output.compensated).map(|c| f64::from(c.residual_nt)).collect();
    let rms_nt = (late.iter().map(|r| r * r).sum::<f64>() / late.len() as f64).sqrt();
    let quality = core.quality().unwrap();
    assert!(quality.adapted > 0.9, "{quality:?}");
    let predicted_nt = f64::from(quality.predicted_std_nt);
    assert!((0.5..2.0).contains(&(predicted_nt / rms_nt)), "{predicted_nt} nT predicted, {rms_nt} nT found");
}
