//! The trial of `host-sim survey`: what it makes of tows, flights and a peer's test whose truth is known here alone.
//!
//! It sees what a user sees: the recordings that go in and the files that come out. How truth, noise and scores are
//! defined stands with each part under `survey_trial/`, and was fixed before the survey was tuned on any of it. Seeds 1 to
//! 99 are for tuning, 701 and up judge. Every part is run by hand:
//!
//! ```sh
//! cargo test -p host-sim --test survey_trial -- --ignored --nocapture contacts
//! ```
//!
//! - `SURVEY_TRIAL_SEEDS=1..41`: which seeds; 701..721 for levels and 701..1101 for contacts without it.
//! - `HOST_SIM=path`: the program that is judged, in place of the one that was built with the test.
//! - `SURVEY_TRIAL_KEEP=folder`: keep recordings, truths and results there.
//! - `TOWMAG_DATA`: where the flights and the peer's test are.
#![cfg(not(target_os = "none"))]

#[path = "survey_trial/attainable.rs"]
mod attainable;
#[path = "survey_trial/contacts.rs"]
mod contacts;
#[path = "survey_trial/csv_file.rs"]
mod csv_file;
#[path = "survey_trial/draw.rs"]
mod draw;
#[path = "survey_trial/effects.rs"]
mod effects;
#[path = "survey_trial/flights.rs"]
mod flights;
#[path = "survey_trial/level.rs"]
mod level;
#[path = "survey_trial/peer.rs"]
mod peer;
#[path = "survey_trial/program.rs"]
mod program;
#[path = "survey_trial/score.rs"]
mod score;
#[path = "survey_trial/speed.rs"]
mod speed;
#[path = "survey_trial/statistics.rs"]
mod statistics;
#[path = "survey_trial/table.rs"]
mod table;
#[path = "survey_trial/truth.rs"]
mod truth;
#[path = "survey_trial/zero_phase.rs"]
mod zero_phase;
