//! What a rest is drawn over: the courses that its driver has, and those that stand beside it.

use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::inputs::{AXES, fast_reading, reading_rate, tilts, turns, turns_of_direction};
use crate::diagnosis::shapes::scene::Scene;

/// The body's axes.
const WAYS: [&str; 3] = ["forward", "starboard", "down"];

/// What a driver is: the directions of an attitude, the axes of a turn, the course of a column; else time.
pub(super) fn own_axes(input: &str, group: Option<&Group>, scene: &Scene) -> Vec<Expr> {
    let recorded = |name: &str| scene.variable(name).map(|_| var(name));
    let attitude = || AXES.map(var).into_iter().chain(recorded("heading_deg")).chain(tilts(scene));
    let filtered = group.iter().flat_map(|group| &group.shapes).flat_map(Expr::filtered).cloned();
    let others: Vec<Expr> = match input {
        "attitude" => attitude().collect(),
        "attitude_rate" => turns(scene),
        "attitude_history" => filtered.chain(attitude()).collect(),
        column => recorded(column).into_iter().collect(),
    };
    let mut all: Vec<Expr> = group.iter().map(|group| group.over.clone()).collect();
    for axis in others {
        if !all.contains(&axis) {
            all.push(axis);
        }
    }
    if all.is_empty() { vec![var("t")] } else { all }
}

/// What a driver may be drawn beside: the direction that a moment turns with; the slope of a reading that is late, and the reading of which
/// a part is too much.
pub(super) fn beside(form: DriverForm) -> Vec<Expr> {
    let reading = match form {
        DriverForm::Delay => Some(reading_rate()),
        DriverForm::Multiplicative => Some(fast_reading(Expr::clone)),
        DriverForm::Additive | DriverForm::Variance => None,
    };
    AXES.map(var).into_iter().chain(reading).collect()
}

/// An axis in words, with its unit.
pub(super) fn label(over: &Expr) -> String {
    if let Some(axis) = turns_of_direction().iter().position(|turn| turn == over) {
        return format!("rate of turning about the {} axis, 1/s", WAYS[axis]);
    }
    match over {
        Expr::Variable(name) => named(name),
        Expr::Filtered(of, Filter::Rate) => format!("{}, change per s", label(of)),
        Expr::Filtered(of, _) => format!("{}, as it was before", label(of)),
        other if *other == reading_rate() => "slope of the reading, nT/s".into(),
        other if other.to_string().starts_with("(s") => "reading without its background, nT".into(),
        other if other.to_string().contains("heading_deg") => "rate of turning of the heading, 1/s".into(),
        other => other.to_string(),
    }
}

fn named(variable: &str) -> String {
    if let Some(axis) = AXES.iter().position(|axis| *axis == variable) {
        return format!("direction of the field along the body, {}", WAYS[axis]);
    }
    match variable {
        "t" => "time since the first row, s".into(),
        "depth" => "depth, m".into(),
        "temperature" => "temperature, °C".into(),
        "heading_deg" => "heading, °".into(),
        "roll_deg" => "roll, °".into(),
        "pitch_deg" => "pitch, °".into(),
        column => column.replace('_', " "),
    }
}
