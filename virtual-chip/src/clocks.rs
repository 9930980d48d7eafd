//! What runs how fast.

/// Frequencies of the clock tree, Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clocks {
    /// Core, and the bus of memories and ports.
    pub core_hz: f64,
    /// First peripheral bus.
    pub bus_1_hz: f64,
    /// Second peripheral bus.
    pub bus_2_hz: f64,
    /// Timers on the first peripheral bus.
    pub timers_1_hz: f64,
    /// The low-speed oscillator; 0 when it is off.
    pub low_speed_hz: f64,
}

/// When something happens, and how fast the clocks are then.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Since power came, femtoseconds.
    pub fs: u64,
    /// The clocks.
    pub clocks: Clocks,
}
