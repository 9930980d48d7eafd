//! The desk's best of a tow: the total field at its level, with the targets kept; the contacts in it; where they are.
//!
//! Data flow: [`Tow`] (the columns of a recording) -> [`navigation`] (the body's track) -> [`level`] (a fixed-interval
//! smoother, f64) and [`contacts`] (dipoles along the track), which take turns until both agree. No file is read or
//! written here, and nothing here knows the simulator or the diagnosis.
//!
//! Nothing here is for the microcontroller: there the library is empty.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

pub mod contacts;
pub mod level;
pub mod map;
pub mod navigation;
mod options;
mod result;
mod run;
mod second;
mod statistics;
mod tow;

pub use level::Calibration;
pub use options::SurveyOptions;
pub use result::{Base, Contact, Estimate, Place, Survey, SurveyedTow};
pub use run::survey;
pub use second::SecondScalar;
pub use tow::Tow;
