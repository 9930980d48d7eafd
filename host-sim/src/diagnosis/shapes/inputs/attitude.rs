//! Where the body points.

use super::{AXES, Inputs, KNOTS, along_field, reading_rate, square, tilts};
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, Function, power, times, var};
use crate::diagnosis::shapes::group::Group;
use crate::effects::Channel;

/// Highest power of the direction.
const DEGREES: std::ops::RangeInclusive<usize> = 1..=6;
/// Powers of an axis of the fluxgate in its magnitude: of a scale, a curve without a middle, and one with.
const AXIS_POWERS: [usize; 3] = [2, 3, 4];
/// Turns of what is geared to the attitude, per turn of the heading.
const GEARS: std::ops::RangeInclusive<u32> = 3..=40;

impl Inputs<'_> {
    pub(super) fn attitude(&self) -> Vec<Vec<Group>> {
        let over = var("cx");
        let smooth = |degrees: usize| {
            let powers = (1..=degrees).flat_map(|d| self.powers(d)).collect();
            self.group("attitude", DriverForm::Additive, over.clone(), powers)
        };
        let bends = AXES.iter().flat_map(|axis| along_field(&self.bent(&var(axis), KNOTS))).collect();
        let bends = self.group("attitude", DriverForm::Additive, over.clone(), bends);
        let delays = AXES.iter().flat_map(|axis| [self.unit(&var(axis)), square(&self.unit(&var(axis)))]);
        let delays = delays.map(|shape| times(&reading_rate(), &shape)).collect();
        let delays = self.group("attitude", DriverForm::Delay, over.clone(), delays);
        let mut all = vec![vec![smooth(4)], vec![smooth(*DEGREES.end())], vec![bends], vec![delays]];
        if self.channel == Channel::Fluxgate {
            // An axis that is wrong by its own reading adds that times its share of the field.
            let curves = AXES.iter().flat_map(|axis| AXIS_POWERS.map(|of| power(&var(axis), of)));
            let curves = self.group("attitude", DriverForm::Additive, over.clone(), curves.collect());
            all.extend([vec![smooth(1)], vec![smooth(2)], vec![curves]]);
        }
        let tilts = tilts(self.scene);
        if !tilts.is_empty() {
            let bends = tilts.iter().flat_map(|tilt| along_field(&self.bent(tilt, KNOTS))).collect();
            all.push(vec![self.group("attitude", DriverForm::Additive, tilts[0].clone(), bends)]);
        }
        if self.scene.variable("heading_deg").is_some() {
            all.push(GEARS.map(|gear| self.geared(gear)).collect());
        }
        all
    }

    /// Products of the components of the direction, of which the square of the last is none of its own.
    pub(super) fn powers(&self, degree: usize) -> Vec<Expr> {
        let units = AXES.map(|axis| self.unit(&var(axis)));
        let of = |a: usize, b: usize, c: usize| {
            let parts = [vec![&units[0]; a], vec![&units[1]; b], vec![&units[2]; c]].concat();
            parts.into_iter().fold(Expr::Number(1.0), |product, part| times(&product, part))
        };
        (0..=1.min(degree))
            .flat_map(|c| (0..=degree - c).map(move |a| (a, degree - c - a, c)))
            .map(|(a, b, c)| of(a, b, c))
            .collect()
    }

    fn geared(&self, gear: u32) -> Group {
        let over = var("heading_deg");
        let angle = Expr::Product(vec![Expr::Number(f64::from(gear).to_radians()), over.clone()]);
        let turns = [angle.clone().apply(Function::Sin), angle.apply(Function::Cos)];
        let tried = f64::from(GEARS.end() - GEARS.start() + 1);
        Group { tried, ..self.group("attitude", DriverForm::Additive, over, along_field(&turns)) }
    }
}
