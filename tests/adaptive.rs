//! The adaptive method: the f32 core against the equations in f64, and a day in which much goes wrong.

mod reference;

use host_sim::simulator::{Course, EarthField, Motion, Scenario, Target, sample_calibration};
use reference::adaptive::Adaptive;
use reference::{Batch, FrontEnd, Vector};
use towmag::compensation::{Adaptation, Calibration, CalibrationResult, Coefficients};
use towmag::{Epoch, Method, Pipeline, Settings};

/// What the requirement allows, nT rms.
const ALLOWED_NT: f64 = 0.001;

fn settings() -> Settings {
    Settings { method: Method::Adaptive, ..Settings::default() }
}

/// A tow in waves after `seed`, with the body of the sample a little changed.
fn tow(seed: u64, duration_s: f64) -> Scenario {
    let course = Course { first_heading_deg: 20.0, leg_s: 160.0, turn_s: 40.0, turn_deg: 130.0 };
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
    let solution = reference::solve(&batch.gram, &batch.q);
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

#[test]
fn two_hours_against_f64() {
    let scenario = sample_calibration();
    let (batch, solution, noise_nt) = calibrate_f64(&scenario);
    let mut oracle = Adaptive::new(&batch.gram, solution, noise_nt);
    let mut core = Pipeline::new(&settings(), calibrate(&scenario).prior()).unwrap();
    let mut front_end = FrontEnd::default();
    let (mut squares, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
    for epoch in troubled() {
        let output = core.step(&epoch);
        let Some(row) = front_end.step(&epoch) else { continue };
        let residual_nt = f64::from(output.compensated.unwrap().residual_nt);
        let difference_nt = residual_nt - (row.y - row.x.dot(&oracle.beta));
        squares += difference_nt * difference_nt;
        worst = worst.max(difference_nt.abs());
        count += 1.0;
        if row.settled {
            oracle.update(&row.x, row.y);
        }
    }
    let rms_nt = f64::sqrt(squares / count);
    println!("adaptive: difference of the residual {rms_nt:.6} nT rms, {worst:.6} nT at most, over {count} epochs");
    assert!(rms_nt <= ALLOWED_NT, "{rms_nt} nT rms");
}

/// Root mean square of the residual over that of the true coefficients' own, between two times.
struct Window {
    from_s: f64,
    to_s: f64,
    residual: f64,
    bound: f64,
}

impl Window {
    fn ratio(&self) -> f64 {
        (self.residual / self.bound).sqrt()
    }
}

/// Coefficients that turn slowly, other ones from noon on, dropouts, spikes.
#[test]
fn a_day_with_a_move_at_noon() {
    const DAY_S: f64 = 86_400.0;
    const NOON_S: f64 = 43_200.0;
    let (scenario, mut core) =
        (tow(7, DAY_S), Pipeline::new(&settings(), calibrate(&sample_calibration()).prior()).unwrap());
    let mut front_end = FrontEnd::default();
    let mut windows: Vec<Window> = (0..24)
        .map(|hour| 3600.0 * f64::from(hour))
        .map(|start_s| Window { from_s: start_s + 160.0, to_s: start_s + 3600.0, residual: 0.0, bound: 0.0 })
        .collect();
    let (mut relearning, mut surprised) = (0, 0);
    let mut moved = scenario.clone();
    moved.coefficients = elsewhere(&scenario.coefficients);
    let turned = |base: &Scenario, time_s: f64| -> [f64; 18] {
        let (sin, cos) = (time_s / DAY_S * 0.8).sin_cos();
        let mut beta = base.coefficients;
        (beta[0], beta[1]) = (cos * beta[0] - sin * beta[1], sin * beta[0] + cos * beta[1]);
        beta
    };
    let mut samples = Scenario { coefficients: [0.0; 18], ..scenario.clone() };
    samples.seed = 70;
    for (tick, sample) in (0_u32..).zip(samples.samples()) {
        let time_s = f64::from(tick) / 10.0;
        let base = if time_s < NOON_S { &scenario } else { &moved };
        let with = Scenario { coefficients: turned(base, time_s), ..base.clone() };
        let interference_nt = with.interference_at_nt(time_s);
        let spike_pt = if tick % 7001 == 7000 { 3_000_000 } else { 0 };
        let scalar_pt = sample.epoch.scalar_pt.map(|pt| pt + (interference_nt * 1000.0).round() as i32 + spike_pt);
        let dropped = tick % 997 == 996 || tick % 40_000 > 39_700;
        let epoch = Epoch { scalar_pt: scalar_pt.filter(|_| !dropped), ..sample.epoch };
        let output = core.step(&epoch);
        let row = front_end.step(&epoch);
        let (Some(compensated), Some(row)) = (output.compensated, row) else { continue };
        assert!(compensated.residual_nt.abs() < 1e5, "diverges at {time_s} s");
        let adaptation = core.quality().unwrap().adaptation;
        relearning += u32::from(adaptation == Adaptation::Relearning);
        surprised += u32::from(adaptation == Adaptation::Surprised);
        // A spike rings in the filter for 20 s.
        let quiet = row.settled && tick % 7001 > 300 && tick % 7001 < 7000;
        let window = windows.iter_mut().find(|window| (window.from_s..window.to_s).contains(&time_s));
        if let (true, Some(window)) = (quiet, window) {
            let truth_nt = row.y - row.x.dot(&Vector::from_row_slice(&turned(base, time_s)));
            window.residual += f64::from(compensated.residual_nt).powi(2);
            window.bound += truth_nt * truth_nt;
        }
    }
    let ratios: Vec<f64> = windows.iter().map(Window::ratio).collect();
    println!("residual over that of the true coefficients, hour by hour: {ratios:.3?}");
    println!("{relearning} epochs relearning, {surprised} surprised");
    assert!(ratios.iter().all(|&ratio| ratio <= 1.05), "{ratios:.3?}");
    assert!(relearning > 0);
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
