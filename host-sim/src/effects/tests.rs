//! What holds for all effects.

use std::time::Instant;

use crate::effects::Library;
use crate::effects::{Domain, Draw, change_of_clean, no_draw};
use crate::simulator::signals::Signals;
use crate::simulator::signals::tests::{signals, signals_of, trajectory};
use rand::SeedableRng;

/// Parameters in the middle of what is plausible, where something is to be seen.
fn some_parameters(effect: &dyn crate::effects::Effect) -> Vec<f64> {
    let some = |p: &crate::effects::Parameter| match p.name {
        "time_s" => 120.0,
        "axis_elevation_deg" => 70.0,
        "period_s" => 7.0,
        _ if p.domain == Domain::Whole => 2.0,
        _ => p.plausible[0] + 0.7 * (p.plausible[1] - p.plausible[0]),
    };
    effect.spec().parameters.iter().map(some).collect()
}

#[test]
fn each_changes_its_channel_alone_and_the_same_draw_gives_the_same() {
    let signals = signals();
    let all = Library::default().applicable_to(&signals);
    assert_eq!(all.len(), 24, "23 effects, and the strobe");
    for effect in all.iter() {
        let (name, parameters) = (effect.spec().name, some_parameters(&**effect));
        let change = change_of_clean(&**effect, &signals, &parameters, &mut Draw::seed_from_u64(5));
        assert!(change.rms_nt() > 1e-4 && change.rms_nt().is_finite(), "{name}: {}", change.rms_nt());
        assert_eq!(change, change_of_clean(&**effect, &signals, &parameters, &mut Draw::seed_from_u64(5)), "{name}");
        assert_eq!(effect.variance(&signals, &parameters).is_some(), effect.spec().random, "{name}");
    }
}

#[test]
fn linear_effects_are_the_sum_of_their_signatures() {
    let signals = signals();
    for effect in Library::default().applicable_to(&signals).iter() {
        let (name, parameters) = (effect.spec().name, some_parameters(&**effect));
        let regressors = effect.regressors(&signals, &parameters);
        let coordinates: Vec<f64> = (1..=regressors.len()).map(|k| k as f64).collect();
        let at = effect.from_coordinates(&parameters, &coordinates);
        let Some(first) = regressors.first() else { continue };
        let direct = effect.change(&signals, &at, &mut no_draw());
        for row in 0..first.scalar_nt.len() {
            let sum: f64 = regressors.iter().zip(&coordinates).map(|(one, x)| x * one.scalar_nt[row]).sum();
            assert!((sum - direct.scalar_nt[row]).abs() < 1e-6 * (1.0 + sum.abs()), "{name}");
        }
        for row in 0..first.flux_nt.len() {
            let sum: f64 = regressors.iter().zip(&coordinates).map(|(one, x)| x * one.flux_nt[row][2]).sum();
            assert!((sum - direct.flux_nt[row][2]).abs() < 1e-6 * (1.0 + sum.abs()), "{name}");
        }
    }
}

#[test]
fn nothing_reaches_across_a_gap() {
    let mut gapped = trajectory();
    for values in [&mut gapped.depth_m, &mut gapped.temperature_deg_c] {
        values.as_mut().unwrap().drain(200..260);
    }
    gapped.currents_a[0].1.drain(200..260);
    gapped.epochs_s.drain(200..260);
    let mut other = gapped.clone();
    // Another past: the direction before the gap. What comes after it must not know.
    let gap_begins = 2500;
    other.direction[..gap_begins].fill([0.0, 0.6, 0.8]);
    let (one, other) = (signals_of(gapped), signals_of(other));
    for effect in Library::default().applicable_to(&one).iter() {
        let parameters = some_parameters(&**effect);
        let after = |signals: &Signals| {
            let change = change_of_clean(&**effect, signals, &parameters, &mut Draw::seed_from_u64(5));
            (change.scalar_nt.get(200..).map(<[f64]>::to_vec), change.flux_nt.get(200..).map(<[[f64; 3]]>::to_vec))
        };
        assert_eq!(after(&one), after(&other), "{}", effect.spec().name);
    }
}

#[test]
fn names_are_unique_and_every_word_is_there() {
    let all = Library::default();
    for (index, effect) in all.iter().enumerate() {
        let spec = effect.spec();
        assert!(all[..index].iter().all(|other| other.spec().name != spec.name));
        assert!(!spec.what.is_empty() && !spec.origin.is_empty() && !spec.source.is_empty());
        for p in spec.parameters {
            assert!(p.range[0] < p.range[1] && p.plausible[0] < p.plausible[1], "{} {}", spec.name, p.name);
        }
    }
}

/// Not a benchmark, but one effect that takes a hundred times as long as the rest would show here.
#[test]
fn an_effect_takes_milliseconds_on_twenty_minutes() {
    let mut long = trajectory();
    let (points, rows) = (121_001, 12_000);
    long.field_nt = (0..points).map(|k| long.field_nt[k % 7001]).collect();
    long.direction = (0..points).map(|k| long.direction[k % 7001]).collect();
    long.epochs_s = (0..rows).map(|k| f64::from(k) * 0.1).collect();
    let rows = rows as usize;
    long.depth_m = Some((0..rows).map(|k| (k as f64 * 0.03).sin()).collect());
    long.temperature_deg_c = Some((0..rows).map(|k| k as f64 * 1e-3).collect());
    long.currents_a.clear();
    let signals = signals_of(long);
    for effect in Library::default().applicable_to(&signals).iter() {
        let begin = Instant::now();
        change_of_clean(&**effect, &signals, &some_parameters(&**effect), &mut no_draw());
        let taken = begin.elapsed();
        println!("{:28} {:7.2} ms", effect.spec().name, taken.as_secs_f64() * 1e3);
        assert!(taken.as_millis() < 500, "{}", effect.spec().name);
    }
}
