//! The page a person looks at: one HTML file that opens offline and asks nothing of any network.
//!
//! A command feeds the collectors row by row, puts what they give into [`ReportData`] and writes what [`render`] returns.

mod chart;
mod collect;
mod data;
mod diagnosis;
mod frame;
mod number;
mod page;
mod series;
mod trial;

pub use collect::{
    EnvelopeCollector, HeadingSectors, MethodCollector, MethodRow, RecordingCollector, Row, RunningStd, Welch,
};
pub use data::{
    Bin, Coefficient, Envelope, HeadingStd, Kind, MethodResult, ReportData, SECTORS, SectorStd, Spectrum,
    Uncompensated, best, headline,
};
pub use diagnosis::{DiagnosisReport, render_diagnosis};
pub use number::{group, three_digits};
pub use page::render;
pub use trial::render_trial;
