//! What is recorded beside the sensors, and what is missing: different in every recording, and no gap.

use std::ops::Range;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::grid::Grid;
use crate::random::Random;

/// The columns and the holes of a recording.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// `time_s` of the first row.
    pub(super) first_time_s: f64,
    /// Whether depth is recorded, if the body has one.
    pub(super) has_depth: bool,
    /// Whether temperature is.
    pub(super) has_temperature: bool,
    /// Whether heading, roll and pitch are.
    pub(super) has_heading: bool,
    /// A load and its current at each row, A.
    pub(super) load: Option<(&'static str, Vec<f64>)>,
    /// Rows that were lost.
    pub(super) lost: Vec<Range<usize>>,
    /// Rows that the scalar sensor flags as invalid.
    pub(super) invalid: Vec<Range<usize>>,
    /// Whether there is a column of validity at all.
    pub(super) has_valid: bool,
    /// Decimals of scalar and fluxgate, of a fine recorder.
    pub(super) decimals: [usize; 2],
    /// Temperature at each row, degC.
    pub(super) temperature_deg_c: Vec<f64>,
}

impl Columns {
    pub(super) fn draw(rows: usize, draw: &mut Random) -> Self {
        let has_holes = draw.random_bool(0.25);
        let has_invalid = draw.random_bool(0.3);
        Self {
            first_time_s: *pick(&[0.0, 100.0, 36_000.0, 86_399.9], draw),
            has_depth: draw.random_bool(0.8),
            has_temperature: draw.random_bool(0.8),
            has_heading: draw.random_bool(0.3),
            load: load(rows, draw),
            lost: if has_holes { stretches(rows, 3, [5, 150], draw) } else { Vec::new() },
            invalid: if has_invalid { stretches(rows, 4, [1, 30], draw) } else { Vec::new() },
            has_valid: has_invalid || draw.random_bool(0.5),
            decimals: [*pick(&[3, 4], draw), *pick(&[2, 3], draw)],
            temperature_deg_c: temperature_deg_c(rows, draw),
        }
    }

    /// Nothing beside the sensors; rows that are not there are lost.
    pub(super) fn none(first_time_s: f64, there: &[bool]) -> Self {
        let mut lost: Vec<Range<usize>> = Vec::new();
        for row in (0..there.len()).filter(|&row| !there[row]) {
            match lost.last_mut() {
                Some(last) if last.end == row => last.end += 1,
                _ => lost.push(row..row + 1),
            }
        }
        Self {
            first_time_s,
            has_depth: false,
            has_temperature: false,
            has_heading: false,
            load: None,
            lost,
            invalid: Vec::new(),
            has_valid: false,
            decimals: [4, 4],
            temperature_deg_c: Vec::new(),
        }
    }

    /// Rows that are written.
    pub(super) fn is_kept(&self, row: usize) -> bool {
        !self.lost.iter().any(|lost| lost.contains(&row))
    }

    /// Rows of each stretch without a gap.
    pub(super) fn segments(&self, rows: usize) -> Vec<Range<usize>> {
        let mut segments = Vec::new();
        let mut start = 0;
        for lost in &self.lost {
            segments.push(start..lost.start);
            start = lost.end;
        }
        segments.push(start..rows);
        segments
    }
}

/// A load without a rhythm whose current is recorded: one that is switched, or a motor.
fn load(rows: usize, draw: &mut Random) -> Option<(&'static str, Vec<f64>)> {
    let is_motor = draw.random_bool(0.5);
    draw.random_bool(0.5).then(|| match is_motor {
        true => (*pick(&["winch", "rudder", "pump"], draw), motor_current_a(rows, draw)),
        false => (*pick(&["strobe", "pump", "heater"], draw), current_a(rows, draw)),
    })
}

/// Up to `most` stretches, in order and apart.
fn stretches(rows: usize, most: usize, lengths: [usize; 2], draw: &mut Random) -> Vec<Range<usize>> {
    let count = draw.random_range(1..=most);
    let each = rows / (count + 1);
    let stretch = |k: usize| {
        let start = k * each + each / 2 + draw.random_range(0..each / 4);
        start..start + draw.random_range(lengths[0]..=lengths[1])
    };
    (0..count).map(stretch).collect()
}

/// A load that is switched now and then, with a little ripple.
fn current_a(rows: usize, draw: &mut Random) -> Vec<f64> {
    let amperes = draw.random_range(0.3..4.0);
    let chance = 1.0 / (10.0 * draw.random_range(4.0..40.0));
    let mut is_on = draw.random_bool(0.5);
    let mut next = || {
        is_on ^= draw.random_bool(chance);
        let ripple: f64 = StandardNormal.sample(draw);
        // As it is written.
        (1000.0 * (if is_on { amperes } else { 0.05 } + 0.002 * ripple)).round() / 1000.0
    };
    (0..rows).map(|_| next()).collect()
}

/// A motor that is set to another level now and then, each time with an inrush.
pub(super) fn motor_current_a(rows: usize, draw: &mut Random) -> Vec<f64> {
    let amperes = draw.random_range(0.5..4.0);
    let chance = 1.0 / (10.0 * draw.random_range(3.0..25.0));
    let (mut level, mut inrush) = (0.0_f64, 0.0);
    let mut next = || {
        if draw.random_bool(chance) {
            let before = level;
            level = if draw.random_bool(0.3) { 0.0 } else { draw.random_range(0.2..1.0) };
            inrush = 0.6 * (level - before).max(0.0);
        }
        // Gone within some seconds.
        inrush *= 0.92;
        let ripple: f64 = StandardNormal.sample(draw);
        (1000.0 * (amperes * (level + inrush) + 0.05 + 0.002 * ripple)).round() / 1000.0
    };
    (0..rows).map(|_| next()).collect()
}

/// A slow drift of a few kelvin.
fn temperature_deg_c(rows: usize, draw: &mut Random) -> Vec<f64> {
    let start = draw.random_range(4.0..28.0);
    let drift: f64 = draw.random_range(1.5..6.0) * if draw.random_bool(0.5) { 1.0 } else { -1.0 };
    let duration_s = Grid::row_s(rows);
    let settle_s = duration_s * draw.random_range(0.2..1.0);
    let (swing, period_s): (f64, f64) = (draw.random_range(0.0..0.5), duration_s * draw.random_range(0.5..1.5));
    let at = |row: usize| {
        let t = Grid::row_s(row);
        let settled = (1.0 - libm::exp(-t / settle_s)) / (1.0 - libm::exp(-duration_s / settle_s));
        start + drift * settled + swing * libm::sin(std::f64::consts::TAU * t / period_s)
    };
    (0..rows).map(at).collect()
}

fn pick<'a, T>(of: &'a [T], draw: &mut Random) -> &'a T {
    &of[draw.random_range(0..of.len())]
}
