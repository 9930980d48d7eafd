//! The body without its hardware: a board in memory on which the tasks of the firmware run, and a card that can lose power,
//! tear, reorder and fail.
//!
//! | module | |
//! |---|---|
//! | `board`, `body` | the board in memory, and the firmware's tasks on it, called in turn |
//! | `disk`, `fat` | a card as blocks, and a file system on it |
//! | `sd` | the card in SPI mode on its bus, byte by byte in virtual time |
//! | `voyage` | the task of the storage on that card, with the producer of records and the watchdog |
//! | `deck` | the task of the storage on a card that is watched at every write |
//! | `log` | what the tests log, and how they read it back |
//! | `sentence` | sentences of NMEA 0183 |
//! | `turned_sensor` | a fluxgate that is off, turned in the field |
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![expect(missing_docs, reason = "for the tests of this package alone")]

pub mod bare_chip;
pub mod board;
pub mod body;
pub mod deck;
pub mod disk;
pub mod fat;
pub mod log;
pub mod rng;
pub mod sd;
pub mod sentence;
pub mod turned_sensor;
pub mod voyage;
