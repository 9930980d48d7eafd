//! The 18-term Tolles-Lawson model: its terms, their basis, its coefficients.
//!
//! Equation numbers are those of Yan, Zhao, Liu, Wu, "An adaptive elastic network magnetic interference compensation
//! method based on saddle point optimization", doi:10.19306/j.cnki.2095-8110.2025.02.005.

pub(crate) mod basis;
mod coefficients;
mod row;
mod terms;
mod vector;

pub use coefficients::Coefficients;
pub use row::Row;
pub use terms::{NT_PER_UNIT, TERM_NAMES, TERM_UNITS, Terms, TermsState, UNIT_FIELD_NT};
pub use vector::{TERMS, TermVector};
pub(crate) use vector::{ZEROS, dot, dot_arrays};
