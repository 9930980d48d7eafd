use crate::diagnosis::manoeuvre::*;
use crate::diagnosis::noise::blocks::blocks;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::regression::term::Term;
use crate::effects::{Channel, Library};
use crate::simulator::signals::tests::signals;

/// What separates an effect with some values from another, for white noise of 0.05 nT.
fn sailed(name: &str, at: &[f64], coordinates: &[f64], rival: &str) -> (ManoeuvreKind, f64) {
    let library = Library::default();
    let index = |name: &str| library.iter().position(|effect| effect.spec().name == name).expect("in the library");
    let signals = signals();
    let usable = vec![true; signals.len()];
    let whitening = Whitening::new(&blocks(signals.epochs_s(), &usable, 0.15), Predictor::white(0.05), None);
    let reading = signals.scalar_at_rows_nt().to_vec();
    let recorded = RegressionProblem::new(&library, Channel::Scalar, signals, reading, whitening.into());
    let term = Term { effect: index(name), at: at.to_vec(), coordinates: coordinates.to_vec() };
    let pair = Pair { library: &library, term: &term, rivals: vec![index(rival)], recorded: &recorded, variance: 1.0 };
    let (manoeuvre, minutes) = quickest(&pair, &Place::of(&recorded.signals)).expect("one is the quickest");
    (manoeuvre.kind, minutes)
}

#[test]
fn a_shake_tells_a_delay_from_a_low_pass() {
    let (kind, minutes) = sailed("scalar_lag", &[0.01], &[], "scalar_lowpass");
    assert_eq!(kind, ManoeuvreKind::Shake);
    // A lag twice as long shows with four times the power, or a little more for its bend.
    let (_, half) = sailed("scalar_lag", &[0.005], &[], "scalar_lowpass");
    assert!((3.0..20.0).contains(&(half / minutes)), "{half} {minutes}");
}

#[test]
fn a_change_of_depth_in_flat_water_tells_a_gradient_from_swell() {
    let (kind, minutes) = sailed("depth_gradient", &[0.0], &[0.05], "swell_induction");
    assert!(kind == ManoeuvreKind::YoYo && minutes > 0.0, "{kind:?} {minutes}");
}

/// In flat water there is no swell, and a gradient that cannot pass for it would add nothing either.
#[test]
fn where_neither_of_two_would_show_is_no_manoeuvre() {
    let (kind, minutes) = sailed("swell_induction", &[0.0], &[0.05], "depth_gradient");
    assert!(kind != ManoeuvreKind::YoYo && minutes > 0.0, "{kind:?} {minutes}");
}

#[test]
fn minutes_are_whole_or_half_and_within_an_hour() {
    let minutes = [0.01, 3.2, 7.5, 1e9, f64::INFINITY].map(|minutes| half_minutes(minutes, 0.5, 60.0));
    assert_eq!(minutes, [0.5, 3.5, 7.5, 60.0, 60.0]);
}
