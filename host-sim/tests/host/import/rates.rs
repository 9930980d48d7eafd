//! A tow at other rates, and what is left of what 10 Hz cannot show.

use std::path::Path;

use host_sim::command;
use host_sim::recording::Input;
use host_sim::run::pass;
use towmag::{Method, Settings};
use towmag_fourier::{Complex, Planner};

use super::copies::Copy;

const SENSORS: [&str; 4] = ["scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];

/// The same tow at `rate_hz`: its spectrum, with nothing above 5 Hz, and on the scalar a tone that 10 Hz cannot show.
pub(crate) fn copy(tow: &Copy, rate_hz: usize) -> Copy {
    let (more, rows) = (rate_hz / 10, tow.column("time_s").len());
    let time_s: Vec<f64> = (0..rows * more).map(|row| row as f64 / rate_hz as f64).collect();
    let tone = |time_s: &f64| 5.0 * (2.0 * std::f64::consts::PI * 0.45 * rate_hz as f64 * time_s).sin();
    let mut columns = vec![("time_s".to_string(), time_s.clone())];
    for name in SENSORS {
        let mut values = upsampled(tow.column(name), more);
        if name == "scalar_nT" {
            values.iter_mut().zip(&time_s).for_each(|(value, time_s)| *value += tone(time_s));
        }
        columns.push((name.into(), values));
    }
    Copy { name: format!("{} at {rate_hz} Hz", tow.name), columns }
}

/// Zeros above the spectrum of a record that is continued by its mirror image, so that its ends meet.
fn upsampled(values: &[f64], more: usize) -> Vec<f64> {
    let mut planner = Planner::new();
    let mut spectrum: Vec<Complex<f64>> =
        values.iter().chain(values.iter().rev()).map(|value| Complex::new(*value, 0.0)).collect();
    let len = spectrum.len();
    planner.forward(len).process(&mut spectrum);
    let mut wide = vec![Complex::new(0.0, 0.0); len * more];
    for at in 0..len / 2 {
        wide[at] = spectrum[at];
        if at > 0 {
            wide[len * more - at] = spectrum[len - at];
        }
    }
    planner.inverse(len * more).process(&mut wide);
    wide.iter().take(values.len() * more).map(|value| value.re / len as f64).collect()
}

/// Standard deviation of the residual of fixed coefficients from the second minute to a minute before the end, calibrated on the
/// same rows: a copy through the Fourier transform rings at its ends, and a calibration takes all that it gets.
pub(crate) fn residual_nt(folder: &Path, csv: &[u8]) -> f64 {
    let (rec, cal) = (folder.join("rec.csv"), folder.join("cal"));
    std::fs::write(&rec, csv).unwrap();
    let lines: Vec<&[u8]> = csv.split_inclusive(|&byte| byte == b'\n').collect();
    let inner = folder.join("inner.csv");
    std::fs::write(&inner, [&lines[..1], &lines[601..lines.len() - 600]].concat().concat()).unwrap();
    command::calibrate(inner.as_path(), &cal, &Settings::default()).unwrap();
    let settings = Settings { method: Method::Fixed, ..Settings::default() };
    let start = command::start_from(Some(&cal.join("coefficients.toml"))).unwrap();
    let mut residual: Vec<f64> = Vec::new();
    pass(&mut *Input::new(rec, false).open().unwrap(), &[Method::Fixed], &settings, &start, |passed| {
        residual.extend(passed.output.compensated.map(|compensated| f64::from(compensated.residual_nt)));
        Ok(())
    })
    .unwrap();
    let inner = &residual[600..residual.len() - 600];
    let mean = inner.iter().sum::<f64>() / inner.len() as f64;
    (inner.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / inner.len() as f64).sqrt()
}

/// Tones that a recording of this rate can have and one of 10 Hz cannot, Hz.
pub(crate) fn tones(rate_hz: usize) -> Vec<f64> {
    let highest = rate_hz as f64 / 2.0;
    [5.02, 5.5, 6.3, 8.1, 9.97, 10.4, 15.2, 27.0, 49.9, 50.1, 71.0].into_iter().filter(|hz| *hz < highest).collect()
}

/// What is left of a tone of 10 nT, 5 s from the ends on.
pub(crate) fn alias_rms_nt(rate_hz: usize, tone_hz: f64) -> f64 {
    let time_s: Vec<f64> = (0..30 * rate_hz).map(|row| row as f64 / rate_hz as f64).collect();
    let scalar = time_s.iter().map(|t| 50_000.0 + 10.0 * (2.0 * std::f64::consts::PI * tone_hz * t).sin()).collect();
    let mut columns = vec![("time_s".to_string(), time_s.clone()), ("scalar_nT".to_string(), scalar)];
    for (name, value) in SENSORS[1..].iter().zip([20_000.0, 0.0, 45_000.0]) {
        columns.push(((*name).to_string(), vec![value; time_s.len()]));
    }
    let copy = Copy { name: format!("{tone_hz} Hz at {rate_hz} Hz"), columns };
    let imported = Copy::read("", &copy.imported_csv());
    let scalar = imported.column("scalar_nT");
    let inner = &scalar[50..scalar.len() - 50];
    (inner.iter().map(|value| (value - 50_000.0).powi(2)).sum::<f64>() / inner.len() as f64).sqrt()
}
