//! The live page: what comes up the tow cable, in a browser on the bridge.
//!
//! Data flow: whoever listens to the body gives values to a [`Feed`], which never waits; a thread of its own keeps the
//! [`history`] and the alarms, and sends what is new to every viewer. What viewers ask for comes back as [`Order`]s.
//!
//! | module | |
//! |---|---|
//! | `sample`, `lamp`, `notice` | what is given |
//! | [`history`] | the last twelve hours, in memory that does not grow |
//! | `alarm` | what makes a noise until a person has seen it |
//! | `state`, `hub` | all that a viewer may ask for; who is told what is new |
//! | `message`, `wish` | what goes to a page and comes from it |
//! | `guard`, `places` | who may look, who may do more, and how many at a time |
//! | `server`, `connection`, `routes`, `viewer`, `page`, `udp` | sockets |
//!
//! Nothing here is for the microcontroller: there the library is empty.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

mod alarm;
mod connection;
mod error;
mod feed;
mod guard;
pub mod history;
mod hub;
mod lamp;
mod message;
mod notice;
mod options;
mod page;
mod places;
mod routes;
mod sample;
mod server;
mod state;
mod udp;
mod viewer;
mod wish;

pub use alarm::AlarmKind;
pub use error::LiveError;
pub use feed::{Feed, Update};
pub use lamp::{Lamp, Lamps, Level};
pub use notice::{Contact, Mark, Order};
pub use options::{DEFAULT_ADDRESS, LiveOptions};
pub use places::Limits;
pub use sample::Sample;
pub use server::Server;
