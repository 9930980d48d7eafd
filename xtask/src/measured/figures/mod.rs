//! The quick figures, one a file.

mod diagnosed_flights;
mod diagnosis_speed;
mod firmware;
mod flights;
mod precision;
mod sample;
mod speed;
mod targets;
mod tows;

use anyhow::Result;

use super::tools::Tools;

/// A figure of the page.
pub(super) struct Figure {
    /// As it is called in its marker and on the command line.
    pub(super) name: &'static str,
    /// Without which it cannot be measured.
    pub(super) needs: Needs,
    /// The share of its size by which a number may differ from run to run; 0 where every run gives the same.
    pub(super) share: f64,
    /// Gives it in Markdown.
    pub(super) measure: fn(&Tools) -> Result<String>,
}

/// What is not in every clone.
#[derive(Clone, Copy)]
pub(super) enum Needs {
    Nothing,
    Flights,
    Emulator,
}

/// What a machine that does something else as well may change of a time.
const TIMES: f64 = 0.3;

/// All of them, in the order of the page.
pub(super) const FIGURES: [Figure; 10] = [
    Figure { name: "sample", needs: Needs::Nothing, share: 0.0, measure: sample::measure },
    Figure { name: "flights", needs: Needs::Flights, share: 0.0, measure: flights::measure },
    Figure { name: "targets", needs: Needs::Flights, share: 0.0, measure: targets::measure },
    Figure { name: "tows", needs: Needs::Nothing, share: 0.0, measure: tows::measure },
    Figure { name: "precision", needs: Needs::Nothing, share: 0.0, measure: precision::measure },
    Figure { name: "diagnosed-flights", needs: Needs::Flights, share: 0.0, measure: diagnosed_flights::measure },
    Figure { name: "speed", needs: Needs::Nothing, share: TIMES, measure: speed::measure },
    Figure { name: "diagnosis-speed", needs: Needs::Nothing, share: TIMES, measure: diagnosis_speed::measure },
    Figure { name: "firmware", needs: Needs::Emulator, share: 0.0, measure: firmware::measure },
    Figure { name: "shape", needs: Needs::Nothing, share: 0.0, measure: |_| Ok(crate::shape::table()) },
];
