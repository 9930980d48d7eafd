//! The anomalies that every comparison is tried with, unless others are asked for.

use towmag::{Method, Settings};

use super::combination::Combination;
use super::injection::{InjectionSettings, detection_of_injected};
use crate::error::HostError;
use crate::recording::Input;
use crate::run::{Counts, Start};

/// How many, as in what the methods are held to on real flights (docs/measured.md).
const ANOMALIES: usize = 8;

/// Time that each needs for itself, s: it rings in the band-pass for ten on either side.
const EACH_S: f64 = 20.0;

/// One set of eight anomalies, which costs every method two passes; fewer in a short recording, and `None` where there is no
/// room for one or a figure cannot be told.
///
/// # Errors
///
/// Those of the recording and the settings.
pub fn standard_targets(
    (calibration, recording): (&Input, &Input),
    methods: &[Method],
    settings: &Settings,
    start: &Start,
    counts: &Counts,
) -> Result<Option<Combination>, HostError> {
    let seconds = counts.used_rows as f64 / settings.band_pass.sample_rate_hz;
    let anomalies = ((seconds / EACH_S) as usize).min(ANOMALIES);
    if anomalies == 0 {
        return Ok(None);
    }
    let injection = InjectionSettings { anomalies, ..InjectionSettings::default() };
    let (bound_nt, methods) = detection_of_injected(recording, methods, settings, start, &injection)?;
    let is_known = |value: f64| value.is_finite();
    let all_known = methods.iter().all(|of| is_known(of.kept) && is_known(of.detection) && is_known(of.distortion));
    Ok((bound_nt > 0.0 && all_known).then(|| Combination {
        calibration: calibration.file_name(),
        recording: recording.file_name(),
        bound_nT: bound_nt,
        methods,
    }))
}
