//! What gaps, dropouts and rubbish do to the core: nothing that lasts.

use host_sim::simulator::sample_survey;
use proptest::prelude::*;
use towmag::model::Coefficients;
use towmag::{Epoch, Method, Output, Pipeline, Rejection, Settings, Status};

const METHODS: [Method; 5] = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint, Method::Adaptive];

fn pipeline(method: Method) -> Pipeline {
    Pipeline::new(&Settings { method, ..Settings::default() }, Coefficients::ZERO).unwrap()
}

fn epochs(count: usize) -> Vec<Epoch> {
    sample_survey().samples().take(count).map(|sample| sample.epoch).collect()
}

fn run(method: Method, epochs: &[Epoch]) -> Vec<Output> {
    let mut pipeline = pipeline(method);
    epochs.iter().map(|epoch| pipeline.step(epoch)).collect()
}

#[test]
fn each_kind_of_bad_reading_is_named_and_the_epoch_after_it_has_no_derivative() {
    let good = epochs(40);
    type Spoil = fn(&mut Epoch);
    let spoil: [(Rejection, Spoil); 8] = [
        (Rejection::ScalarMissing, |epoch| epoch.scalar_pt = None),
        (Rejection::ScalarOutOfRange, |epoch| epoch.scalar_pt = Some(999_999)),
        (Rejection::ScalarOutOfRange, |epoch| epoch.scalar_pt = Some(i32::MIN)),
        (Rejection::FluxMissing, |epoch| epoch.flux_nt = None),
        (Rejection::FluxOutOfRange, |epoch| epoch.flux_nt = Some([0.0; 3])),
        (Rejection::FluxOutOfRange, |epoch| epoch.flux_nt = Some([f32::NAN, 50_000.0, 0.0])),
        (Rejection::FluxOutOfRange, |epoch| epoch.flux_nt = Some([f32::INFINITY, 0.0, f32::NEG_INFINITY])),
        (Rejection::FluxOutOfRange, |epoch| epoch.flux_nt = Some([3e38, 3e38, 3e38])),
    ];
    for (rejection, spoil) in spoil {
        let mut epochs = good.clone();
        spoil(&mut epochs[20]);
        let outputs = run(Method::SaddlePoint, &epochs);
        assert_eq!(outputs[0].status, Status::Rejected(Rejection::AfterGap));
        assert_eq!(outputs[20].status, Status::Rejected(rejection));
        assert_eq!(outputs[21].status, Status::Rejected(Rejection::AfterGap));
        assert!(outputs[1..20].iter().chain(&outputs[22..]).all(|output| output.compensated.is_some()));
    }
}

#[test]
fn a_missing_tick_is_a_gap() {
    let mut epochs = epochs(40);
    epochs.remove(20);
    let outputs = run(Method::Rls, &epochs);
    assert_eq!(outputs[20].status, Status::Rejected(Rejection::AfterGap));
    assert_eq!(outputs[20].tick, 21);
}

/// Through a dropout of up to a second the filter is held: what comes after is hardly touched by it.
#[test]
fn a_short_dropout_does_not_start_the_filter_anew() {
    let good = epochs(2000);
    let mut cut = good.clone();
    cut[1000..1009].iter_mut().for_each(|epoch| epoch.scalar_pt = None);
    let (whole, dropped) = (run(Method::None, &good), run(Method::None, &cut));
    let status = |index: usize| dropped[index].status;
    assert_eq!([status(999), status(1010)], [Status::Used; 2]);
    let difference = |index: usize| {
        let nt = |outputs: &[Output]| outputs[index].compensated.unwrap().band_passed_nt;
        (nt(&whole) - nt(&dropped)).abs()
    };
    assert!((1600..2000).all(|index| difference(index) < 0.01), "{}", difference(1600));
}

#[test]
fn a_long_dropout_settles_before_it_is_learnt_from() {
    let mut epochs = epochs(2000);
    epochs[1000..1020].iter_mut().for_each(|epoch| epoch.flux_nt = None);
    let outputs = run(Method::SaddlePoint, &epochs);
    let settling = outputs.iter().filter(|output| output.status == Status::Settling).count();
    assert_eq!(settling, 2 * 344);
    assert!(outputs[1021..1021 + 344].iter().all(|output| output.status == Status::Settling));
    assert_eq!(outputs[1021 + 344].status, Status::Used);
}

#[test]
fn nothing_is_learnt_from_what_is_rejected_or_settling() {
    let epochs = epochs(1000);
    let mut pipeline = pipeline(Method::SaddlePoint);
    for epoch in &epochs {
        let before = *pipeline.coefficients();
        let output = pipeline.step(epoch);
        assert_eq!(before == *pipeline.coefficients(), output.status != Status::Used, "{output:?}");
    }
}

#[test]
fn prediction_comes_before_the_update() {
    let outputs = run(Method::Rls, &epochs(1200));
    let last = outputs[1199].compensated.unwrap();
    assert_ne!(last.residual_nt, last.residual_after_update_nt);
    let mut pipeline = pipeline(Method::Rls);
    let mut epochs = epochs(1200);
    epochs[..1199].iter().for_each(|epoch| _ = pipeline.step(epoch));
    // The reading of the epoch itself has no part in its own interference.
    let mut other = pipeline.clone();
    epochs[1199].scalar_pt = epochs[1199].scalar_pt.map(|scalar_pt| scalar_pt + 5000);
    let disturbed = other.step(&epochs[1199]).compensated.unwrap();
    assert_eq!(disturbed.interference_nt, last.interference_nt);
    assert_eq!(disturbed.compensated_pt, last.compensated_pt + 5000);
}

fn any_epoch() -> impl Strategy<Value = Epoch> {
    let number = prop_oneof![
        5 => -60_000.0_f32..60_000.0,
        1 => proptest::num::f32::ANY,
    ];
    let scalar = prop_oneof![5 => 40_000_000..60_000_000, 1 => proptest::num::i32::ANY];
    let flux = [number.clone(), number.clone(), number];
    (
        prop_oneof![8 => Just(1_u32), 1 => 0..400_u32, 1 => proptest::num::u32::ANY],
        proptest::option::weighted(0.95, scalar),
        proptest::option::weighted(0.95, flux),
    )
        .prop_map(|(tick, scalar_pt, flux_nt)| Epoch { tick, scalar_pt, flux_nt })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Rubbish of every kind, in any order: no panic, and every number that comes out is one.
    #[test]
    fn rubbish_never_gets_through(mut epochs in proptest::collection::vec(any_epoch(), 1..1500)) {
        let mut tick = 0_u32;
        for epoch in &mut epochs {
            tick = tick.wrapping_add(epoch.tick);
            epoch.tick = tick;
        }
        for method in METHODS {
            for output in run(method, &epochs) {
                if let Some(c) = output.compensated {
                    let all = [c.interference_nt, c.band_passed_nt, c.residual_nt, c.residual_after_update_nt];
                    prop_assert!(all.iter().all(|value| value.is_finite()), "{output:?}");
                }
            }
        }
    }
}
