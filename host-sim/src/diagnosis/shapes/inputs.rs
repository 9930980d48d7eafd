//! The inputs that may drive what is left, each with its families of smooth shapes. The order and the sizes of the families were written
//! before any recording was looked at; what they leave out, a shrunk fit of their neighbours takes in part.

use super::expression::{Expr, Function, scaled, times, var};
use super::filter::Filter;
use super::group::Group;
use super::scene::{Scene, knots, middle_and_width};
use crate::diagnosis::result::DriverForm;
use crate::effects::Channel;

const AXES: [&str; 3] = ["cx", "cy", "cz"];
const RATES: [&str; 3] = ["dcx", "dcy", "dcz"];
/// Highest power of the direction.
const DEGREES: std::ops::RangeInclusive<usize> = 1..=6;
/// Powers of an axis of the fluxgate in its magnitude: of a scale, a curve without a middle, and one with.
const AXIS_POWERS: [usize; 3] = [2, 3, 4];
/// Time constants and delays of a memory of the attitude, s; the short ones are those of eddy currents in plates.
const MEMORIES_S: [f64; 5] = [0.5, 1.5, 5.0, 15.0, 50.0];
const SHORT_MEMORIES_S: [f64; 3] = [0.1, 0.2, 0.4];
const DELAYS_S: [f64; 8] = [0.2, 0.4, 0.8, 1.2, 1.6, 2.4, 3.2, 4.8];
/// The same of the reading; it is early where the other columns are late.
const READING_MEMORIES_S: [f64; 4] = [0.1, 0.3, 1.0, 3.0];
const READING_DELAYS_S: [f64; 11] = [-0.4, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2, 1.6];
/// Widths of plays, over the spread.
const PLAYS: [f64; 3] = [0.3, 0.8, 1.6];
/// Knots of a bent line.
const KNOTS: usize = 8;
/// Time constant of what is the slow part, s.
const SLOW_S: f64 = 15.0;
/// Turns of the attitude, per turn of the heading, and of the reading, per spread.
const GEARS: std::ops::RangeInclusive<u32> = 3..=40;
const READING_TURNS: std::ops::RangeInclusive<u32> = 3..=30;

/// The direction and its squares, about their middles.
pub(crate) fn quadratic(scene: &Scene) -> Vec<Expr> {
    let at = Inputs { scene, channel: Channel::Scalar };
    (1..=2).flat_map(|degree| at.powers(degree)).collect()
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

/// The same without those of the reading.
pub(crate) fn groups_but_reading(scene: &Scene, channel: Channel) -> Vec<Vec<Group>> {
    let at = Inputs { scene, channel };
    let mut all: Vec<Vec<Group>> = at.attitude();
    all.extend(at.rate());
    all.extend(at.history());
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

    fn attitude(&self) -> Vec<Vec<Group>> {
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
            let curves = AXES.iter().flat_map(|axis| AXIS_POWERS.map(|power| times_itself(&var(axis), power)));
            let curves = self.group("attitude", DriverForm::Additive, over.clone(), curves.collect());
            all.extend([vec![smooth(1)], vec![smooth(2)], vec![curves]]);
        }
        if self.scene.variable("heading_deg").is_some() {
            all.push(GEARS.map(|gear| self.geared(gear)).collect());
        }
        all
    }

    /// Products of the components of the direction, of which the square of the last is none of its own.
    fn powers(&self, degree: usize) -> Vec<Expr> {
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

    fn rate(&self) -> Vec<Vec<Group>> {
        let (mut bent, mut played, mut delays) = (Vec::new(), Vec::new(), Vec::new());
        let mut turns = turns().to_vec();
        if self.scene.variable("heading_deg").is_some() {
            turns.push(turn_of_heading());
        }
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

    fn history(&self) -> Vec<Vec<Group>> {
        let through = |filters: &[Filter]| -> Vec<Expr> {
            let courses =
                AXES.iter().flat_map(|axis| filters.iter().map(|filter| self.unit(&var(axis).through(*filter))));
            along_field(&courses.collect::<Vec<Expr>>())
        };
        let lows = through(&MEMORIES_S.map(Filter::Lowpass));
        let short = through(&SHORT_MEMORIES_S.map(Filter::Lowpass));
        let lates = through(&DELAYS_S.map(Filter::Delay));
        let plays = AXES.iter().flat_map(|axis| [var(axis), fast(&var(axis))]).flat_map(|own| {
            let play = |of: f64| self.unit(&own.through(Filter::Play(of * self.width(&own).1)));
            along_field(&PLAYS.map(play))
        });
        let plays: Vec<Expr> = plays.collect();
        // A memory that gives way at once where the attitude turns: the sign of how far it is ahead of its own past.
        let ahead = AXES.iter().flat_map(|axis| {
            let of = |time_s: f64| {
                let behind = Expr::Product(vec![Expr::Number(-1.0), var(axis).through(Filter::Lowpass(time_s))]);
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
        vec![group(short), group(lows), group(lates), group(plays), group(ahead), group(together)]
    }

    fn reading(&self) -> Vec<Vec<Group>> {
        let (s, rate) = (level(), reading_rate());
        let fast =
            fast_reading(|part| Expr::Sum(vec![part.clone(), negative(&part.through(Filter::Lowpass(2.0 * SLOW_S)))]));
        let unit_rate = scaled(&rate, 0.0, self.width(&rate).1);
        let bend = self.unit(&fast_reading(|part| part.through(Filter::Rate).through(Filter::Rate)));
        let group = |form, over: &Expr, shapes| vec![self.group("reading", form, over.clone(), shapes)];
        let smeared = READING_MEMORIES_S.map(Filter::Lowpass).into_iter().chain(READING_DELAYS_S.map(Filter::Delay));
        // What a filter changes: of the reading as it is the 18 terms would take every part, and be others with the effect than without.
        let change = |filter: Filter| fast_reading(|part| Expr::Sum(vec![part.through(filter), negative(part)]));
        let smeared: Vec<Expr> =
            smeared.map(|filter| self.unit(&change(filter))).chain([unit_rate.clone(), bend]).collect();
        let late = [unit_rate.clone(), times(&rate, &self.unit(&s)), times(&rate, &self.unit(&fast))];
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
            group(DriverForm::Delay, &rate, late.into()),
            group(DriverForm::Delay, &rate, smeared),
            READING_TURNS.map(|tenths| self.beat(tenths)).collect(),
        ]
    }

    /// What goes round and round as the reading changes.
    fn beat(&self, tenths: u32) -> Group {
        let turns = f64::from(tenths) / 10.0;
        let angle = |times: f64| {
            let unit = self.unit(&level());
            Expr::Product(vec![Expr::Number(std::f64::consts::TAU * turns * times), unit])
        };
        let harmonics = [1.0, 2.0, 3.0].map(angle);
        let shapes =
            harmonics.into_iter().flat_map(|angle| [angle.clone().apply(Function::Sin), angle.apply(Function::Cos)]);
        let tried = f64::from(READING_TURNS.end() - READING_TURNS.start() + 1);
        Group { tried, ..self.group("reading", DriverForm::Additive, level(), shapes.collect()) }
    }

    /// Any recorded column, alone, as a moment, late, and as what makes the reading late.
    fn column(&self, input: &str, name: &str) -> Vec<Vec<Group>> {
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
    fn heave(&self) -> Vec<Vec<Group>> {
        let depth = var("depth");
        let slow = Expr::Product(vec![Expr::Number(-1.0), depth.through(Filter::Lowpass(SLOW_S))]);
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

/// What the 18 terms make of the clean reading, each part of it as `of` has it: the rest of the reading is a background, into which a
/// little of any gap may have gone.
fn fast_reading(of: impl Fn(&Expr) -> Expr) -> Expr {
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
    Expr::Sum(vec![x.clone(), Expr::Product(vec![Expr::Number(-1.0), x.through(Filter::Lowpass(2.0 * SLOW_S))])])
}

/// How fast the body turns about each of its axes, as far as the field's direction shows it, 1/s: components of the direction
/// across its own rate.
pub(crate) fn turns() -> [Expr; 3] {
    [0, 1, 2].map(|axis| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let back = Expr::Product(vec![Expr::Number(-1.0), var(AXES[j]), var(RATES[i])]);
        Expr::Sum(vec![Expr::Product(vec![var(AXES[i]), var(RATES[j])]), back])
    })
}

/// How fast the heading turns, 1/s, whatever full turns it jumps by.
pub(crate) fn turn_of_heading() -> Expr {
    let angle = || Expr::Product(vec![Expr::Number(1.0_f64.to_radians()), var("heading_deg")]);
    let (sin, cos) = (angle().apply(Function::Sin), angle().apply(Function::Cos));
    let ahead = times(&cos, &sin.through(Filter::Rate));
    Expr::Sum(vec![ahead, negative(&times(&sin, &cos.through(Filter::Rate)))])
}

fn square(x: &Expr) -> Expr {
    times(x, x)
}

fn times_itself(x: &Expr, power: usize) -> Expr {
    (0..power).fold(Expr::Number(1.0), |product, _| times(&product, x))
}

/// Each as a moment in body axes.
fn moments(courses: &[Expr]) -> Vec<Expr> {
    courses.iter().flat_map(|course| AXES.map(|axis| times(course, &var(axis)))).collect()
}

/// Each alone and as a moment.
pub(crate) fn along_field(courses: &[Expr]) -> Vec<Expr> {
    courses.iter().cloned().chain(moments(courses)).collect()
}
