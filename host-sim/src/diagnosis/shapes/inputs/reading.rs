//! The reading itself.

use super::{Inputs, KNOTS, fast, fast_reading, level, negative, reading_rate, square};
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, Function, scaled, times, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;

/// Time constants and delays of a filter of the reading, s; it is early where the other columns are late.
const READING_MEMORIES_S: [f64; 4] = [0.1, 0.3, 1.0, 3.0];
const READING_DELAYS_S: [f64; 11] = [-0.4, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2, 1.6];
/// Turns of what the reading beats with, in tenths per spread.
const READING_TURNS: std::ops::RangeInclusive<u32> = 3..=30;

impl Inputs<'_> {
    pub(super) fn reading(&self) -> Vec<Vec<Group>> {
        let (s, rate) = (level(), reading_rate());
        let fast = fast_reading(fast);
        let unit_rate = scaled(&rate, 0.0, self.width(&rate).1);
        let unit = self.unit(&s);
        let bend = self.unit(&fast_reading(|part| part.through(Filter::Rate).through(Filter::Rate)));
        let group = |form, over: &Expr, shapes| vec![self.group("reading", form, over.clone(), shapes)];
        let smeared = READING_MEMORIES_S.map(Filter::Lowpass).into_iter().chain(READING_DELAYS_S.map(Filter::Delay));
        // What a filter changes: of the reading as it is the 18 terms would take every part, and be others with the effect than without.
        let change = |filter: Filter| fast_reading(|part| Expr::Sum(vec![part.through(filter), negative(part)]));
        let smeared: Vec<Expr> =
            smeared.map(|filter| self.unit(&change(filter))).chain([unit_rate.clone(), bend]).collect();
        // A counter is late by the whole reading: the slow background has smeared a target that the reading has.
        let late = [s.clone(), fast.clone(), var("s")].map(|own| times(&rate, &self.unit(&own)));
        let late = std::iter::once(unit_rate.clone()).chain(late).collect();
        let slews = [
            unit_rate.clone().apply(Function::Abs),
            square(&unit_rate),
            unit_rate.clone().apply(Function::Tanh),
            unit_rate,
        ];
        vec![
            group(DriverForm::Additive, &s, self.bent(&s, 2 * KNOTS)),
            group(DriverForm::Additive, &fast, self.bent(&fast, KNOTS)),
            group(DriverForm::Additive, &rate, slews.into_iter().chain(self.bent(&rate, KNOTS)).collect()),
            group(DriverForm::Delay, &rate, late),
            group(DriverForm::Delay, &rate, smeared),
            READING_TURNS.map(|tenths| self.beat(&unit, tenths)).collect(),
        ]
    }

    /// What goes round and round as the reading, in units of its spread, changes.
    fn beat(&self, unit: &Expr, tenths: u32) -> Group {
        let turns = f64::from(tenths) / 10.0;
        let angle = |times: f64| Expr::Product(vec![Expr::Number(std::f64::consts::TAU * turns * times), unit.clone()]);
        let harmonics = [1.0, 2.0, 3.0].map(angle);
        let shapes =
            harmonics.into_iter().flat_map(|angle| [angle.clone().apply(Function::Sin), angle.apply(Function::Cos)]);
        let tried = f64::from(READING_TURNS.end() - READING_TURNS.start() + 1);
        Group { tried, ..self.group("reading", DriverForm::Additive, level(), shapes.collect()) }
    }
}
