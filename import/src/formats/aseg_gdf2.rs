//! ASEG-GDF2: records of fixed width, with their definitions in a file beside them.

use super::aseg_definition::{Field, Kind, RecordType, is_definition, record_types};
use super::format::{Input, SourceFormat};
use crate::error::ImportError;
use crate::source::{Source, SourceTable};
use crate::text::{Column, LARGEST_COLUMNS, Line, Missing, Rows, decoded, lines};

/// ASEG-GDF2.
#[derive(Debug)]
pub(super) struct AsegGdf2;

/// A field in its place.
struct Place {
    column: Option<(String, Field)>,
    start: usize,
    width: usize,
}

/// What records of one sort look like, and how those of the others start.
struct Layout {
    mark: String,
    others: Vec<String>,
    places: Vec<Place>,
    width: usize,
}

impl SourceFormat for AsegGdf2 {
    fn name(&self) -> &'static str {
        "ASEG-GDF2"
    }

    /// By the definitions: the records themselves are numbers between blanks like others.
    fn recognises(&self, first: &[u8]) -> bool {
        is_definition(&decoded(first))
    }

    fn takes_companions(&self) -> bool {
        true
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let ((definition_file, definition), (data_file, data)) = definition_and_data(input)?;
        let layout = layout(&decoded(definition)).map_err(|what| ImportError::file(definition_file, what))?;
        let text = decoded(data);
        let longest = lines(&text).map(|line| line.text.len()).max().unwrap_or(0);
        let last = layout.places.last().map_or(0, |place| place.start);
        if longest <= last {
            let wanted = layout.width;
            let what = format!(
                "its longest record has {longest} characters, {definition_file} defines {wanted}: do they belong together?"
            );
            return Err(ImportError::file(data_file, what));
        }
        let table = table(&layout, &text);
        Ok(Source { file: data_file.into(), format: self.name(), tables: vec![table] })
    }
}

type File<'a> = (&'a str, &'a [u8]);

/// The two files, in whichever order they were given.
fn definition_and_data<'a>(input: &Input<'a>) -> Result<(File<'a>, File<'a>), ImportError> {
    let companions = input.companions.iter().map(|(name, bytes)| (&name[..], &bytes[..]));
    let files: Vec<File<'a>> = std::iter::once((input.file, input.bytes)).chain(companions).collect();
    let is_definition =
        |file: &&File<'a>| AsegGdf2.recognises(file.1.get(..file.1.len().min(65_536)).unwrap_or_default());
    let both = "give the definitions (.dfn) and the data (.dat) on one command line";
    let lacks = |what: &str| ImportError::file(input.file, format!("an ASEG-GDF2 data set without its {what}: {both}"));
    let definition = files.iter().find(is_definition).ok_or_else(|| lacks("definitions"))?;
    let data = files.iter().find(|file| !is_definition(file)).ok_or_else(|| lacks("data"))?;
    Ok((*definition, *data))
}

/// The sort of records that holds the data: the one with most fields that is neither comment nor projection.
fn layout(definition: &str) -> Result<Layout, String> {
    let types = record_types(definition);
    let is_data = |kind: &&RecordType| !["COMM", "PROJ"].contains(&&kind.mark[..]);
    let data = types.iter().filter(is_data).max_by_key(|kind| kind.fields.len());
    let data = data.filter(|kind| !kind.fields.is_empty()).ok_or("defines no fields of data")?;
    let too_wide = || format!("defines records of more than {LARGEST_COLUMNS} columns");
    let width = data.width().ok_or_else(too_wide)?;
    let others = ["COMM", "PROJ"].into_iter().chain(types.iter().map(|kind| &kind.mark[..]));
    let others = others.filter(|mark| !mark.is_empty() && *mark != data.mark).map(str::to_string).collect();
    Ok(Layout { mark: data.mark.clone(), others, places: places(&data.fields).ok_or_else(too_wide)?, width })
}

/// Each field in its place; none where they are too many.
fn places(fields: &[Field]) -> Option<Vec<Place>> {
    let mut places = Vec::new();
    let mut start = 0_usize;
    for field in fields.iter().filter(|field| field.width > 0) {
        for index in 1..=field.repeat {
            if places.len() >= LARGEST_COLUMNS {
                return None;
            }
            let name = if field.repeat > 1 { format!("{}_{index}", field.name) } else { field.name.clone() };
            let is_carried = field.kind != Kind::Blank && field.name != "RT";
            let column = is_carried.then(|| (name, Field { repeat: 1, ..field.clone() }));
            places.push(Place { column, start, width: field.width });
            start = start.checked_add(field.width)?;
        }
    }
    Some(places)
}

fn table(layout: &Layout, text: &str) -> SourceTable {
    let carried: Vec<&Place> = layout.places.iter().filter(|place| place.column.is_some()).collect();
    let mut rows = Rows::new(carried.iter().filter_map(|place| place.column.as_ref()).map(column).collect());
    let last = layout.places.last().map_or(0, |place| place.start);
    for line in lines(text).filter(|line| !line.text.trim().is_empty() && layout.is_data(line.text)) {
        if is_whole(line, last, layout.width) {
            let cells = carried.iter().map(|place| {
                let end = (place.start + place.width).min(line.text.len());
                // Characters beyond ASCII are more than one byte: a field that starts within one is none.
                line.text.get(place.start..end).unwrap_or("?")
            });
            rows.push(line.number, cells);
        } else {
            rows.leave_out(line);
        }
    }
    rows.finish(&format!("the {} characters of the definitions", layout.width))
}

impl Layout {
    fn is_data(&self, line: &str) -> bool {
        line.starts_with(&self.mark) && !self.others.iter().any(|mark| line.starts_with(mark.as_str()))
    }
}

/// Blanks at the end may be left away, but the last field must be there; the last line of a file must have it whole.
fn is_whole(line: Line<'_>, last: usize, width: usize) -> bool {
    line.text.len() > last && (line.is_ended || line.text.len() >= width)
}

fn column((name, field): &(String, Field)) -> Column {
    let missing = field.null.map_or(Missing::Nothing, Missing::Value);
    Column::new(name.clone(), field.unit.as_deref(), missing, field.kind == Kind::Text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{FindingKind, Values};

    const DEFINITION: &str = "\
DEFN   ST=RECD,RT=COMM;RT:A4;COMMENTS:A76
DEFN 1 ST=RECD,RT=DATA;RT:A4;LINE:I5;MAG:F10.2:UNIT=nT:NULL=-9999.99
DEFN 2 ST=RECD,RT=DATA;EM:2f7.1:UNIT=fT:NULL=-999.9;2X;CODE:A4
DEFN 3 ST=RECD,RT=DATA;END DEFN
";
    const DATA: &str = "\
COMM flown low
DATA  101  49895.13    1.5    2.5  good
DATA  101  -9999.99 -999.9    2.5  bad
DATA  102  4989x.13    1.54.0D+01  x
DATA  103  49895.13
DATA  104  49895.13    1.5    2.5  go";

    fn read(file: &str, bytes: &str, companion: Option<(&str, &str)>) -> Result<Source, ImportError> {
        let companions: Vec<_> = companion.map(|(name, text)| (name.to_string(), text.into())).into_iter().collect();
        AsegGdf2.read(&Input { file, bytes: bytes.as_bytes(), companions: &companions, part: None })
    }

    #[test]
    fn fields_stand_where_the_definitions_say() {
        let source = read("a.dfn", DEFINITION, Some(("a.dat", DATA))).unwrap();
        let turned = read("a.dat", DATA, Some(("a.dfn", DEFINITION))).unwrap();
        // As text: a value that is missing is not even equal to itself.
        assert_eq!(format!("{source:?}"), format!("{turned:?}"));
        assert_eq!(source.file, "a.dat");
        let table = &source.tables[0];
        let columns: Vec<_> = table.columns.iter().map(|c| (&c.name[..], c.unit.as_deref().unwrap_or(""))).collect();
        assert_eq!(columns, [("LINE", ""), ("MAG", "nT"), ("EM_1", "fT"), ("EM_2", "fT"), ("CODE", "")]);
        let numbers = |column: usize| format!("{:?}", table.columns[column].as_numbers().unwrap());
        assert_eq!(numbers(0), "[101.0, 101.0, 102.0]");
        assert_eq!(numbers(1), "[49895.13, NaN, NaN]");
        assert_eq!(numbers(2), "[1.5, NaN, 1.5]");
        assert_eq!(numbers(3), "[2.5, 2.5, 40.0]");
        assert_eq!(table.columns[1].dummy, Some(-9999.99));
        assert!(matches!(&table.columns[4].values, Values::Text(texts) if &*texts[0] == "good" && &*texts[1] == "bad"));
        assert_eq!(table.places, [2, 3, 4]);
    }

    #[test]
    fn what_was_put_right_is_told() {
        let table = read("a.dfn", DEFINITION, Some(("a.dat", DATA))).unwrap().tables.remove(0);
        let notes: Vec<_> = table.notes.iter().map(|note| (note.kind, &note.text[..])).collect();
        let wanted = [
            (FindingKind::Dummies, "1 cell is no number and counts as missing: \"4989x.13\" in line 4"),
            (FindingKind::Missing, "1 line without the 39 characters of the definitions is left out: in line 5"),
            (FindingKind::Truncated, "the file ends within line 6, which is left out"),
        ];
        assert_eq!(notes, wanted);
    }

    #[test]
    fn one_file_alone_is_refused() {
        let without_data = read("a.dfn", DEFINITION, None).unwrap_err().to_string();
        let both = "give the definitions (.dfn) and the data (.dat) on one command line";
        assert_eq!(without_data, format!("a.dfn: an ASEG-GDF2 data set without its data: {both}"));
        let without_definitions = read("a.dat", DATA, None).unwrap_err().to_string();
        assert_eq!(without_definitions, format!("a.dat: an ASEG-GDF2 data set without its definitions: {both}"));
    }

    #[test]
    fn definitions_of_other_data_are_refused() {
        let wide = "DEFN 1 ST=RECD,RT=;A:I8;B:1000F12.2";
        let refusal = read("a.dfn", wide, Some(("a.dat", DATA))).unwrap_err().to_string();
        assert!(refusal.contains("do they belong together?"), "{refusal}");
        for definition in ["DEFN 1 ST=RECD,RT=;A:99999999I1", "DEFN 1 ST=RECD,RT=COMM;A:I4"] {
            assert!(read("a.dfn", definition, Some(("a.dat", DATA))).is_err());
        }
    }
}
