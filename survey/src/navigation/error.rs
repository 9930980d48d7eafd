//! Why a recording cannot be navigated as asked.

/// What the user asked for and the recording does not give.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NavigationError {
    /// The position is the ship's, and nothing says how far behind it the body is.
    #[error(
        "{recording}: {lacking} is missing in more than a tenth of the rows, and the layback needs it: give --layback-m"
    )]
    NoLayback {
        /// As the user named it.
        recording: String,
        /// The column.
        lacking: &'static str,
    },
    /// The body cannot be deeper than the cable is long.
    #[error(
        "{recording}: depth_m is above cable_out_m in more than a tenth of the rows: is the cable counted in metres from the sheave?"
    )]
    CableTooShort {
        /// As the user named it.
        recording: String,
    },
    /// The base station does not cover the recording.
    #[error("{recording}: the base station covers {covered_percent:.0} % of its rows, at least 90 % are needed")]
    BaseTooShort {
        /// As the user named it.
        recording: String,
        /// Share of the rows that it covers, percent.
        covered_percent: f64,
    },
    /// The base station tells UTC, and the recording does not.
    #[error("{recording}: has no utc_s, and the base station's times are UTC: import it again with its date")]
    NoUtc {
        /// As the user named it.
        recording: String,
    },
}
