//! One calibration and one recording: all methods, averaged over several sets of anomalies.

use serde::Serialize;
use towmag::{Method, Settings};

use super::figures::Detection;
use super::injection::{InjectionSettings, detection_of_injected};
use crate::error::HostError;
use crate::recording::Input;
use crate::run::Start;

/// Sets of anomalies that are averaged: the place of one decides too much.
pub const SETS: u64 = 4;

/// What every method makes of one recording after one calibration.
#[derive(Clone, Debug, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
pub struct Combination {
    /// File name of the calibration.
    pub calibration: String,
    /// File name of the recording.
    pub recording: String,
    /// What the best 18 coefficients leave of the rows that count, in hindsight, nT.
    pub bound_nT: f64,
    /// One entry a method.
    pub methods: Vec<Detection>,
}

impl Combination {
    /// Whether targets stand out most after this method.
    pub fn is_best(&self, method: &Detection) -> bool {
        self.methods.iter().all(|other| other.detection <= method.detection)
    }
}

/// The mean over [`SETS`] sets of anomalies, from the seed of `injection` on.
pub fn combination(
    (calibration, recording): (impl Into<Input>, impl Into<Input>),
    methods: &[Method],
    settings: &Settings,
    start: &Start,
    injection: &InjectionSettings,
) -> Result<Combination, HostError> {
    let (calibration, recording) = (calibration.into(), recording.into().ready()?);
    let mut sets = Vec::new();
    for seed in injection.seed..injection.seed + SETS {
        let injection = InjectionSettings { seed, ..injection.clone() };
        sets.push(detection_of_injected(&recording, methods, settings, start, &injection)?);
    }
    let mean = |i: usize| {
        let of = |value: fn(&Detection) -> f64| sets.iter().map(|(_, set)| value(&set[i])).sum::<f64>() / SETS as f64;
        let kept = of(|set| set.kept);
        let first = sets[0].1[i].clone();
        let strong: Vec<f64> = sets.iter().filter_map(|(_, set)| set[i].kept_strong).collect();
        Detection {
            kept,
            kept_strong: (!strong.is_empty()).then(|| strong.iter().sum::<f64>() / strong.len() as f64),
            distortion: of(|set| set.distortion),
            detection: kept / first.residual_over_bound,
            ..first
        }
    };
    Ok(Combination {
        calibration: calibration.file_name(),
        recording: recording.file_name(),
        bound_nT: sets[0].0,
        methods: (0..methods.len()).map(mean).collect(),
    })
}
