//! Effects that users write: a TOML file with a formula.
//!
//! ```text
//! text -> parse -> EffectFile: names, bounds, inputs, formulas that know where each of their variables comes from
//! ```
//!
//! What the variables are at a row is a matter of whoever evaluates it. Nothing here loops or calls itself by what a file
//! says: sizes and depths are bounded, and what is wrong is said with file, line and reason.
//!
//! ```
//! let text = "name = \"pump\"\nchannel = \"scalar\"\nkind = \"additive\"\nformula = \"g * cx\"\n\
//!             [parameters.g]\nlow = -5.0\nhigh = 5.0\ndefault = 1.0\n";
//! let effect = towmag_effect_file::EffectFile::parse(text, "pump.toml").unwrap();
//! assert_eq!(effect.formulas[0].eval(&[2.0, 0.5]), 1.0);
//! assert!(effect.parameters[0].is_linear);
//! ```
//!
//! Nothing here is for the microcontroller: there the library is empty.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

mod check;
mod dependence;
mod effect_file;
mod error;
mod formula;
mod limits;
mod parts;
mod resolve;
mod text;
mod variable;

pub use effect_file::EffectFile;
pub use error::EffectFileError;
pub use formula::{BoundFormula, Source};
pub use limits::{LARGEST_FILE, LONGEST_FORMULA, LONGEST_NAME, MOST_DEPTH, MOST_INPUTS, MOST_NAMES, MOST_PARAMETERS};
pub use parts::{Channel, Filter, FilterTime, Input, Kind, Parameter};
pub use variable::{VARIABLES, Variable};
