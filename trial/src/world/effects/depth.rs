//! What follows the body up and down.

use super::super::World;
use super::effect::{Act, Channel, Effect, either_sign, parameters};

pub(super) static EFFECTS: [Effect; 2] = [
    Effect {
        name: "depth_gradient",
        channel: Channel::Scalar,
        sizes: &["gradient_nT_per_m"],
        most: 15.0,
        draw: |world, draw| has_depth(world).then(|| parameters([("gradient_nT_per_m", 0.3 * either_sign(draw))])),
        act: Act::Scalar(|world, p, _| {
            let depth_m = world.depth_m().unwrap_or_default();
            let mean_m = depth_m.iter().sum::<f64>() / depth_m.len().max(1) as f64;
            depth_m.iter().map(|z| p["gradient_nT_per_m"] * (z - mean_m)).collect()
        }),
    },
    Effect {
        name: "swell_induction",
        channel: Channel::Scalar,
        sizes: &["gain_nT_per_m"],
        most: 15.0,
        draw: |world, draw| has_depth(world).then(|| parameters([("gain_nT_per_m", 0.3 * either_sign(draw))])),
        act: Act::Scalar(|world, p, _| {
            let behind_m = world.motion.depth.as_ref().map(|depth| world.grid.at_rows(&depth.behind_m));
            behind_m.unwrap_or_default().iter().map(|m| p["gain_nT_per_m"] * m).collect()
        }),
    },
];

fn has_depth(world: &World) -> bool {
    world.columns.has_depth && world.motion.depth.is_some()
}
