use rand::SeedableRng;

use super::effects::{self, Parameters, named};
use super::grid::Grid;
use super::vector::{Vector, dot, length};
use super::{Change, Last, Recorder, World, body, csv, foreign};
use crate::random::Random;
use crate::setting::Setting;

fn world(seed: u64, wanted: impl Fn(&World) -> bool) -> World {
    let of =
        |k: u64| World::draw(1800, Setting::Trial, &mut Random::seed_from_u64(k), &mut Random::seed_from_u64(k + 1));
    (seed..).map(of).find(|world| wanted(world)).unwrap()
}

fn whole(world: &World) -> bool {
    world.columns.lost.is_empty()
}

fn change(world: &World, name: &str, of: &[(&str, f64)]) -> Change {
    let parameters: Parameters = of.iter().map(|(name, value)| (name.to_string(), *value)).collect();
    named(name, &[]).unwrap().change(world, &parameters, &mut Random::seed_from_u64(9))
}

fn close(a: &[f64], b: impl IntoIterator<Item = f64>, within: f64) {
    let b: Vec<f64> = b.into_iter().collect();
    assert_eq!(a.len(), b.len());
    let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < within, "{worst}");
}

#[test]
fn the_clean_scalar_is_the_field_and_the_18_terms() {
    let world = world(1, whole);
    let (clean, directions, rates) = (world.clean(), world.directions(), world.rates());
    for row in [0, 777, 1799] {
        let (field_nt, columns) = (world.field_nt[Grid::of_row(row)], body::columns(directions[row], rates[row]));
        let b = &world.body;
        let mut sum: f64 = (0..3).map(|k| columns[k] * b.permanent_nt[k]).sum();
        let quadratic = [(0, 0, 1.0), (0, 1, 2.0), (0, 2, 2.0), (1, 1, 1.0), (1, 2, 2.0), (2, 2, 1.0)];
        sum += quadratic
            .iter()
            .enumerate()
            .map(|(k, (i, j, n))| n * field_nt * columns[3 + k] * b.induced[*i][*j])
            .sum::<f64>();
        sum += (0..9).map(|k| field_nt * columns[9 + k] * b.eddy_s[k / 3][k % 3]).sum::<f64>();
        assert!((clean.scalar_nt[row] - field_nt - sum).abs() < 1e-6);
        assert!((length(clean.flux_nt[row]) - field_nt).abs() < 1e-6);
    }
}

#[test]
fn a_late_scalar_is_the_earlier_one_and_a_slow_one_is_late_at_first() {
    let world = world(2, whole);
    let clean = world.clean().scalar_nt;
    let late = change(&world, "scalar_lag", &[("lag_s", 0.2)]).scalar_nt;
    close(&late[2..], (2..1800).map(|row| clean[row - 2] - clean[row]), 1e-6);
    let slip = [("time_s", world.columns.first_time_s + 60.0), ("samples", 2.0)];
    let slipped = change(&world, "sample_slip", &slip).scalar_nt;
    close(&slipped[..600], vec![0.0; 600], 1e-9);
    close(&slipped[600..], late[600..].iter().copied(), 1e-6);
    // Small windows and time constants are delays by half the window and by the time constant.
    let little = change(&world, "scalar_lag", &[("lag_s", 0.01)]).scalar_nt;
    let size = little.iter().fold(0.0_f64, |most, nt| most.max(nt.abs()));
    for (name, of) in [("averaging_window", ("window_s", 0.02)), ("scalar_lowpass", ("time_constant_s", 0.01))] {
        close(&change(&world, name, &[of]).scalar_nt[10..], little[10..].iter().copied(), 0.08 * size);
    }
    let drift = change(&world, "clock_drift", &[("rate_ppm", 1000.0)]).scalar_nt;
    let at = |t: f64| world.grid.at(&world.scalar_nt, t);
    close(&drift, (0..1800).map(|row| at(0.0999 * f64::from(row)) - clean[row as usize]), 1e-6);
}

#[test]
fn no_timing_effect_reaches_across_a_gap() {
    let world = world(3, |world| !world.columns.lost.is_empty());
    let start = world.columns.lost[0].end;
    for (name, of) in [
        ("scalar_lag", ("lag_s", 0.3)),
        ("averaging_window", ("window_s", 0.3)),
        ("scalar_lowpass", ("time_constant_s", 0.3)),
    ] {
        assert_eq!(change(&world, name, &[of]).scalar_nt[start], 0.0, "{name}");
    }
    let repeated =
        world.record(&[], vec![(Last::Repeat(1.0), Random::seed_from_u64(1))], &mut Random::seed_from_u64(2));
    assert_eq!(repeated.scalar_nt[start], repeated.scalar_nt[start + 1]);
    assert_ne!(repeated.scalar_nt[start], repeated.scalar_nt[start - 1]);
}

#[test]
fn fluxgate_errors_are_those_of_a_matrix_and_a_bias() {
    let world = world(4, |world| whole(world) && world.columns.has_temperature);
    let f = world.clean().flux_nt[500];
    let at = |name: &str, of: &[(&str, f64)]| change(&world, name, of).flux_nt[500];
    let near = |a: Vector, b: Vector| assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{a:?} {b:?}");
    near(at("fluxgate_bias", &[("x_nT", 1.0), ("y_nT", 2.0), ("z_nT", 3.0)]), [1.0, 2.0, 3.0]);
    near(
        at("fluxgate_scale", &[("x_ppm", 100.0), ("y_ppm", 0.0), ("z_ppm", -100.0)]),
        [1e-4 * f[0], 0.0, -1e-4 * f[2]],
    );
    let skew = [("xy_mrad", 1.0), ("xz_mrad", 2.0), ("yz_mrad", 3.0)];
    near(at("fluxgate_nonorthogonality", &skew), [0.0, 1e-3 * f[0], 2e-3 * f[0] + 3e-3 * f[1]]);
    near(at("fluxgate_nonlinearity", &[("cubic_ppm", 50.0)]), f.map(|f| f * 50e-6 * (f / 50_000.0).powi(2)));
    let warmer = world.columns.temperature_deg_c[500] - world.columns.temperature_deg_c[0];
    let drift = [("x_nT_per_K", 1.0), ("y_nT_per_K", 0.0), ("z_nT_per_K", -2.0)];
    near(at("fluxgate_temperature_drift", &drift), [warmer, 0.0, -2.0 * warmer]);
    let rounded = world.record(&[], vec![(Last::Round(5.0), Random::seed_from_u64(1))], &mut Random::seed_from_u64(2));
    assert!(rounded.flux_nt.iter().flatten().all(|nt| (nt / 5.0).fract() == 0.0));
}

#[test]
fn moments_act_along_the_field_and_only_while_they_are_there() {
    let world = world(5, |world| whole(world) && world.columns.has_temperature);
    let c = world.directions();
    let origin_s = world.columns.first_time_s;
    let moment = [("x_nT", 3.0), ("y_nT", -1.0), ("z_nT", 2.0)];
    let along: Vec<f64> = c.iter().map(|c| 3.0 * c[0] - c[1] + 2.0 * c[2]).collect();
    let step = change(&world, "permanent_step", &[&moment[..], &[("time_s", origin_s + 90.0)]].concat()).scalar_nt;
    close(&step[..900], vec![0.0; 900], 1e-12);
    close(&step[900..], along[900..].iter().copied(), 1e-12);
    let load = [&moment[..], &[("period_s", 10.0), ("duty", 0.3), ("phase", 0.5003)]].concat();
    let load = change(&world, "load_current", &load).scalar_nt;
    close(&load, (0..1800).map(|row| if (row + 50) % 100 < 30 { along[row] } else { 0.0 }), 1e-9);
    let warm = change(
        &world,
        "permanent_temperature",
        &moment.map(|(name, value)| {
            (
                match name {
                    "x_nT" => "x_nT_per_K",
                    "y_nT" => "y_nT_per_K",
                    _ => "z_nT_per_K",
                },
                value,
            )
        }),
    );
    let k = &world.columns.temperature_deg_c;
    close(&warm.scalar_nt, (0..1800).map(|row| (k[row] - k[0]) * along[row]), 1e-9);
}

#[test]
fn optics_mains_and_second_order_follow_their_formulas() {
    let world = world(6, whole);
    let c = world.directions();
    let axis = [("axis_azimuth_deg", 90.0), ("axis_elevation_deg", 0.0)];
    let heading = change(&world, "heading_error", &[&axis[..], &[("cubic_nT", 2.0), ("quartic_nT", -1.0)]].concat());
    close(&heading.scalar_nt, c.iter().map(|c| 2.0 * c[1].powi(3) - c[1].powi(4)), 1e-12);
    let zone = change(&world, "dead_zone", &[&axis[..], &[("half_angle_deg", 60.0), ("noise_nT", 1.0)]].concat());
    assert!(zone.scalar_nt.iter().zip(&c).all(|(nt, c)| (*nt != 0.0) == (c[1].abs() >= 0.5)));
    let mains = [("frequency_hz", 1.3), ("amplitude_nT", 0.4), ("phase_rad", 0.2)];
    let tone = |row: i32| 0.4 * (std::f64::consts::TAU * 1.3 * 0.1 * f64::from(row) + 0.2).sin();
    close(&change(&world, "mains_alias", &mains).scalar_nt, (0..1800).map(tone), 1e-9);
    // The second order is half the squared part across the field, over the field.
    let second = change(&world, "second_order", &[("scale", 1.0)]).scalar_nt;
    let across = |row: usize| {
        let at = Grid::of_row(row);
        let (field_nt, c) = (world.field_nt[at], world.direction[at]);
        let (still, eddy) = (world.body.still_nt(field_nt, c), world.body.eddy_nt(field_nt, world.rate[at]));
        let all: Vector = std::array::from_fn(|k| still[k] + eddy[k]);
        (dot(all, all) - dot(all, c).powi(2)) / (2.0 * field_nt)
    };
    let size = second.iter().fold(0.0_f64, |most, nt| most.max(nt.abs()));
    close(&second, (0..1800).map(across), 0.02 * size);
    assert!(change(&world, "eddy_lag", &[("time_constant_s", 1e-4)]).scalar_nt.iter().all(|nt| nt.abs() < 0.05));
}

#[test]
fn depth_effects_follow_depth_and_what_is_a_quarter_period_behind() {
    let world = world(7, |world| whole(world) && world.motion.name == "sea");
    let depth_m = world.depth_m().unwrap();
    let mean_m = depth_m.iter().sum::<f64>() / depth_m.len() as f64;
    let gradient = change(&world, "depth_gradient", &[("gradient_nT_per_m", 2.0)]).scalar_nt;
    close(&gradient, depth_m.iter().map(|z| 2.0 * (z - mean_m)), 1e-9);
    let swell = change(&world, "swell_induction", &[("gain_nT_per_m", 1.0)]).scalar_nt;
    // Behind: it rises where the depth is above its mean.
    let rises: Vec<f64> = swell.windows(3).map(|w| w[2] - w[0]).collect();
    let mean = |row: usize| (row.saturating_sub(150)..(row + 150).min(1800)).map(|k| depth_m[k]).sum::<f64>();
    let count = |row: usize| (row + 150).min(1800) - row.saturating_sub(150);
    let above: Vec<f64> = (1..1799).map(|row| depth_m[row] - mean(row) / count(row) as f64).collect();
    let together: f64 = rises.iter().zip(&above).map(|(a, b)| a * b).sum();
    let length = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
    assert!(together / length(&rises) / length(&above) > 0.8, "{}", together / length(&rises) / length(&above));
}

#[test]
fn every_effect_changes_a_world_and_the_same_seed_gives_the_same_bytes() {
    let world =
        world(8, |world| world.columns.has_temperature && world.columns.has_depth && world.motion.name == "sea");
    let recorder = Recorder::draw(None, Setting::Trial, &world, &mut Random::seed_from_u64(6));
    assert_eq!(effects::all().count(), 23);
    for effect in effects::all() {
        let Some(parameters) = effect.drawn(&world, &mut Random::seed_from_u64(1)) else {
            assert_eq!(effect.name, "dead_zone");
            continue;
        };
        assert!(effect.sizes.iter().all(|name| parameters.contains_key(*name)), "{}", effect.name);
        let bytes = || {
            let change = effect.change(&world, &parameters, &mut Random::seed_from_u64(2));
            let last = effect.last(&parameters).map(|last| (last, Random::seed_from_u64(3)));
            let readings = world.record(&[change], last.into_iter().collect(), &mut Random::seed_from_u64(4));
            csv(&world, &readings, &recorder, [5, 6].map(Random::seed_from_u64))
        };
        let clean = world.record(&[], Vec::new(), &mut Random::seed_from_u64(4));
        assert!(
            bytes() == bytes() && bytes() != csv(&world, &clean, &recorder, [5, 6].map(Random::seed_from_u64)),
            "{}",
            effect.name
        );
    }
}

#[test]
fn every_mechanism_changes_a_world_and_none_is_an_effect_or_of_both_settings() {
    let world = world(8, |world| world.motion.name == "sea");
    let [tuning, trial] = [Setting::Tuning, Setting::Trial].map(foreign::all);
    assert!(trial.len() >= 20);
    assert!(trial.iter().all(|mechanism| tuning.iter().all(|other| other.name != mechanism.name)));
    for mechanism in tuning.iter().chain(&trial) {
        let change = || (mechanism.change)(&world, &mut Random::seed_from_u64(1));
        let Change { scalar_nt, flux_nt } = change();
        let most = scalar_nt.iter().chain(flux_nt.iter().flatten()).fold(0.0_f64, |most, nt| most.max(nt.abs()));
        assert!(most > 1e-3 && most < 1e6, "{} {most}", mechanism.name);
        assert!([scalar_nt.len(), flux_nt.len()].iter().all(|rows| [0, 1800].contains(rows)));
        assert_eq!(scalar_nt, change().scalar_nt, "{}", mechanism.name);
        assert!(effects::named(mechanism.name, &[]).is_none() && foreign::named(mechanism.name).is_some());
    }
}
