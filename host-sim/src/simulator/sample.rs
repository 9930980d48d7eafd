//! The two recordings that ship with the project: a calibration on land and a survey at sea with two targets.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::motion::{Course, Motion, Oscillation};
use super::{EarthField, Scenario, Target};

/// Coefficients of a steel-framed body, in the units of eq. (4); the order of magnitude of real ones.
const BODY: [f64; 18] = [
    26.0, -36.0, 95.0, -0.0112, -0.0005, 0.0048, -0.0014, 0.0009, -0.0101, -0.0062, -0.0017, 0.0009, 0.0012, -0.0041,
    0.0002, -0.0044, -0.0015, -0.0053,
];

/// A calibration: four headings, roll, pitch and yaw one after the other on each, 6 minutes.
pub fn sample_calibration() -> Scenario {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let course = Course { first_heading_deg: 0.0, leg_s: 75.0, turn_s: 15.0, turn_deg: 90.0, alternates: false };
    let rocking = |rms_deg, random: &mut ChaCha8Rng| Oscillation::random(rms_deg, 0.12, 0.18, 3, random);
    let oscillations = [8.0, 6.0, 7.0].map(|rms_deg| rocking(rms_deg, &mut random));
    Scenario {
        seed: 11,
        duration_s: 360.0,
        motion: Motion { course, oscillations, one_by_one: 1.0 },
        field: EarthField {
            strength_nt: 52_295.0,
            inclination_deg: 66.0,
            declination_deg: 3.0,
            geology_nt: 0.5,
            geology_period_s: 600.0,
        },
        coefficients: BODY,
        targets: Vec::new(),
        scalar_noise_nt: 0.03,
        flux_noise_nt: 0.5,
    }
}

/// A survey: legs and turns at sea, 10 minutes, another place, the body's iron a little changed, two targets.
pub fn sample_survey() -> Scenario {
    let course = Course { first_heading_deg: 40.0, leg_s: 110.0, turn_s: 40.0, turn_deg: 180.0, alternates: false };
    let mut coefficients = BODY;
    coefficients[0] += 14.0;
    coefficients[1] -= 9.0;
    coefficients[4] += 0.0006;
    Scenario {
        seed: 12,
        duration_s: 600.0,
        motion: Motion::tow(course, [5.0, 3.5, 4.0], 2),
        field: EarthField {
            strength_nt: 48_573.0,
            inclination_deg: 41.0,
            declination_deg: -5.0,
            geology_nt: 8.0,
            geology_period_s: 900.0,
        },
        coefficients,
        targets: vec![
            Target { time_s: 371.0, peak_nt: 6.0, width_s: 2.0 },
            Target { time_s: 507.0, peak_nt: 9.0, width_s: 1.6 },
        ],
        scalar_noise_nt: 0.03,
        flux_noise_nt: 0.5,
    }
}
