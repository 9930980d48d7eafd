//! The page a person looks at: one HTML file that opens offline and asks nothing of any network.
//!
//! A command puts what a pass gave into [`ReportData`] and writes what [`render`] returns.

mod chart;
mod data;
mod diagnosis;
mod frame;
mod merit;
mod page;
mod series;
mod survey;
mod svg;
mod trial;

pub use data::{Kind, Mark, ReportData, headline};
pub use diagnosis::{DiagnosisReport, render_diagnosis};
pub use page::render;
pub use survey::{SurveyReport, render_survey};
pub use trial::render_trial;
