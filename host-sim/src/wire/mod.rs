//! What goes over the wires between the sensors and the body, and the body that reads it: the firmware's own drivers, epoch
//! assembly and core, in this process.
//!
//! ```text
//! recording -> Feed -> sentences --------------------> Body: parser ----+
//!                   -> counts -> Adc -> SPI frames -> Body: converter --+-> grid -> Epoch -> Pipeline
//! ```

pub(crate) mod adc;
pub(crate) mod body;
mod faults;
pub(crate) mod feed;
mod sensors;

pub use faults::{Fault, FaultKind};
pub use sensors::{Sensed, Wires, through_sensors};
