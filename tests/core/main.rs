//! The core alone, against published vectors and the equations, as one program. `golden.rs` is one of its own: it is built in release too.

mod band_pass;
mod boards;
mod fuzz_corpora;
mod link_console;
mod link_frame;
mod numerics;
#[path = "../sample/mod.rs"]
mod sample;
mod sensors_adc;
mod sensors_chain;
mod sensors_fluxgate;
mod sensors_grid;
mod sensors_nmea;
mod sensors_scalar;
mod settings_store;
