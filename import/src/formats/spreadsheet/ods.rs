//! Workbooks of OpenDocument (OASIS, version 1.3, part 3: 9 and 19.671).
//!
//! Not through `calamine`: there a cell that says it is repeated is made as often as it says, before it is counted, and a
//! document that ends too early is waited for without end.

use quick_xml::events::{BytesRef, BytesStart, Event};

use super::super::memory::Budget;
use super::archive;
use super::sheet::{Cell, Fault, Sheet};
use super::times;

/// Its type stands first in the archive, not compressed, for programs that look at the first bytes.
const TYPE: &[u8] = b"mimetypeapplication/vnd.oasis.opendocument.spreadsheet";

/// An archive whose first entry says so.
pub(super) fn recognises(first: &[u8]) -> bool {
    let start = &first[..first.len().min(256)];
    start.starts_with(b"PK\x03\x04") && start.windows(TYPE.len()).any(|bytes| bytes == TYPE)
}

/// All of its sheets.
pub(super) fn sheets(bytes: &[u8], budget: &mut Budget) -> Result<Vec<Sheet>, Fault> {
    let content = archive::entry(bytes, "content.xml", budget)?;
    let content = String::from_utf8(content).map_err(Fault::damaged)?;
    let mut reader = quick_xml::Reader::from_str(&content);
    let mut work = Work { sheets: Vec::new(), row: 0, repeats: 1, column: 0, cell: None };
    loop {
        match reader.read_event().map_err(Fault::damaged)? {
            Event::Start(tag) => work.open(&tag)?,
            Event::Empty(tag) => {
                work.open(&tag)?;
                work.close(tag.name().as_ref(), budget)?;
            }
            Event::Text(text) => work.text(&text),
            Event::CData(text) => work.text(&text),
            // `&amp;` and its like come apart from the text around them.
            Event::GeneralRef(name) => work.text(&resolved(&name)?),
            Event::End(tag) => work.close(tag.name().as_ref(), budget)?,
            Event::Eof => break,
            _ => {}
        }
    }
    if content.trim_end().ends_with("</office:document-content>") {
        Ok(work.sheets)
    } else {
        Err(Fault::damaged("it ends too early"))
    }
}

/// Where in the document we are.
struct Work {
    sheets: Vec<Sheet>,
    row: u32,
    /// How often the row stands there.
    repeats: u32,
    column: u32,
    cell: Option<Open>,
}

/// A cell whose end has not come yet.
struct Open {
    /// What its attributes say; none where its text counts.
    value: Option<Cell>,
    text: String,
    repeats: u32,
}

impl Work {
    fn open(&mut self, tag: &BytesStart<'_>) -> Result<(), Fault> {
        match tag.name().as_ref() {
            "table:table" => {
                self.sheets.push(Sheet::new(attribute(tag, "table:name")?.unwrap_or_default()));
                self.row = 0;
            }
            "table:table-row" => {
                self.repeats = repeats(tag, "table:number-rows-repeated")?;
                self.column = 0;
            }
            "table:table-cell" | "table:covered-table-cell" => {
                let repeats = repeats(tag, "table:number-columns-repeated")?;
                self.cell = Some(Open { value: value(tag)?, text: String::new(), repeats });
            }
            "text:s" | "text:tab" => self.text(" "),
            _ => {}
        }
        Ok(())
    }

    fn text(&mut self, text: &str) {
        if let Some(cell) = &mut self.cell {
            cell.text.push_str(text);
        }
    }

    fn close(&mut self, name: &str, budget: &mut Budget) -> Result<(), Fault> {
        match name {
            "table:table-cell" | "table:covered-table-cell" => self.put(budget)?,
            "table:table-row" => self.row = self.row.saturating_add(self.repeats),
            _ => {}
        }
        Ok(())
    }

    /// Puts the cell that ends where it stands, as often as it and its row are repeated.
    fn put(&mut self, budget: &mut Budget) -> Result<(), Fault> {
        let (Some(cell), Some(sheet)) = (self.cell.take(), self.sheets.last_mut()) else { return Ok(()) };
        let value = cell.value.unwrap_or_else(|| Cell::text(&cell.text));
        let next = self.column.saturating_add(cell.repeats);
        if value != Cell::Empty {
            budget.take((cell.repeats as usize).saturating_mul(self.repeats as usize), size_of::<Cell>())?;
            for row in self.row..self.row.saturating_add(self.repeats) {
                for column in self.column..next {
                    sheet.put(row, column, value.clone(), budget)?;
                }
            }
        }
        self.column = next;
        Ok(())
    }
}

/// What the attributes of a cell say; none where its text is its value.
fn value(tag: &BytesStart<'_>) -> Result<Option<Cell>, Fault> {
    let number = |text: String| text.trim().parse().map(Cell::Number).map_err(Fault::damaged);
    Ok(match attribute(tag, "office:value-type")?.as_deref() {
        Some("float" | "percentage" | "currency") => attribute(tag, "office:value")?.map(number).transpose()?,
        Some("date") => attribute(tag, "office:date-value")?.and_then(|text| times::from_iso_date(&text)),
        Some("time") => attribute(tag, "office:time-value")?.and_then(|text| times::from_iso_duration(&text)),
        Some("boolean") => attribute(tag, "office:boolean-value")?.map(|text| Cell::Number(f64::from(text == "true"))),
        Some(_) => None,
        None => Some(Cell::Empty),
    })
}

fn attribute(tag: &BytesStart<'_>, name: &str) -> Result<Option<String>, Fault> {
    let Some(found) = tag.try_get_attribute(name).map_err(Fault::damaged)? else { return Ok(None) };
    quick_xml::escape::unescape(&found.value).map(|text| Some(text.into_owned())).map_err(Fault::damaged)
}

fn resolved(reference: &BytesRef<'_>) -> Result<String, Fault> {
    if let Some(letter) = reference.resolve_char_ref().map_err(Fault::damaged)? {
        return Ok(letter.into());
    }
    let known = quick_xml::escape::resolve_predefined_entity(reference);
    known.map(str::to_owned).ok_or_else(|| Fault::damaged("an entity that is not known"))
}

fn repeats(tag: &BytesStart<'_>, name: &str) -> Result<u32, Fault> {
    attribute(tag, name)?.map_or(Ok(1), |text| text.trim().parse().map_err(Fault::damaged))
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    fn read(content: &str) -> Result<Vec<Sheet>, Fault> {
        let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        archive.start_file("content.xml", zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(content.as_bytes()).unwrap();
        let bytes = archive.finish().unwrap().into_inner();
        sheets(&bytes, &mut Budget::of(bytes.len()))
    }

    fn document(rows: &str) -> String {
        format!("<office:document-content><table:table table:name=\"a\">{rows}</table:table></office:document-content>")
    }

    #[test]
    fn repeated_cells_and_rows_stand_in_their_places() {
        let number =
            r#"<table:table-cell office:value-type="float" office:value="1.5" table:number-columns-repeated="2"/>"#;
        let text = r#"<table:table-cell office:value-type="string"><text:p>a &amp; b</text:p></table:table-cell>"#;
        let rows = format!(
            r#"<table:table-row table:number-rows-repeated="3"><table:table-cell/></table:table-row>
               <table:table-row table:number-rows-repeated="2"><table:table-cell/>{number}{text}</table:table-row>"#
        );
        let sheet = read(&document(&rows)).unwrap().remove(0);
        let row = vec![Cell::Empty, Cell::Number(1.5), Cell::Number(1.5), Cell::text("a & b")];
        assert_eq!(sheet.rows.into_iter().collect::<Vec<_>>(), [(3, row.clone()), (4, row)]);
    }

    #[test]
    fn a_document_without_end_and_one_of_a_billion_cells_are_refused() {
        let whole = document("");
        assert!(read(&whole).is_ok());
        assert!(read(&whole[..whole.len() - 30]).is_err());
        let cell =
            r#"<table:table-cell office:value-type="float" office:value="1" table:number-columns-repeated="16000"/>"#;
        let rows = format!(r#"<table:table-row table:number-rows-repeated="1000000">{cell}</table:table-row>"#);
        assert!(matches!(read(&document(&rows)), Err(Fault::TooLarge(_))));
    }
}
