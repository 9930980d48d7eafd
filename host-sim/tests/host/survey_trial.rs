//! The trial of `host-sim survey`: what it makes of tows, flights and a peer's test whose truth is known here alone.
//!
//! It sees what a user sees: the recordings that go in and the files that come out. How truth, noise and scores are
//! defined stands with each part under `survey_trial/`, and was fixed before the survey was tuned on any of it. Seeds 1 to
//! 99 are for tuning, 701 and up judge. Every part is run by hand:
//!
//! ```sh
//! cargo test -p host-sim --test host -- --ignored --nocapture contacts::contacts
//! ```
//!
//! - `SURVEY_TRIAL_SEEDS=1..41`: which seeds; 701..721 for levels, 701..791 for grids and 701..1101 for contacts without it.
//! - `HOST_SIM=path`: the program that is judged, in place of the one that was built with the test.
//! - `SURVEY_TRIAL_KEEP=folder`: keep recordings, truths and results there.
//! - `TOWMAG_DATA`: where the flights and the peer's test are.

mod attainable;
mod beside;
mod contacts;
mod csv_file;
mod draw;
mod effects;
mod flights;
mod grids;
mod groups;
mod level;
mod peer;
mod program;
mod receivers;
mod score;
mod spectrum;
mod speed;
mod statistics;
mod table;
mod truth;
mod zero_phase;
