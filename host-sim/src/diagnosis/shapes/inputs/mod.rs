//! The inputs that may drive what is left, each with its families of smooth shapes. The order and the sizes of the families were written
//! before any recording was looked at, but for the short memories, the leads, the curves of a fluxgate's axes and the moments that stay, which
//! effects withheld on seed 9302 asked for. What they leave out, a shrunk fit of their neighbours takes in part.

mod attitude;
mod column;
mod history;
mod rate;
mod reading;

pub(crate) use self::rate::{turns, turns_of_direction};
use super::expression::{Expr, Function, scaled, times, var};
use super::filter::Filter;
use super::group::Group;
use super::scene::{Scene, knots, middle_and_width};
use crate::diagnosis::reconstruct::prepared::TILT;
use crate::diagnosis::result::DriverForm;
use crate::effects::Channel;

pub(crate) const AXES: [&str; 3] = ["cx", "cy", "cz"];
/// Widths of plays, over the spread.
const PLAYS: [f64; 3] = [0.3, 0.8, 1.6];
/// Knots of a bent line.
const KNOTS: usize = 8;
/// Time constant of what is the slow part, s.
const SLOW_S: f64 = 15.0;

/// The direction and its squares, about their middles.
pub(crate) fn quadratic(scene: &Scene) -> Vec<Expr> {
    let at = Inputs { scene, channel: Channel::Scalar };
    (1..=2).flat_map(|degree| at.powers(degree)).collect()
}

/// How the body is tilted: roll and pitch, of those that an attitude sensor recorded. The direction of the field tells neither, as a turn about
/// it does not show.
pub(crate) fn tilts(scene: &Scene) -> Vec<Expr> {
    let names = TILT.iter().map(|(name, _)| *name);
    names.filter(|name| scene.variable(name).is_some()).map(var).collect()
}

/// Every group that makes sense on a recording, and the sets of which only the best counts.
pub(crate) fn groups(scene: &Scene, channel: Channel) -> Vec<Vec<Group>> {
    let mut all = groups_but_reading(scene, channel);
    // The fluxgate's magnitude does not drive itself.
    if channel == Channel::Scalar {
        all.extend(Inputs { scene, channel }.reading());
    }
    all
}

/// Those of the reading of which not only the best of a set counts.
pub(crate) fn of_reading(scene: &Scene) -> Vec<Group> {
    let sets = Inputs { scene, channel: Channel::Scalar }.reading();
    sets.into_iter().filter(|set| set.len() == 1).flatten().collect()
}

/// The same without those of the reading.
pub(crate) fn groups_but_reading(scene: &Scene, channel: Channel) -> Vec<Vec<Group>> {
    let at = Inputs { scene, channel };
    let ((mut all, rate), history) = rayon::join(|| (at.attitude(), at.rate()), || at.history());
    all.extend(rate.into_iter().chain(history));
    for (input, name) in [("depth", "depth"), ("temperature", "temperature")] {
        if scene.variable(name).is_some() {
            all.extend(at.column(input, name));
        }
    }
    if scene.variable("depth").is_some() {
        all.extend(at.heave());
    }
    all.extend(scene.columns.iter().flat_map(|name| at.column(name, name)));
    all
}

struct Inputs<'b> {
    scene: &'b Scene,
    channel: Channel,
}

impl Inputs<'_> {
    fn width(&self, of: &Expr) -> (f64, f64) {
        let values = of.evaluate(self.scene).unwrap_or_default();
        let (middle, width) = if values.is_empty() { (0.0, 1.0) } else { middle_and_width(&values) };
        (middle, if width > 0.0 { width } else { 1.0 })
    }

    /// About its middle, over its spread.
    fn unit(&self, of: &Expr) -> Expr {
        let (middle, width) = self.width(of);
        scaled(of, middle, width)
    }

    /// A straight line bent at some quantiles.
    fn bent(&self, of: &Expr, count: usize) -> Vec<Expr> {
        let Some(values) = of.evaluate(self.scene) else { return Vec::new() };
        let (_, width) = self.width(of);
        let bend = |knot: f64| scaled(of, knot, width).apply(Function::Positive);
        std::iter::once(self.unit(of)).chain(knots(&values, count).into_iter().map(bend)).collect()
    }

    fn group(&self, input: &str, form: DriverForm, over: Expr, shapes: Vec<Expr>) -> Group {
        Group { input: input.into(), form, shapes, over, tried: 1.0, without_input: 0 }
    }
}

/// What the 18 terms make of the clean reading, each part of it as `of` has it: the rest of the reading is a background, into which a
/// little of any gap may have gone.
pub(crate) fn fast_reading(of: impl Fn(&Expr) -> Expr) -> Expr {
    Expr::Sum(vec![of(&var("s")), negative(&of(&var("F")))])
}

/// The clean reading with its slow background.
fn level() -> Expr {
    Expr::Sum(vec![var("s"), negative(&var("F")), var("F").through(Filter::Lowpass(2.0 * SLOW_S))])
}

/// The slope of the clean reading.
pub(crate) fn reading_rate() -> Expr {
    fast_reading(|part| part.through(Filter::Rate))
}

fn negative(x: &Expr) -> Expr {
    Expr::Product(vec![Expr::Number(-1.0), x.clone()])
}

/// What is not slow of it.
pub(crate) fn fast(x: &Expr) -> Expr {
    Expr::Sum(vec![x.clone(), negative(&x.through(Filter::Lowpass(2.0 * SLOW_S)))])
}

fn square(x: &Expr) -> Expr {
    times(x, x)
}

/// Each as a moment in body axes.
fn moments(courses: &[Expr]) -> Vec<Expr> {
    courses.iter().flat_map(|course| AXES.map(|axis| times(course, &var(axis)))).collect()
}

/// Each alone and as a moment.
pub(crate) fn along_field(courses: &[Expr]) -> Vec<Expr> {
    courses.iter().cloned().chain(moments(courses)).collect()
}
