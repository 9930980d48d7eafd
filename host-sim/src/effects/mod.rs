//! The unmodelled effects, one a file. `c` is the direction of the field in body axes, `s` the scalar reading without
//! effect and noise, `f` the fluxgate's, `t` the time since the first row.

mod effect;
mod file;
mod library;
mod parts;
mod search;
mod spec;

mod averaging_window;
mod clock_drift;
mod dead_zone;
mod depth_gradient;
mod eddy_lag;
mod fluxgate_bias;
mod fluxgate_nonlinearity;
mod fluxgate_nonorthogonality;
mod fluxgate_quantisation;
mod fluxgate_scale;
mod fluxgate_temperature_drift;
mod heading_error;
mod load_current;
mod mains_alias;
mod permanent_step;
mod permanent_temperature;
mod regressor;
mod sample_jitter;
mod sample_slip;
mod scalar_lag;
mod scalar_lowpass;
mod second_order;
mod stale_sample;
mod swell_induction;

#[cfg(test)]
mod tests;

pub use effect::{Change, Draw, Effect, Readings, Recorded, RecordedForm, change_of_clean, no_draw};
pub use file::FileEffect;
pub(crate) use file::{held, played};
pub use library::{FIRMWARE_MISMATCH, Library, Request, RequestError};
pub use search::Search;
pub use spec::{Channel, CoefficientDependence, Column, Domain, Driver, HeldOut, Kind, Parameter, Spec, Step};

pub use averaging_window::AveragingWindow;
pub use clock_drift::ClockDrift;
pub use dead_zone::DeadZone;
pub use depth_gradient::DepthGradient;
pub use eddy_lag::EddyLag;
pub use fluxgate_bias::FluxgateBias;
pub use fluxgate_nonlinearity::FluxgateNonlinearity;
pub use fluxgate_nonorthogonality::FluxgateNonorthogonality;
pub use fluxgate_quantisation::FluxgateQuantisation;
pub use fluxgate_scale::FluxgateScale;
pub use fluxgate_temperature_drift::FluxgateTemperatureDrift;
pub use heading_error::HeadingError;
pub use load_current::LoadCurrent;
pub use mains_alias::MainsAlias;
pub use permanent_step::PermanentStep;
pub use permanent_temperature::PermanentTemperature;
pub use regressor::Regressor;
pub use sample_jitter::SampleJitter;
pub use sample_slip::SampleSlip;
pub use scalar_lag::ScalarLag;
pub use scalar_lowpass::ScalarLowpass;
pub use second_order::SecondOrder;
pub use stale_sample::StaleSample;
pub use swell_induction::SwellInduction;
pub(crate) use swell_induction::quadrature as quarter_period_behind;
