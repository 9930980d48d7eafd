//! The band-pass against scipy, and its start in steady state.

use towmag::filter::{BandPassDesign, BandPassError, BandPassState};

/// `sosfilt(butter(order, [low, high], btype="band", fs=rate, output="sos"), impulse)` at samples 0, 1, 2, 5, 11, 23, 59,
/// scipy 1.17.
const SCIPY: [(usize, f64, f64, f64, [f64; 7]); 6] = [
    (
        1,
        0.5,
        2.0,
        10.0,
        [0.337540151884, 0.354910718869, -0.0740383816318, -0.125501142905, 0.00228002008191, -4.39144290763e-06, 0.0],
    ),
    (
        2,
        0.1,
        0.9,
        10.0,
        [
            0.0461318020933,
            0.149810224962,
            0.2094320609,
            0.0450670696611,
            -0.0781228147755,
            -0.0225023191852,
            0.00730753987311,
        ],
    ),
    (
        3,
        0.05,
        1.2,
        8.0,
        [
            0.044666253717,
            0.185450963458,
            0.314021851244,
            -0.0629302951988,
            -0.0431934980541,
            -0.0269933916737,
            0.00793337190677,
        ],
    ),
    (
        5,
        1.0,
        4.0,
        20.0,
        [
            0.00693319613014,
            0.0383829147124,
            0.0771570424386,
            -0.261040658855,
            -0.0177363629765,
            0.0336801290898,
            -0.0013969379762,
        ],
    ),
    (
        8,
        0.3,
        2.0,
        10.0,
        [
            0.000805614255663,
            0.00740430083064,
            0.0292611077169,
            -0.0372494803266,
            0.232821391909,
            -0.061778955663,
            0.0127107456945,
        ],
    ),
    (
        1,
        0.01,
        4.5,
        10.0,
        [
            0.860876758356,
            0.230218215841,
            -0.177970292514,
            0.0597051779236,
            0.0037852910925,
            -0.00523969603766,
            -0.0043440331921,
        ],
    ),
];

#[test]
fn impulse_response_is_scipys() {
    for (order, low_hz, high_hz, sample_rate_hz, expected) in SCIPY {
        let filter = BandPassDesign { low_hz, high_hz, order, sample_rate_hz }.build().unwrap();
        let mut state = BandPassState::steady(&[0.0]);
        let response: Vec<f32> =
            (0..60).map(|n| filter.step(&mut state, &[if n == 0 { 1.0 } else { 0.0 }])[0]).collect();
        for (n, expected) in [0, 1, 2, 5, 11, 23, 59].into_iter().zip(expected) {
            let error = (f64::from(response[n]) - expected).abs();
            assert!(error < 1e-6, "order {order}, sample {n}: {} is not {expected}", response[n]);
        }
    }
}

#[test]
fn a_constant_leaves_no_transient() {
    let filter = BandPassDesign::default().build().unwrap();
    let input = [50_000.0, -0.7, 0.0];
    let mut state = BandPassState::steady(&input);
    for _ in 0..1000 {
        assert_eq!(filter.step(&mut state, &input), [0.0; 3]);
    }
}

#[test]
fn settling_is_the_time_of_the_slowest_pole() {
    // 0.9800799967775359 is the largest pole of scipy's design.
    let samples = BandPassDesign::default().build().unwrap().settling_samples(1e-3);
    assert_eq!(samples, (1e-3_f64.ln() / 0.9800799967775359_f64.ln()).ceil() as u32);
}

#[test]
fn impossible_designs_are_refused() {
    let good = BandPassDesign::default();
    for order in [0, 9] {
        assert_eq!(BandPassDesign { order, ..good }.build().err(), Some(BandPassError::Order(order)));
    }
    let bands = [(0.0, 0.9), (-0.1, 0.9), (0.9, 0.9), (0.9, 0.1), (0.1, 5.0), (f64::NAN, 0.9), (0.1, f64::NAN)];
    for (low_hz, high_hz) in bands {
        assert!(matches!(BandPassDesign { low_hz, high_hz, ..good }.build(), Err(BandPassError::Band(_))));
    }
    assert!(BandPassDesign { sample_rate_hz: f64::INFINITY, ..good }.build().is_err());
}
