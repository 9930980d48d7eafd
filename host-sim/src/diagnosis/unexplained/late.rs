//! By how much what is left is later than what drives it: the group of the first driver with its inputs moved in time, held against
//! the residual again.

use rayon::prelude::*;

use super::judged::Judged;
use super::left::Left;
use crate::diagnosis::policy::{EPOCH_S, PROPOSAL_LEAST_GAIN};
use crate::diagnosis::reconstruct::prepared::TILT;
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::Expr;
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::scene::Scene;

/// Rows by which it may be later, or earlier where a column is late itself.
const ROWS: std::ops::RangeInclusive<i32> = -20..=50;
/// Rows from one that is tried to the next, at first and then.
const STEPS: [i32; 2] = [4, 1];

/// Places in time that are tried, about.
const STEPS_TRIED: f64 = 27.0;

/// A group that is so many seconds later than its driver.
pub(super) struct Late {
    pub(super) judged: Judged,
    pub(super) delay_s: f64,
}

/// The first driver's group as it fits best in time; none where it fits as well as it is, or is late in itself.
pub(super) fn late(own: &Judged, quadratic: Vec<Expr>, left: &Left<'_>, scene: &Scene) -> Option<Late> {
    let input = own.group.input.as_str();
    let is_history = input == "attitude_history";
    if matches!(own.group.form, DriverForm::Delay | DriverForm::Variance) || matches!(input, "attitude" | "reading") {
        return None;
    }
    let shapes = if is_history { quadratic } else { own.group.shapes.clone() };
    let at = |rows: i32| {
        let moved = shapes.iter().map(|shape| later(shape, input, f64::from(rows) * EPOCH_S)).collect();
        Judged::of(Group { shapes: moved, tried: STEPS_TRIED, ..own.group.bare() }, left, scene)
    };
    let best = |tried: Vec<i32>| {
        let all = tried.into_par_iter().filter(|rows| *rows != 0).filter_map(|rows| Some((rows, at(rows)?)));
        all.max_by(|a, b| a.1.gain.total_cmp(&b.1.gain))
    };
    // Nothing remembers what comes.
    let from = if is_history { 1 } else { *ROWS.start() };
    let (about, _) = best((from..=*ROWS.end()).step_by(STEPS[0] as usize).collect())?;
    let (rows, judged) = best((about - STEPS[0]..=about + STEPS[0]).filter(|rows| *rows >= from).collect())?;
    // A memory that is a plain delay is one where that says as much as any other shape of it.
    let least = if is_history { own.gain } else { own.gain + PROPOSAL_LEAST_GAIN };
    (judged.gain >= least).then(|| Late { judged, delay_s: f64::from(rows) * EPOCH_S })
}

/// A shape with its driver so much later; a moment's own direction stays.
fn later(shape: &Expr, input: &str, time_s: f64) -> Expr {
    let is_driver = |name: &str| match input {
        "attitude_history" | "attitude_rate" => {
            name.starts_with("cx")
                || name.starts_with("cy")
                || name.starts_with("cz")
                || name.starts_with("dc")
                || name == "heading_deg"
                || TILT.iter().any(|(tilt, _)| *tilt == name)
        }
        "depth_rate" => name == "depth",
        column => name == column,
    };
    shape.with_variables(&|name| is_driver(name).then_some(Filter::Delay(time_s)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::shapes::expression::{times, var};

    #[test]
    fn a_moment_that_a_current_makes_is_late_with_the_current_and_turns_with_the_body() {
        let moment = times(&var("current_pump_A"), &var("cx"));
        let late = later(&moment, "current_pump_A", 0.5);
        assert_eq!(late, times(&var("current_pump_A").through(Filter::Delay(0.5)), &var("cx")));
        assert_eq!(later(&moment, "attitude_history", 0.5).name(), "current_pump_A * cx_delay_0p5s");
    }
}
