//! A ship ahead of the body.

use super::Ship;
use super::path::Path;
use crate::simulator::signals::Grid;

impl Ship {
    /// The body follows in the ship's wake, as far behind as the straight cable reaches at its depth.
    pub(super) fn place_m(&self, path: &Path, point: usize, grid: &Grid) -> [f64; 2] {
        let [.., depth_m] = path.at_point(point);
        let behind_m = (self.cable_out_m * self.cable_out_m - depth_m * depth_m).max(0.0).sqrt();
        let mut at = point;
        let mut way_m = 0.0;
        let step_m = |at: usize| {
            let [a, b] = [path.place_m[at], path.place_m[at + 1]];
            libm::hypot(b[0] - a[0], b[1] - a[1])
        };
        while at + 1 < grid.len && way_m < behind_m {
            way_m += step_m(at);
            at += 1;
        }
        // Beyond the end of the physics the ship goes straight on.
        let (sin, cos) = libm::sincos(path.course.heading_deg(grid.time_s(at)).to_radians());
        [path.place_m[at][0] + (behind_m - way_m) * cos, path.place_m[at][1] + (behind_m - way_m) * sin]
    }
}
