//! Three components in body axes.

/// x forward, y starboard, z down.
pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn scaled(a: Vector, by: f64) -> Vector {
    a.map(|component| by * component)
}

/// A unit vector with this azimuth and elevation, the latter positive down.
pub(crate) fn axis(azimuth_deg: f64, elevation_deg: f64) -> Vector {
    let (sin_az, cos_az) = libm::sincos(azimuth_deg.to_radians());
    let (sin_el, cos_el) = libm::sincos(elevation_deg.to_radians());
    [cos_el * cos_az, cos_el * sin_az, sin_el]
}

/// What `north, east, down` is in body axes.
pub(super) fn to_body([north, east, down]: Vector, roll: f64, pitch: f64, heading: f64) -> Vector {
    let turned = |[a, b]: [f64; 2], angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        [cos * a + sin * b, cos * b - sin * a]
    };
    let [ahead, y] = turned([north, east], heading);
    let [z, x] = turned([down, ahead], pitch);
    let [y, z] = turned([y, z], roll);
    [x, y, z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn body_axes_are_forward_starboard_and_down() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let close = |a: Vector, b: Vector| assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
        close(to_body([1.0, 0.0, 0.0], 0.0, 0.0, quarter), [0.0, -1.0, 0.0]); // heading east, north is to port
        close(to_body([0.0, 0.0, 1.0], 0.0, quarter, 0.0), [-1.0, 0.0, 0.0]); // nose up, down is astern
        close(to_body([0.0, 0.0, 1.0], quarter, 0.0, 0.0), [0.0, 1.0, 0.0]); // starboard down
        close(axis(90.0, 0.0), [0.0, 1.0, 0.0]);
        close(axis(10.0, 90.0), [0.0, 0.0, 1.0]);
    }
}
