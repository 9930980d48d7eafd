//! Fluxgate: counts to body axes, and the mean over an epoch.

use proptest::prelude::*;
use towmag::sensors::decimator::{Decimator, DecimatorState, WindowFault};
use towmag::sensors::fluxgate::FluxgateSettings;

/// Conversions every 4 ms from `start_us` on, all four channels alike.
fn conversions(start_us: u32, counts: impl IntoIterator<Item = i32>) -> DecimatorState {
    let mut state = DecimatorState::new();
    for (count, at) in counts.into_iter().zip(0_u32..) {
        state.push([count; 4], start_us.wrapping_add(at * 4_000));
    }
    state
}

#[test]
fn scale_bias_and_axes() {
    let settings = FluxgateSettings {
        nt_per_count: [0.5, 0.25, 0.125],
        bias_nt: [10.0, -20.0, 30.0],
        // x and y swapped, z reversed and leaning towards x.
        body_from_sensor: [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.25, 0.0, -1.0]],
        ampere_per_count: 0.001,
        current_bias_a: 0.5,
    };
    let fluxgate = settings.build().unwrap();
    // Sensor axes: 490, 520, 470 nT.
    assert_eq!(fluxgate.convert(&[1000.0, 2000.0, 4000.0]), [520.0, 490.0, 490.0 * 0.25 - 470.0]);
    assert!((fluxgate.current_a(2500.0) - 2.0).abs() < 1e-6);
}

#[test]
fn default_scale_is_100_ut_for_10_v() {
    let fluxgate = FluxgateSettings::default().build().unwrap();
    // 10 V behind the divider by 8.5 is 1.17647 V of 1.2 V full scale.
    let count = (10.0 / 8.5 / 1.2 * 8_388_608.0) as f32;
    assert!((fluxgate.convert(&[count, 0.0, 0.0])[0] - 100_000.0).abs() < 0.05);
}

#[test]
fn wrong_calibrations_are_refused() {
    let good = FluxgateSettings::default();
    let plane = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.1]];
    for wrong in [
        FluxgateSettings { nt_per_count: [0.0, 1.0, 1.0], ..good },
        FluxgateSettings { bias_nt: [f64::NAN, 0.0, 0.0], ..good },
        FluxgateSettings { body_from_sensor: plane, ..good },
        FluxgateSettings { body_from_sensor: [[f64::INFINITY; 3]; 3], ..good },
        FluxgateSettings { ampere_per_count: 2.0, ..good },
        FluxgateSettings { current_bias_a: f64::NAN, ..good },
    ] {
        assert!(wrong.build().is_err(), "{wrong:?}");
    }
    let reversed = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    assert!(FluxgateSettings { body_from_sensor: reversed, ..good }.build().is_ok());
    for wrong in [0, 2, 24, 27] {
        assert!(Decimator::new(wrong).is_err());
    }
}

#[test]
fn equal_counts_give_that_count() {
    let decimator = Decimator::new(25).unwrap();
    for count in [-8_388_607, -8_388_605, -1, 0, 1, 4_194_305, 8_388_606] {
        let state = conversions(0, [count; 60]);
        for center_us in [100_000, 101_234, 102_000, 103_999] {
            assert_eq!(decimator.mean_at(&state, center_us).unwrap().counts, [count as f32; 4]);
        }
    }
}

#[test]
fn mean_belongs_to_the_centre() {
    // A ramp has at every centre the mean that it has there: 1000 counts per conversion, 0.25 per microsecond. Wherever the
    // centre lies between the conversions, and across the wrap of the timer.
    let decimator = Decimator::new(25).unwrap();
    for start_us in [0, u32::MAX - 100_000] {
        let state = conversions(start_us, (0..60).map(|at| at * 1000));
        for after_us in (60_000..160_000).step_by(37) {
            let mean = decimator.mean_at(&state, start_us.wrapping_add(after_us)).unwrap();
            // Weights go in steps of 1/256 of a conversion, to which the other end adds nothing.
            assert!((mean.counts[0] - after_us as f32 * 0.25).abs() <= 2.0 + 0.05, "{after_us}: {mean:?}");
        }
    }
}

#[test]
fn noise_averages_over_25() {
    let decimator = Decimator::new(25).unwrap();
    let alternating = conversions(0, (0..60).map(|at| if at % 25 == 0 { 2500 } else { 0 }));
    // One full conversion of 25 inside, wherever the window lies.
    for center_us in [100_000, 104_000, 112_000] {
        assert_eq!(decimator.mean_at(&alternating, center_us).unwrap().counts[0], 100.0);
    }
}

#[test]
fn incomplete_windows_have_no_mean() {
    let decimator = Decimator::new(25).unwrap();
    let incomplete = Err(WindowFault::Incomplete);
    assert_eq!(decimator.mean_at(&DecimatorState::new(), 0), incomplete);
    let state = conversions(0, 0..60);
    assert!(decimator.mean_at(&state, 52_000).is_ok());
    assert!(decimator.mean_at(&state, 48_000).is_ok()); // exactly 12 conversions before
    assert!(decimator.mean_at(&state, 48_100).is_ok());
    assert_eq!(decimator.mean_at(&state, 47_900), incomplete);
    assert!(decimator.mean_at(&state, 188_000).is_ok()); // exactly 12 after
    assert_eq!(decimator.mean_at(&state, 188_100), incomplete);
    assert_eq!(decimator.mean_at(&state, 1_000_000), incomplete);
    for (missing, center_us, complete) in
        [(30, 100_000, false), (30, 171_000, false), (30, 172_000, true), (30, 120_000, false)]
    {
        let mut state = DecimatorState::new();
        for at in (0..60).filter(|at| *at != missing) {
            state.push([0; 4], at * 4_000);
        }
        assert_eq!(decimator.mean_at(&state, center_us).is_ok(), complete, "{missing} {center_us}");
    }
    // One conversion read twice.
    let mut state = DecimatorState::new();
    for at in [&(0..30_u32).collect::<Vec<_>>()[..], &(29..60).collect::<Vec<_>>()[..]].concat() {
        state.push([0; 4], at * 4_000);
    }
    assert_eq!(decimator.mean_at(&state, 100_000), incomplete);
}

#[test]
fn clipped_axes_are_told() {
    let decimator = Decimator::new(25).unwrap();
    for rail in [8_388_607, -8_388_608] {
        let state = conversions(0, (0..60).map(|at| if at == 30 { rail } else { 0 }));
        assert_eq!(decimator.mean_at(&state, 100_000), Err(WindowFault::Clipped));
    }
    let mut state = DecimatorState::new();
    for at in 0..60 {
        state.push([0, 0, 0, 8_388_607], at * 4_000);
    }
    assert!(decimator.mean_at(&state, 100_000).is_ok(), "the current does not make the field wrong");
}

#[test]
fn one_conversion_to_an_epoch_is_taken_as_it_is() {
    let decimator = Decimator::new(1).unwrap();
    let mut state = DecimatorState::new();
    for at in 0..5 {
        state.push([at; 4], 100_000 * at as u32);
    }
    let mean = decimator.mean_at(&state, 210_000).unwrap();
    assert_eq!((mean.counts, mean.phase_us), ([2.0; 4], -10_000));
    assert_eq!(decimator.mean_at(&state, 480_000), Err(WindowFault::Incomplete));
}

proptest! {
    /// Any stamps and counts: no panic, and a mean between the least and the greatest count.
    #[test]
    fn any_conversions_do_no_harm(
        steps in proptest::collection::vec((3_500..4_500_u32, -8_388_607..8_388_607_i32), 0..250),
        start_us in any::<u32>(),
        center_us in 0..1_000_000_u32,
    ) {
        let decimator = Decimator::new(25).unwrap();
        let mut state = DecimatorState::new();
        let mut stamp_us = start_us;
        for (step_us, count) in steps {
            state.push([count; 4], stamp_us);
            stamp_us = stamp_us.wrapping_add(step_us);
        }
        if let Ok(mean) = decimator.mean_at(&state, start_us.wrapping_add(center_us)) {
            prop_assert!(mean.counts.iter().all(|count| count.abs() <= 8_388_607.0));
        }
    }
}
