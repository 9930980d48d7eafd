//! Virtual time: femtoseconds since power came, so that a cycle of 168 MHz is exact to 0.1 ppm. It ends after five hours.

/// Femtoseconds in a second.
pub const FS_PER_S: u64 = 1_000_000_000_000_000;

/// Later than any run.
pub const NEVER_FS: u64 = u64::MAX;

/// Seconds as femtoseconds.
pub fn fs(seconds: f64) -> u64 {
    (seconds * FS_PER_S as f64) as u64
}

/// A period of `hz`, femtoseconds.
pub fn period_fs(hz: f64) -> u64 {
    (FS_PER_S as f64 / hz) as u64
}

/// Femtoseconds as seconds.
pub fn seconds(fs: u64) -> f64 {
    fs as f64 / FS_PER_S as f64
}

/// Femtoseconds as whole nanoseconds.
pub fn ns(fs: u64) -> u64 {
    fs / 1_000_000
}
