//! What the 18 terms say only to first order: the second order, and eddy currents that take their time.

use rand::RngExt;

use super::super::World;
use super::super::grid::Grid;
use super::super::vector::{dot, length, scaled};
use super::effect::{Act, Channel, Effect, parameters};

pub(super) static EFFECTS: [Effect; 2] = [
    Effect {
        name: "second_order",
        channel: Channel::Scalar,
        sizes: &["scale"],
        most: 3.0,
        draw: |_, draw| Some(parameters([("scale", draw.random_range(0.5..2.0))])),
        act: Act::Scalar(|world, p, _| second_order(world).into_iter().map(|nt| p["scale"] * nt).collect()),
    },
    Effect {
        name: "eddy_lag",
        channel: Channel::Scalar,
        sizes: &["time_constant_s"],
        most: 0.6,
        draw: |_, _| Some(parameters([("time_constant_s", 0.1)])),
        act: Act::Scalar(|world, p, _| {
            let filtered = Grid::low_pass(&world.eddy_nt, p["time_constant_s"], &[]);
            (0..world.rows()).map(Grid::of_row).map(|at| filtered[at] - world.eddy_nt[at]).collect()
        }),
    },
];

/// `|F c + Bd| - F - c . Bd`, nT.
fn second_order(world: &World) -> Vec<f64> {
    let at_row = |row: usize| {
        let at = Grid::of_row(row);
        let (field_nt, c) = (world.field_nt[at], world.direction[at]);
        let (still, eddy) = (world.body.still_nt(field_nt, c), world.body.eddy_nt(field_nt, world.rate[at]));
        let disturbance: [f64; 3] = std::array::from_fn(|k| still[k] + eddy[k]);
        let all = scaled(c, field_nt);
        length(std::array::from_fn(|k| all[k] + disturbance[k])) - field_nt - dot(c, disturbance)
    };
    (0..world.rows()).map(at_row).collect()
}
