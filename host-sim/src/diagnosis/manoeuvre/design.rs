//! The manoeuvres that may be asked for, and the trajectory of each.

use towmag::model::TERMS;

use super::kind::ManoeuvreKind;
use crate::diagnosis::policy::{HEADING_MIN, MANOEUVRE_MINUTES, RATE_HZ};
use crate::diagnosis::reconstruct::smooth::slow;
use crate::effects::{Driver, no_draw};
use crate::simulator::signals::{Signals, Trajectory};
use crate::simulator::{Course, Motion, Oscillation};

/// Length that each is simulated for, s.
pub(crate) const LENGTH_S: f64 = 240.0;
/// Points per second of the trajectory, and how long it goes on beyond the rows, s.
const DENSE_RATE_HZ: f64 = 50.0;
const MARGIN_S: f64 = 4.0;
/// Time of a turn, s.
const TURN_S: f64 = 10.0;
/// Sines of an oscillation.
const SINES: usize = 4;
/// Where heave lies, Hz.
const HEAVE_HZ: [f64; 2] = [0.1, 0.2];
/// Window that parts heave from slow changes of depth, rows.
const HEAVE_ROWS: usize = 80;

/// A manoeuvre.
#[derive(Debug)]
pub(crate) struct Manoeuvre {
    pub(crate) kind: ManoeuvreKind,
    /// Legs, and the turn after each, degrees.
    legs: f64,
    turn_deg: f64,
    /// Rocking about each axis: degrees rms, and from which to which frequency.
    rocking_rms_deg: f64,
    rocking_hz: [f64; 2],
    /// Share of each leg in which one axis after the other is rocked; 0: all at once.
    one_by_one: f64,
    depth: Depth,
    /// What does not act there.
    pub(crate) without: Option<Driver>,
}

/// What the depth does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Depth {
    /// The heave of the recording.
    Heave,
    /// Up and down by so many metres with such a period, s, in flat water.
    YoYo { by_m: f64, period_s: f64 },
}

/// Four headings at right angles, rocked about one axis after the other: what the others differ from.
const ROCKED: Manoeuvre = Manoeuvre {
    kind: ManoeuvreKind::FourHeadings,
    legs: 4.0,
    turn_deg: 90.0,
    rocking_rms_deg: 5.0,
    rocking_hz: [0.13, 0.17],
    one_by_one: 1.0,
    depth: Depth::Heave,
    without: None,
};

pub(crate) const MANOEUVRES: [Manoeuvre; 6] = [
    Manoeuvre { kind: ManoeuvreKind::Shake, rocking_rms_deg: 1.4, rocking_hz: [0.9, 1.1], one_by_one: 0.0, ..ROCKED },
    Manoeuvre { kind: ManoeuvreKind::FourHeadings, ..ROCKED },
    Manoeuvre { kind: ManoeuvreKind::EightHeadings, legs: 8.0, turn_deg: 45.0, ..ROCKED },
    Manoeuvre {
        kind: ManoeuvreKind::YoYo,
        legs: 1.0,
        rocking_rms_deg: 1.0,
        rocking_hz: [0.1, 0.3],
        one_by_one: 0.0,
        depth: Depth::YoYo { by_m: 2.0, period_s: 12.0 },
        without: Some(Driver::Swell),
        ..ROCKED
    },
    Manoeuvre { kind: ManoeuvreKind::ThereAndBack, legs: 3.0, turn_deg: 180.0, ..ROCKED },
    Manoeuvre {
        kind: ManoeuvreKind::Still,
        legs: 1.0,
        rocking_rms_deg: 1.5,
        rocking_hz: [0.1, 0.3],
        one_by_one: 0.0,
        without: Some(Driver::Loads),
        ..ROCKED
    },
];

/// What a recording says of the body and of where it is.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    field_nt: f64,
    /// Of the field, north (magnetic), east, down.
    direction: [f64; 3],
    coefficients: [f64; TERMS],
    /// Mean depth and heave, m, rms.
    depth_m: Option<[f64; 2]>,
    /// Temperature at first, and change over the recording.
    temperature_deg_c: Option<[f64; 2]>,
    currents_a: Vec<(String, Vec<f64>)>,
    /// Other columns that an effect may need.
    columns: Vec<(String, Vec<f64>)>,
}

impl Place {
    /// A towed body is level on the whole: the mean of the field's third component is the sine of its inclination.
    pub(crate) fn of(signals: &Signals) -> Self {
        let (rows, trajectory) = (signals.rows(), signals.trajectory());
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / signals.len().max(1) as f64;
        let sine = mean(&mut rows.direction.iter().map(|c| c[2])).clamp(-1.0, 1.0);
        let depth_m = trajectory.depth_m.as_ref().map(|depth_m| {
            let slow_m = slow(depth_m, HEAVE_ROWS);
            let square = mean(&mut depth_m.iter().zip(&slow_m).map(|(all, slow)| (all - slow).powi(2)));
            [mean(&mut depth_m.iter().copied()), square.sqrt()]
        });
        let ends = |column: &Vec<f64>| [column[0], column[column.len() - 1] - column[0]];
        Self {
            field_nt: mean(&mut rows.field_nt.iter().copied()),
            direction: [(1.0 - sine * sine).sqrt(), 0.0, sine],
            coefficients: *signals.coefficients(),
            depth_m,
            temperature_deg_c: trajectory.temperature_deg_c.as_ref().map(ends),
            currents_a: trajectory.currents_a.clone(),
            columns: trajectory.columns.clone(),
        }
    }

    /// Whether a manoeuvre has a meaning there: without a depth, none that changes it.
    pub(crate) fn allows(&self, manoeuvre: &Manoeuvre) -> bool {
        manoeuvre.depth == Depth::Heave || self.depth_m.is_some()
    }
}

impl Manoeuvre {
    /// A shorter one would not have all its headings.
    pub(crate) fn least_minutes(&self) -> f64 {
        (HEADING_MIN * self.legs).max(MANOEUVRE_MINUTES[0])
    }

    /// The signals of the body, were it sailed where the recording was made.
    pub(crate) fn signals(&self, place: &Place) -> Signals {
        Signals::new(self.trajectory(place), place.coefficients)
    }

    fn trajectory(&self, place: &Place) -> Trajectory {
        let epochs_s: Vec<f64> = (0..(LENGTH_S * RATE_HZ) as u32).map(|row| f64::from(row) / RATE_HZ).collect();
        let direction = self.direction(place);
        Trajectory {
            rate_hz: DENSE_RATE_HZ,
            start_s: -MARGIN_S,
            field_nt: vec![place.field_nt; direction.len()],
            direction,
            first_row_time_s: 0.0,
            depth_m: place.depth_m.map(|depth| self.depth_m(depth, &epochs_s)),
            temperature_deg_c: place.temperature_deg_c.map(|course| warmed(course, &epochs_s)),
            currents_a: repeated(&place.currents_a, epochs_s.len()),
            columns: repeated(&place.columns, epochs_s.len()),
            epochs_s,
        }
    }

    /// Direction of the field in body axes, on the dense grid.
    fn direction(&self, place: &Place) -> Vec<[f64; 3]> {
        let motion = self.motion();
        let attitude = |point: usize| motion.attitude(point as f64 / DENSE_RATE_HZ - MARGIN_S);
        let len = ((LENGTH_S + 2.0 * MARGIN_S) * DENSE_RATE_HZ) as usize;
        (0..len).map(|point| attitude(point).to_body(place.direction)).collect()
    }

    /// Legs with turns, and rocking about each axis.
    fn motion(&self) -> Motion {
        let course = Course {
            first_heading_deg: 20.0,
            leg_s: LENGTH_S / self.legs - TURN_S,
            turn_s: TURN_S,
            turn_deg: if self.legs > 1.0 { self.turn_deg } else { 0.0 },
            alternates: false,
        };
        let [low_hz, high_hz] = self.rocking_hz;
        let mut draw = no_draw();
        let oscillations =
            [(); 3].map(|()| Oscillation::random(self.rocking_rms_deg, low_hz, high_hz, SINES, &mut draw));
        Motion { course, oscillations, one_by_one: self.one_by_one }
    }

    /// Depth at each row, m: mean and heave (rms) of the recording, or up and down.
    fn depth_m(&self, [mean_m, heave_m]: [f64; 2], epochs_s: &[f64]) -> Vec<f64> {
        // An oscillation in radians from degrees: metres in, metres out.
        let heave = Oscillation::random(heave_m.to_degrees(), HEAVE_HZ[0], HEAVE_HZ[1], SINES, &mut no_draw());
        let offset_m = |time_s: f64| match self.depth {
            Depth::Heave => heave.angle(time_s),
            Depth::YoYo { by_m, period_s } => by_m * libm::sin(std::f64::consts::TAU * time_s / period_s),
        };
        epochs_s.iter().map(|&time_s| mean_m + offset_m(time_s)).collect()
    }
}

/// A temperature that changes over the manoeuvre by as much as over the recording, from the same first value.
fn warmed([first, change]: [f64; 2], epochs_s: &[f64]) -> Vec<f64> {
    epochs_s.iter().map(|t| first + change * t / LENGTH_S).collect()
}

/// Columns again and again: loads go on and off as they did.
fn repeated(columns: &[(String, Vec<f64>)], rows: usize) -> Vec<(String, Vec<f64>)> {
    let one = |column: &Vec<f64>| (0..rows).map(|row| column[row % column.len()]).collect();
    columns.iter().map(|(name, column)| (name.clone(), one(column))).collect()
}
