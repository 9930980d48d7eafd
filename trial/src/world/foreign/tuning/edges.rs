//! What remembers the attitude with edges: parts that fall over, stick and jump, and iron whose domains flip.

use rand::RngExt;

use super::super::super::vector::scaled;
use super::super::super::{Change, World};
use super::super::shape::{along_fine, any_axis, any_moment, cosine, standard, with_play};
use crate::random::Random;

/// A flap that lies against one stop until the body has rolled far enough the other way, and then against that one.
pub(super) fn falling_flap(world: &World, draw: &mut Random) -> Change {
    let roll = standard(&world.motion.roll);
    let (to, back) = (draw.random_range(0.2..1.4), draw.random_range(-1.4..-0.2));
    let course = flipped(&roll, to, back);
    Change::of_scalar(along_fine(world, any_moment(draw), &course))
}

/// A part that sticks as it is until the pitch is too far from where it was left, and then jumps all the way.
pub(super) fn sticking_joint(world: &World, draw: &mut Random) -> Change {
    let pitch = standard(&world.motion.pitch);
    let sticks = draw.random_range(0.5..1.6);
    let mut at = pitch.first().copied().unwrap_or(0.0);
    let mut next = |&x: &f64| {
        if (x - at).abs() > sticks {
            at = x;
        }
        at
    };
    let course: Vec<f64> = pitch.iter().map(&mut next).collect();
    Change::of_scalar(along_fine(world, any_moment(draw), &course))
}

/// Iron of a few large domains along an axis: each flips at a field of its own, and back at a lower one.
pub(super) fn flipping_domains(world: &World, draw: &mut Random) -> Change {
    let axis = any_axis(draw);
    let field = standard(&cosine(world, axis));
    let mut moment = vec![0.0; field.len()];
    for _ in 0..draw.random_range(1..=4) {
        let (middle, half) = (draw.random_range(-1.2..1.2), draw.random_range(0.15..1.0));
        let weight = draw.random_range(0.4..1.0);
        moment
            .iter_mut()
            .zip(flipped(&field, middle + half, middle - half))
            .for_each(|(sum, side)| *sum += weight * side);
    }
    Change::of_scalar(along_fine(world, scaled(axis, 1.0), &moment))
}

/// A swivel that the cable turns to whichever side the body yawed last, once it has yawed by some degrees.
pub(super) fn turned_swivel(world: &World, draw: &mut Random) -> Change {
    let slack = draw.random_range(0.02..0.12);
    let taken_up = with_play(&world.motion.heading, slack);
    let mut side = 1.0;
    let mut course = vec![side];
    for two in taken_up.windows(2) {
        if two[1] != two[0] {
            side = (two[1] - two[0]).signum();
        }
        course.push(side);
    }
    Change::of_scalar(along_fine(world, any_moment(draw), &course))
}

/// 1 from where `drive` is above `to` until it is below `back`, else -1.
fn flipped(drive: &[f64], to: f64, back: f64) -> Vec<f64> {
    let mut side = -1.0;
    let mut next = |&x: &f64| {
        if x > to {
            side = 1.0;
        } else if x < back {
            side = -1.0;
        }
        side
    };
    drive.iter().map(&mut next).collect()
}
