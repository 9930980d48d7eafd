//! A blind trial of a diagnosis: recordings with hidden effects, answers sealed before it begins, opened after it.
//!
//! ```text
//! draw -> answers.json, its SHA-256 told -> recordings as CSV -> whoever diagnoses -> diagnosis.json
//!                                                                open, check the hash, score <-
//! ```
//!
//! This crate sees what any script outside would see: it gives recordings as CSV text and takes back the text of
//! `diagnosis.json`. It has a world of its own, written from the definitions of the effects, and depends neither on the
//! simulator nor on the diagnosis, so that no mistake of theirs can hide in it.
//!
//! ```
//! use towmag_trial::{BlindTrial, Request, TrialError, TrialOptions};
//!
//! // A diagnosis that never finds anything.
//! let says_nothing = |request: &Request<'_>| -> Result<String, TrialError> {
//!     assert!(request.recording.starts_with("time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT"));
//!     Ok(r#"{"verdict": "no_gap", "effects": [], "candidates": [{"name": "none", "probability": 0.9}]}"#.into())
//! };
//! let options = TrialOptions { recordings: 3, minutes: Some(2.0), ..TrialOptions::default() };
//! let blind = BlindTrial::draw(options, None, || {})?;
//! println!("sealed: {}", blind.sha256());
//! let trial = blind.run(says_nothing, || {})?;
//! assert_eq!(trial.score.unwrap().false_alarms.hits, 0);
//! # Ok::<(), TrialError>(())
//! ```
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

mod answer;
mod blind_trial;
mod error;
mod limits;
mod merge;
mod options;
mod outcome;
mod own_effect;
mod part;
mod random;
mod real;
mod recorder;
mod reply;
mod request;
mod said;
mod score;
mod seal;
mod setting;
mod shard;
mod sizing;
mod strength;
mod synthetic;
mod world;

pub use answer::{Answer, Hidden, Kind, Target};
pub use blind_trial::BlindTrial;
pub use error::TrialError;
pub use merge::{Merged, merge};
pub use options::TrialOptions;
pub use outcome::Trial;
pub use own_effect::OwnEffect;
pub use part::Part;
pub use real::RealRecording;
pub use recorder::RecorderKind;
pub use reply::{Reply, TrialResult};
pub use request::Request;
pub use said::{Candidate, GapClosed, Said, SaidDriver, SaidEffect, SaidParameter, SaidRest, SaidTarget, Verdict};
pub use score::{
    Bin, Calibration, DriverScore, Figure, OnBin, OnScore, Promise, Rate, Score, Several, Shrink, State, TargetScore,
    WithheldScore, figures, on_figures,
};
pub use seal::seal;
pub use setting::Setting;
pub use shard::Shard;
