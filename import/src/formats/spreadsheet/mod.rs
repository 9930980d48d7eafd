//! Spreadsheets.
use super::reader::{Input, SourceFormat};
use crate::error::ImportError;
use crate::source::Source;
/// Reader of workbooks.
pub(super) struct Spreadsheet;
impl SourceFormat for Spreadsheet {
    fn name(&self) -> &'static str {
        "spreadsheet"
    }
    fn recognises(&self, _first: &[u8]) -> bool {
        false
    }
    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        Err(ImportError::file(input.file, ""))
    }
}
