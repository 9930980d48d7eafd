//! An effect of any kind is one file: three that the program does not know, written here, are simulated and named, and
//! nothing else is touched. `docs/extending.md` walks this path for an effect of the program itself.

use std::path::Path;

use host_sim::diagnosis::{DiagnoseSettings, Diagnosis, Prepared, diagnose};
use host_sim::effects::{
    Change, CoefficientDependence, Column, Domain, Draw, Effect, Kind, Library, Parameter, Search, Spec, Step,
};
use host_sim::simulator::scenario::{Scenario, Simulation};
use host_sim::simulator::signals::Signals;
use host_sim::text::diagnosis::sentence;
use rand_distr::{Distribution, StandardNormal};

const fn parameter(name: &'static str, unit: &'static str, most: f64, kind: Kind) -> Parameter {
    Parameter { name, unit, range: [-most, most], plausible: [-0.1 * most, 0.1 * most], kind, domain: Domain::Real }
}

/// Linear: a gradient that grows with depth.
#[derive(Debug)]
struct DepthCurvature;

impl Effect for DepthCurvature {
    fn spec(&self) -> &'static Spec {
        const SPEC: Spec = Spec {
            name: "depth_curvature",
            title: "a gradient that grows with depth",
            parameters: &[parameter("curvature_nT_per_m2", "nT/m2", 100.0, Kind::Linear)],
            needs: Some(Column::Depth),
            ..Spec::BASE
        };
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        Change::of_scalar(off_mean_depth_m(signals).map(|m| parameters[0] * m * m).collect())
    }
}

/// Nonlinear: a loose part that follows the rolling, but only so far.
#[derive(Debug)]
struct LoosePart;

impl Effect for LoosePart {
    fn spec(&self) -> &'static Spec {
        const SPEC: Spec = Spec {
            name: "loose_part",
            title: "a part that rattles to its stops",
            parameters: &[
                parameter("amplitude_nT", "nT", 1000.0, Kind::Linear),
                Parameter {
                    range: [1e-4, 1.0],
                    plausible: [1e-3, 0.2],
                    ..parameter("width_per_s", "1/s", 1.0, Kind::Differentiable(Step::growing(1e-4, 0.02)))
                },
            ],
            coefficients: CoefficientDependence::None,
            search: Search::Profile { starts: &[&[0.0, 0.003], &[0.0, 0.01], &[0.0, 0.03], &[0.0, 0.1]] },
            ..Spec::BASE
        };
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let moved = |rate: &[f64; 3]| parameters[0] * libm::tanh(rate[1] / parameters[1]);
        Change::of_scalar(signals.rows().direction_rate.iter().map(moved).collect())
    }
}

/// Random: noise that grows with the distance from the mean depth.
#[derive(Debug)]
struct PressureHiss;

impl Effect for PressureHiss {
    fn spec(&self) -> &'static Spec {
        const SPEC: Spec = Spec {
            name: "pressure_hiss",
            title: "noise that grows with the pressure",
            parameters: &[Parameter {
                range: [0.0, 100.0],
                plausible: [0.001, 1.0],
                ..parameter("noise_nT_per_m", "nT/m", 1.0, Kind::Spread)
            }],
            needs: Some(Column::Depth),
            random: true,
            search: Search::Variance { starts: &[&[1.0]] },
            ..Spec::BASE
        };
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change {
        let noisy = |m: f64| {
            let unit: f64 = StandardNormal.sample(draw);
            parameters[0] * m * unit
        };
        Change::of_scalar(off_mean_depth_m(signals).map(noisy).collect())
    }

    fn variance(&self, signals: &Signals, parameters: &[f64]) -> Option<Change> {
        Some(Change::of_scalar(off_mean_depth_m(signals).map(|m| (parameters[0] * m).powi(2)).collect()))
    }
}

fn off_mean_depth_m(signals: &Signals) -> impl Iterator<Item = f64> {
    let depth_m = signals.trajectory().depth_m.as_deref().unwrap_or_default();
    let mean_m = depth_m.iter().sum::<f64>() / depth_m.len().max(1) as f64;
    depth_m.iter().map(move |m| m - mean_m)
}

/// Five minutes on a lake with an effect of a library, diagnosed with it.
fn diagnosed(library: &Library, effect: &str) -> Diagnosis {
    let preset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/lake_tow.toml");
    let scenario = Scenario { duration_s: 300.0, ..Scenario::read(&preset).unwrap() };
    let simulation = Simulation::new(&scenario, 9).unwrap();
    let request = library.request(effect).unwrap();
    let table = Prepared::of_simulation(&simulation, &[request], "simulated", &[]).unwrap();
    let settings = DiagnoseSettings { library: library.clone(), ..DiagnoseSettings::default() };
    diagnose(&table, None, &settings).unwrap()
}

#[test]
fn a_new_effect_of_any_kind_is_simulated_and_named() {
    let library = Library::default().with(DepthCurvature).with(LoosePart).with(PressureHiss);
    for (effect, name, value, within) in [
        ("depth_curvature:curvature_nT_per_m2=2", "depth_curvature", 2.0, 0.1),
        ("loose_part:amplitude_nT=2,width_per_s=0.02", "loose_part", 2.0, 0.5),
        ("pressure_hiss:noise_nT_per_m=0.8", "pressure_hiss", 0.8, 0.2),
    ] {
        let diagnosis = diagnosed(&library, effect);
        let named: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.name).collect();
        assert_eq!(named, [name], "{effect}");
        let found = diagnosis.effects[0].parameters[0].value.unwrap();
        assert!((found - value).abs() < within, "{effect}: {found}");
        assert!(diagnosis.candidates.iter().any(|candidate| candidate.name == name && candidate.probability > 0.9));
        let title = library.spec(name).unwrap().title;
        assert!(sentence(&diagnosis).contains(title), "{}", sentence(&diagnosis));
    }
}

#[test]
fn what_the_library_lacks_is_not_requested() {
    let error = Library::default().request("loose_part:amplitude_nT=2,width_per_s=0.02").unwrap_err();
    assert!(error.to_string().contains("there is no effect \"loose_part\""), "{error}");
}
