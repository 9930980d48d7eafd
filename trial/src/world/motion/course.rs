//! Attitude and depth in the course of time.

use super::super::grid::Grid;
use super::super::tones::{Tone, sum};

/// Attitude and depth at 100 Hz.
#[derive(Clone, Debug)]
pub(in crate::world) struct Motion {
    /// `land`, `lake`, `sea`, `jerky` or `flight`.
    pub(in crate::world) name: &'static str,
    /// Starboard down, rad.
    pub(in crate::world) roll: Vec<f64>,
    /// Nose up, rad.
    pub(in crate::world) pitch: Vec<f64>,
    /// From north by east, rad.
    pub(in crate::world) heading: Vec<f64>,
    /// Of a tow.
    pub(in crate::world) depth: Option<Depth>,
}

/// Depth below the surface, positive down.
#[derive(Clone, Debug)]
pub(in crate::world) struct Depth {
    /// m.
    pub(in crate::world) depth_m: Vec<f64>,
    /// Its part from 0.05 to 0.5 Hz, a quarter period behind, m.
    pub(in crate::world) behind_m: Vec<f64>,
}

impl Motion {
    /// None that is known.
    pub(in crate::world) fn still() -> Self {
        Self { name: "recorded", roll: Vec::new(), pitch: Vec::new(), heading: Vec::new(), depth: None }
    }
}

impl Depth {
    /// A level that changes too slowly for swell, and waves.
    pub(super) fn new(grid: &Grid, level_m: &[f64], waves: &[Tone]) -> Self {
        let swell: Vec<Tone> =
            waves.iter().filter(|tone| (0.05..=0.5).contains(&tone.hz)).map(|tone| tone.behind()).collect();
        let heave = sum(grid, waves);
        Self {
            depth_m: level_m.iter().zip(&heave).map(|(level, heave)| level + heave).collect(),
            behind_m: sum(grid, &swell),
        }
    }
}
