//! How fast the body turns.

use super::{AXES, Inputs, PLAYS, along_field, negative, reading_rate, square, tilts};
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, Function, scaled, times, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::scene::Scene;

const RATES: [&str; 3] = ["dcx", "dcy", "dcz"];

impl Inputs<'_> {
    pub(super) fn rate(&self) -> Vec<Vec<Group>> {
        let (mut bent, mut played, mut delays) = (Vec::new(), Vec::new(), Vec::new());
        let turns = turns(self.scene);
        let units: Vec<Expr> = turns.iter().map(|turn| scaled(turn, 0.0, self.width(turn).1)).collect();
        for (turn, unit) in turns.iter().zip(&units) {
            let tanh = |widths: f64| scaled(turn, 0.0, widths * self.width(turn).1).apply(Function::Tanh);
            let own = [unit.clone(), unit.clone().apply(Function::Abs), square(unit), tanh(0.3), tanh(1.0)];
            bent.extend(along_field(&own));
            let play = |of: f64| {
                let played = turn.through(Filter::Play(of * self.width(turn).1));
                scaled(&played, 0.0, 2.0 * self.width(turn).1).apply(Function::Tanh)
            };
            played.extend(along_field(&PLAYS.map(play)));
            delays.extend(own[..3].iter().map(|shape| times(&reading_rate(), shape)));
        }
        bent.extend((0..3).map(|i| times(&units[i], &units[(i + 1) % 3])));
        let bends = RATES
            .iter()
            .flat_map(|rate| along_field(&[self.unit(&var(rate)), self.unit(&var(rate).through(Filter::Rate))]));
        let bends = bends.collect();
        let group = |form, shapes| vec![self.group("attitude_rate", form, turns[2].clone(), shapes)];
        let together: Vec<Expr> = played.iter().chain(&bent).cloned().collect();
        vec![
            group(DriverForm::Additive, bent),
            group(DriverForm::Additive, bends),
            group(DriverForm::Additive, together),
            group(DriverForm::Delay, delays),
        ]
    }
}

/// How fast the body turns about each of its axes, as far as the field's direction shows it, and by an attitude sensor, if there is one.
pub(crate) fn turns(scene: &Scene) -> Vec<Expr> {
    let heading = scene.variable("heading_deg").is_some().then(turn_of_heading);
    let tilts = tilts(scene).into_iter().map(|tilt| tilt.through(Filter::Rate));
    turns_of_direction().into_iter().chain(heading).chain(tilts).collect()
}

/// By the field's direction, 1/s: components of the direction across its own rate.
pub(crate) fn turns_of_direction() -> [Expr; 3] {
    [0, 1, 2].map(|axis| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let back = Expr::Product(vec![Expr::Number(-1.0), var(AXES[j]), var(RATES[i])]);
        Expr::Sum(vec![Expr::Product(vec![var(AXES[i]), var(RATES[j])]), back])
    })
}

/// How fast the heading turns, 1/s, whatever full turns it jumps by.
fn turn_of_heading() -> Expr {
    let angle = || Expr::Product(vec![Expr::Number(1.0_f64.to_radians()), var("heading_deg")]);
    let (sin, cos) = (angle().apply(Function::Sin), angle().apply(Function::Cos));
    let ahead = times(&cos, &sin.through(Filter::Rate));
    Expr::Sum(vec![ahead, negative(&times(&sin, &cos.through(Filter::Rate)))])
}
