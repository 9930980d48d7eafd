//! What the recording does not say of its positions.

/// How positions become the body's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NavigationOptions {
    /// Whose positions they are.
    pub position: PositionOf,
    /// The positions are this much late against the magnetics: a row has the position of so many seconds ago.
    pub lag_s: f64,
}

/// Whose positions a recording holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PositionOf {
    /// The body's.
    #[default]
    Body,
    /// The ship's: the body follows in its wake.
    Ship {
        /// From the tow point to the body.
        layback: Layback,
        /// From the antenna back to the tow point, m.
        tow_point_m: f64,
    },
}

/// How far the body is behind the tow point, over ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layback {
    /// Always the same, m.
    Fixed(f64),
    /// From `cable_out_m` and `depth_m`: the base of the right triangle, times this factor (1 for a straight cable; a
    /// cable that sags reaches less far).
    Cable(f64),
}
