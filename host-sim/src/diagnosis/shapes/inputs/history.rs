//! How the body pointed before.

use super::{AXES, Inputs, PLAYS, along_field, fast, negative, tilts};
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, Function, scaled, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;

/// Time constants and delays of a memory of the attitude, s; the short ones are those of eddy currents in plates.
const MEMORIES_S: [f64; 5] = [0.5, 1.5, 5.0, 15.0, 50.0];
const SHORT_MEMORIES_S: [f64; 3] = [0.1, 0.2, 0.4];
const DELAYS_S: [f64; 8] = [0.2, 0.4, 0.8, 1.2, 1.6, 2.4, 3.2, 4.8];

impl Inputs<'_> {
    pub(super) fn history(&self) -> Vec<Vec<Group>> {
        let (axes, tilts) = (AXES.map(var), tilts(self.scene));
        let lows = self.through(&axes, &MEMORIES_S.map(Filter::Lowpass));
        let short = self.through(&axes, &SHORT_MEMORIES_S.map(Filter::Lowpass));
        let lates = self.through(&axes, &DELAYS_S.map(Filter::Delay));
        let played = |own: &Expr| {
            let play = |of: f64| self.unit(&own.through(Filter::Play(of * self.width(own).1)));
            along_field(&PLAYS.map(play))
        };
        let plays: Vec<Expr> =
            AXES.iter().flat_map(|axis| [var(axis), fast(&var(axis))]).flat_map(|own| played(&own)).collect();
        // A memory that gives way at once where the attitude turns: the sign of how far it is ahead of its own past.
        let ahead = AXES.iter().flat_map(|axis| {
            let of = |time_s: f64| {
                let behind = negative(&var(axis).through(Filter::Lowpass(time_s)));
                let ahead = Expr::Sum(vec![var(axis), behind]);
                let (_, width) = self.width(&ahead);
                scaled(&ahead, 0.0, width).apply(Function::Tanh)
            };
            along_field(&[0.5, 1.5, 5.0].map(of))
        });
        let ahead: Vec<Expr> = ahead.chain(lows.iter().cloned()).collect();
        let over = var("cx").through(Filter::Lowpass(1.5));
        let group = |shapes| vec![self.group("attitude_history", DriverForm::Additive, over.clone(), shapes)];
        let together = plays.iter().chain(&lows).cloned().collect();
        let of_tilts = || {
            let remembered = self.through(&tilts, &MEMORIES_S.map(Filter::Lowpass));
            tilts.iter().flat_map(played).chain(remembered).collect()
        };
        let tilted = (!tilts.is_empty()).then(|| group(of_tilts()));
        let all = vec![group(short), group(lows), group(lates), group(plays), group(ahead), group(together)];
        all.into_iter().chain(tilted).collect()
    }

    /// Each course through each filter, alone and as a moment.
    fn through(&self, courses: &[Expr], filters: &[Filter]) -> Vec<Expr> {
        let all = courses.iter().flat_map(|course| filters.iter().map(|filter| self.unit(&course.through(*filter))));
        along_field(&all.collect::<Vec<Expr>>())
    }
}
