//! Coefficients that are not those of the recording, in a sentence.

use super::number::three_digits;
use crate::run::{Change, Explanation, Mismatch};

const AXES: [&str; 3] = ["x", "y", "z"];

/// What was found, and what it could be.
pub fn sentence(found: &Mismatch) -> String {
    let [fixed, refit] = [found.fixed_nt, found.refit_nt].map(three_digits);
    let cause = match &found.explanation {
        Some(Explanation { change, left_nt }) => {
            format!("{}: then they leave {} nT", cause(change), three_digits(*left_nt))
        }
        None => {
            "another body, a sensor that was moved, or axes or units that neither a turn of axes nor a factor of ten \
                 explains; the adaptive methods learn it anew in some minutes"
                .into()
        }
    };
    format!(
        "The coefficients do not fit this recording: alone they leave {fixed} nT where a fit to it leaves {refit} nT; {cause}."
    )
}

fn cause(change: &Change) -> String {
    match change {
        Change::Axes([(0, false), (1, false), (2, true)]) => {
            "z points the other way than in the calibration, which wants z down: take its negative".into()
        }
        Change::Axes(axes) => {
            let [x, y, z] = axes.map(|(of, is_reversed)| format!("{}{}", if is_reversed { "-" } else { "" }, AXES[of]));
            format!("the fluxgate's axes are other than in the calibration: take {x}, {y}, {z} as its x, y, z")
        }
        Change::FluxUnit(factor) => {
            format!("the fluxgate is in another unit than in the calibration: multiply it by {factor}")
        }
        Change::ScalarUnit(factor) => {
            format!("the scalar is in another unit than in the calibration: multiply it by {factor}")
        }
    }
}
