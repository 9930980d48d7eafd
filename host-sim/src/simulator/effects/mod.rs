//! The unmodelled effects, one a file. `c` is the direction of the field in body axes, `s` the scalar reading without
//! effect and noise, `f` the fluxgate's, `t` the time since the first row.

mod parts;

mod averaging_window;
mod clock_drift;
mod scalar_lag;
mod scalar_lowpass;

#[cfg(test)]
mod tests;

pub use averaging_window::AveragingWindow;
pub use clock_drift::ClockDrift;
pub use scalar_lag::ScalarLag;
pub use scalar_lowpass::ScalarLowpass;
