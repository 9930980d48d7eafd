//! A recording as a CSV file.

use std::fmt::Write;

use rand_distr::{Distribution, StandardNormal};

use super::grid::Grid;
use super::readings::Readings;
use super::rounding::Recorder;
use super::state::World;
use crate::random::Random;

/// Standard deviations of what is recorded beside the sensors.
const DEPTH_NOISE_M: f64 = 0.003;
const HEADING_NOISE_DEG: f64 = 0.7;
const TILT_NOISE_DEG: f64 = 0.2;

/// Header and rows; roll and pitch have a draw of their own.
pub(crate) fn csv(
    world: &World,
    readings: &Readings,
    recorder: &Recorder,
    [mut draw, mut tilt_draw]: [Random; 2],
) -> String {
    let columns = &world.columns;
    let depth_m = world.depth_m().filter(|_| columns.has_depth);
    let mut text = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT".to_string();
    let optional = [
        (columns.has_valid, "scalar_valid"),
        (depth_m.is_some(), "depth_m"),
        (columns.has_temperature, "temperature_degC"),
        (columns.has_heading, "heading_deg,roll_deg,pitch_deg"),
    ];
    optional.iter().filter(|(is_there, _)| *is_there).for_each(|(_, name)| _ = write!(text, ",{name}"));
    columns.load.iter().for_each(|(load, _)| _ = write!(text, ",current_{load}_A"));
    text.push('\n');
    let [scalar, flux] = recorder.decimals;
    for row in 0..world.rows() {
        let mut noise =
            |std: f64| -> f64 { std * <StandardNormal as Distribution<f64>>::sample(&StandardNormal, &mut draw) };
        let off = [noise(DEPTH_NOISE_M), noise(HEADING_NOISE_DEG)];
        if !columns.is_kept(row) {
            continue;
        }
        let is_valid = !columns.invalid.iter().any(|invalid| invalid.contains(&row));
        // What a sensor says that has lost its signal.
        let scalar_nt = if is_valid { recorder.scalar_nt(readings.scalar_nt[row]) } else { 0.0 };
        let [x, y, z] = readings.flux_nt[row].map(|nt| recorder.flux_nt(nt));
        let time_s = columns.first_time_s + Grid::row_s(row);
        _ = write!(text, "{time_s:.1},{scalar_nt:.scalar$},{x:.flux$},{y:.flux$},{z:.flux$}");
        if columns.has_valid {
            _ = write!(text, ",{}", u8::from(is_valid));
        }
        if let Some(depth_m) = &depth_m {
            _ = write!(text, ",{:.3}", depth_m[row] + off[0]);
        }
        if columns.has_temperature {
            _ = write!(text, ",{:.3}", columns.temperature_deg_c[row]);
        }
        if columns.has_heading {
            _ = write!(text, ",{:.2}", (world.heading_deg(row) + off[1]).rem_euclid(360.0));
            for tilt_deg in world.tilt_deg(row) {
                let off: f64 = StandardNormal.sample(&mut tilt_draw);
                _ = write!(text, ",{:.2}", tilt_deg + TILT_NOISE_DEG * off);
            }
        }
        columns.load.iter().for_each(|(_, current_a)| _ = write!(text, ",{:.3}", current_a[row]));
        text.push('\n');
    }
    text
}
