//! A recorded column, and the heave that a depth tells.

use super::{Inputs, KNOTS, SLOW_S, along_field, fast_reading, moments, negative, reading_rate, square};
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, times, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;
use crate::effects::Channel;

impl Inputs<'_> {
    /// Any recorded column, alone, as a moment, late, and as what makes the reading late.
    pub(super) fn column(&self, input: &str, name: &str) -> Vec<Vec<Group>> {
        let own = var(name);
        let group = |form, shapes| vec![self.group(input, form, own.clone(), shapes)];
        let late: Vec<Expr> = [0.5, 2.0, 5.0].map(|time_s| self.unit(&own.through(Filter::Lowpass(time_s)))).into();
        let unit = self.unit(&own);
        let varying = fast_reading(Expr::clone);
        // Of a moment that follows the column, what stays: the 18 terms have it, the fluxgate's magnitude has no terms.
        let still = if self.channel == Channel::Fluxgate { vec![Expr::Number(1.0)] } else { Vec::new() };
        vec![
            group(DriverForm::Additive, vec![unit.clone()]),
            group(DriverForm::Additive, self.bent(&own, KNOTS)),
            vec![Group {
                without_input: moments(&still).len(),
                ..self.group(input, DriverForm::Additive, own.clone(), moments(&[still, vec![unit.clone()]].concat()))
            }],
            group(DriverForm::Additive, along_field(&self.bent(&own, 3))),
            group(DriverForm::Additive, along_field(&[vec![unit.clone()], late].concat())),
            group(DriverForm::Delay, vec![times(&reading_rate(), &unit), times(&reading_rate(), &square(&unit))]),
            // Of the reading only what the 18 terms make can tell a factor from a sum.
            group(DriverForm::Multiplicative, vec![times(&varying, &unit), times(&varying, &square(&unit))]),
        ]
    }

    /// The speed of the heave, and what is a quarter of a period behind it.
    pub(super) fn heave(&self) -> Vec<Vec<Group>> {
        let depth = var("depth");
        let slow = negative(&depth.through(Filter::Lowpass(SLOW_S)));
        let fast = self.unit(&Expr::Sum(vec![depth.clone(), slow]));
        let rate = self.unit(&depth.through(Filter::Rate));
        let behind = self.unit(&depth.through(Filter::Hilbert));
        let group = |input, over: &Expr, shapes| vec![self.group(input, DriverForm::Additive, over.clone(), shapes)];
        let products = vec![times(&fast, &rate), times(&fast, &behind), square(&fast), square(&behind), square(&rate)];
        vec![
            group("depth_rate", &depth.through(Filter::Hilbert), vec![behind.clone()]),
            group("depth_rate", &depth.through(Filter::Rate), vec![rate.clone()]),
            group("depth_rate", &depth.through(Filter::Rate), self.bent(&depth.through(Filter::Rate), KNOTS)),
            group("depth_rate", &depth.through(Filter::Rate), along_field(&[rate, behind])),
            group("depth", &depth, products),
            group("depth", &depth, along_field(&[fast])),
        ]
    }
}
