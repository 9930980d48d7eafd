//! What `host-sim` does for those who use it, as one program: each of its own would be linked with the whole library again.

#![cfg(not(target_os = "none"))]

mod adaptive_flight;
#[cfg(unix)]
mod campaign;
mod cards;
mod commands;
mod common;
mod damaged_input;
mod device;
mod device_log;
mod diagnose;
mod diagnosis;
mod diagnosis_browser;
mod diagnosis_text;
mod effect_files;
#[cfg(unix)]
mod emulate;
mod exact_replay;
mod export;
mod flight_recordings;
mod import;
mod input_format;
mod level;
mod listen;
#[cfg(unix)]
mod listen_page;
mod new_effect;
mod notebook;
mod output;
mod own_scalar;
mod paper_table;
mod proposed_effect;
mod recording;
mod recording_damage;
mod report;
mod report_browser;
mod schemas;
mod session_times;
mod simulate;
#[cfg(unix)]
mod streams;
mod survey;
mod survey_browser;
mod survey_trial;
mod tolerant;
mod trial;
mod trial_browser;
