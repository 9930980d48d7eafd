//! How the body moves: on land, on a lake, at sea. None of it is that of the simulator.

mod lake;
mod land;
mod script;
mod sea;

use rand::RngExt;

use super::Draw;
use super::grid::Grid;
use super::tones::Tone;

/// Attitude and depth at 100 Hz.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// `land`, `lake` or `sea`.
    pub(super) name: &'static str,
    /// Starboard down, rad.
    pub(super) roll: Vec<f64>,
    /// Nose up, rad.
    pub(super) pitch: Vec<f64>,
    /// From north by east, rad.
    pub(super) heading: Vec<f64>,
    /// Of a tow.
    pub(super) depth: Option<Depth>,
}

/// Depth below the surface, positive down.
#[derive(Clone, Debug)]
pub(super) struct Depth {
    /// m.
    pub(super) depth_m: Vec<f64>,
    /// Its part from 0.05 to 0.5 Hz, a quarter period behind, m.
    pub(super) behind_m: Vec<f64>,
}

/// One of the three.
pub(super) fn of(grid: &Grid, which: u8, draw: &mut Draw) -> Motion {
    match which {
        0 => land::draw(grid, draw),
        1 => lake::draw(grid, draw),
        _ => sea::draw(grid, draw),
    }
}

impl Motion {
    /// None that is known.
    pub(super) fn still() -> Self {
        Self { name: "recorded", roll: Vec::new(), pitch: Vec::new(), heading: Vec::new(), depth: None }
    }
}

impl Depth {
    /// A level that changes too slowly for swell, and waves.
    fn new(grid: &Grid, level_m: &[f64], waves: &[Tone]) -> Self {
        let swell: Vec<Tone> =
            waves.iter().filter(|tone| (0.05..=0.5).contains(&tone.hz)).map(|tone| tone.behind()).collect();
        let heave = super::tones::sum(grid, waves);
        Self {
            depth_m: level_m.iter().zip(&heave).map(|(level, heave)| level + heave).collect(),
            behind_m: super::tones::sum(grid, &swell),
        }
    }
}

/// Tones spread evenly over a band, with random phases and amplitudes.
fn band(hz: [f64; 2], count: usize, rms: f64, draw: &mut Draw) -> Vec<Tone> {
    let width = (hz[1] - hz[0]) / count as f64;
    let tone = |k: usize, draw: &mut Draw| Tone {
        hz: hz[0] + width * (k as f64 + draw.random::<f64>()),
        amplitude: draw.random_range(0.3..1.0),
        phase: draw.random_range(0.0..std::f64::consts::TAU),
    };
    let tones: Vec<Tone> = (0..count).map(|k| tone(k, draw)).collect();
    let scale = rms / super::tones::rms(&tones);
    tones.into_iter().map(|tone| tone.times(scale)).collect()
}

fn degrees(range: [f64; 2], draw: &mut Draw) -> f64 {
    draw.random_range(range[0]..range[1]).to_radians()
}
