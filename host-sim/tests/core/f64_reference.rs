//! The f32 core against the f64 reference over 24 hours of a generated recording.

use super::reference::{Batch, FrontEnd, Recursion, Vector};
use host_sim::simulator::{Course, EarthField, Motion, Scenario};
use towmag::estimate::Calibration;
use towmag::model::Coefficients;
use towmag::{Epoch, Method, Pipeline, Settings};

const DAY: usize = 864_000;
const HOUR: usize = 36_000;

/// What the requirement allows, nT rms.
const ALLOWED_NT: f64 = 0.001;

/// A day of towing legs in waves, with the collinearity of a real body: the coefficients are those that fluxgate C and
/// scalar 4 of a real calibration flight gave, where the sum of the induced xx, yy, zz terms hides 15,000 nT.
fn day() -> Scenario {
    let course = Course { first_heading_deg: 20.0, leg_s: 280.0, turn_s: 40.0, turn_deg: 130.0, alternates: false };
    Scenario {
        seed: 5,
        duration_s: DAY as f64 / 10.0,
        motion: Motion::tow(course, [6.0, 4.0, 5.0], 6),
        field: EarthField {
            strength_nt: 52_379.0,
            inclination_deg: 68.0,
            declination_deg: 4.0,
            geology_nt: 20.0,
            geology_period_s: 1700.0,
        },
        coefficients: [
            26.57, -35.61, 295.55, -0.3125, -0.0005, 0.0048, -0.2914, 0.0009, -0.3015, -0.068, -0.0017, 0.0009, 0.0012,
            -0.0636, 0.0002, -0.0044, -0.0015, -0.0714,
        ],
        targets: Vec::new(),
        scalar_noise_nt: 0.05,
        flux_noise_nt: 1.0,
    }
}

/// Every 997th epoch without a scalar reading, and half a minute lost every two hours.
fn epochs(scenario: &Scenario) -> impl Iterator<Item = Epoch> + '_ {
    scenario.samples().map(|sample| {
        let tick = sample.epoch.tick;
        let dropped = tick % 997 == 996 || tick % 72_000 > 71_700;
        Epoch { scalar_pt: sample.epoch.scalar_pt.filter(|_| !dropped), ..sample.epoch }
    })
}

/// Sum of squared differences, per hour.
#[derive(Default)]
struct Difference {
    hours: Vec<(f64, usize)>,
}

impl Difference {
    fn add(&mut self, index: usize, difference_nt: f64) {
        self.hours.resize(self.hours.len().max(index / HOUR + 1), (0.0, 0));
        let (sum, count) = &mut self.hours[index / HOUR];
        *sum += difference_nt * difference_nt;
        *count += 1;
    }

    fn rms_of(hours: &[(f64, usize)]) -> f64 {
        let (sum, count) = hours.iter().fold((0.0, 0), |total, hour| (total.0 + hour.0, total.1 + hour.1));
        (sum / count as f64).sqrt()
    }

    fn check(&self, name: &str) {
        let hours = self.hours.len();
        let (all, first, last) =
            (Self::rms_of(&self.hours), Self::rms_of(&self.hours[..1]), Self::rms_of(&self.hours[hours - 1..]));
        println!(
            "{name}: difference of the residual {all:.6} nT rms over {hours} h, first hour {first:.6}, last {last:.6}"
        );
        assert!(all <= ALLOWED_NT, "{name}: {all} nT rms");
        assert!(last <= ALLOWED_NT && last <= 1.5 * first, "{name}: drifts from {first} to {last} nT rms");
    }
}

/// Coefficients of the first ten minutes, from the reference.
fn calibrated(scenario: &Scenario) -> Coefficients {
    let (mut front_end, mut batch) = (FrontEnd::default(), Batch::default());
    for epoch in epochs(scenario).take(6000) {
        if let Some(row) = front_end.step(&epoch).filter(|row| row.settled) {
            batch.add(&row.x, row.y);
        }
    }
    let beta = batch.elastic_net(0.001, 0.025);
    Coefficients::from_paper_units(std::array::from_fn(|i| beta[i])).unwrap()
}

#[test]
fn a_day_of_every_recursion() {
    let scenario = day();
    let start = calibrated(&scenario);
    let beta = Vector::from_row_slice(&start.to_paper_units());
    let pipeline = |method| Pipeline::new(&Settings { method, ..Settings::default() }, start).unwrap();
    let mut core = [Method::Fixed, Method::Rls, Method::SaddlePoint].map(pipeline);
    let mut recursions = [Recursion::rls(beta), Recursion::saddle_point(beta)];
    let mut front_end = FrontEnd::default();
    let mut differences = [(); 3].map(|()| Difference::default());
    for (index, epoch) in epochs(&scenario).enumerate() {
        let row = front_end.step(&epoch);
        let outputs = core.each_mut().map(|pipeline| pipeline.step(&epoch));
        let Some(row) = row else {
            assert!(outputs.iter().all(|output| output.compensated.is_none()), "{epoch:?}");
            continue;
        };
        let predictions = [beta, recursions[0].beta, recursions[1].beta];
        for ((output, beta), difference) in outputs.iter().zip(predictions).zip(&mut differences) {
            let residual_nt = output.compensated.expect("the core rejects what the reference takes").residual_nt;
            difference.add(index, f64::from(residual_nt) - (row.y - row.x.dot(&beta)));
        }
        if row.settled {
            recursions.iter_mut().for_each(|recursion| recursion.update(&row.x, row.y));
        }
    }
    for (difference, name) in differences.iter().zip(["fixed", "rls", "saddle-point"]) {
        difference.check(name);
    }
}

#[test]
fn a_day_of_calibration() {
    let scenario = day();
    let mut core = Calibration::new(&Settings::default()).unwrap();
    let (mut front_end, mut batch, mut used) = (FrontEnd::default(), Batch::default(), 0_u32);
    for epoch in epochs(&scenario) {
        let counted = core.step(&epoch);
        let row = front_end.step(&epoch).filter(|row| row.settled);
        assert_eq!(counted.unwrap_or(false), row.is_some());
        if let Some(row) = row {
            batch.add(&row.x, row.y);
            used += 1;
        }
    }
    let result = core.solve().unwrap();
    let change = Vector::from_row_slice(&result.coefficients.to_paper_units()) - batch.elastic_net(0.001, 0.025);
    // The two residuals differ by x' change at every epoch; the Gram matrix sums the squares of it.
    let rms_nt = (change.dot(&(batch.gram * change)) / f64::from(used)).sqrt();
    println!("elastic net of {used} epochs: difference of the residual {rms_nt:.6} nT rms");
    assert_eq!(result.used_epochs, used);
    assert!(rms_nt <= ALLOWED_NT, "{rms_nt} nT rms");
}
