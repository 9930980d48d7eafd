//! The core on simulated recordings, against f64 straight from the equations and against `nalgebra`. Here and not with the
//! core, so that the core's own tests are built without the simulator.

mod adaptive;
mod estimators;
mod f64_reference;
mod gaps;
mod reference;
