//! What the page of a survey is made from.

use towmag_survey::Survey;

/// What the page is made from.
#[derive(Clone, Debug)]
pub struct SurveyReport<'a> {
    /// What the survey found.
    pub survey: &'a Survey,
    /// For each recording, what makes seconds since 1970 of its times, where that is known:
    /// [`utc_offset_s`](crate::recording::utc_offset_s).
    pub utc_offset_s: &'a [Option<f64>],
    /// What the reader must know before trusting the figures.
    pub warnings: &'a [String],
    /// Label and value, shown last.
    pub facts: &'a [(String, String)],
}

impl SurveyReport<'_> {
    /// Of the recording with this index.
    pub(super) fn offset_s(&self, tow: usize) -> Option<f64> {
        self.utc_offset_s.get(tow).copied().flatten()
    }
}
