//! The definitions of an ASEG-GDF2 data set: names, Fortran formats, units and dummies of the fields of a record.
//! D. Pratt, "ASEG-GDF2: A standard for point located data exchange", Australian Society of Exploration Geophysicists,
//! revision 4, 2003 <https://www.aseg.org.au/sites/default/files/pdf/ASEG-GDF2-REV4.pdf>

use crate::text::{lines, number};

/// What the characters of a field mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `I`, `F`, `E`, `D`, `G`.
    Number,
    /// `A`.
    Text,
    /// `X`: nothing stands there.
    Blank,
}

/// One or several fields of the same format.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    /// Without brackets.
    pub(super) name: String,
    pub(super) kind: Kind,
    /// How many of them follow each other.
    pub(super) repeat: usize,
    /// Of each, in characters.
    pub(super) width: usize,
    pub(super) unit: Option<String>,
    pub(super) null: Option<f64>,
}

/// A sort of records.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RecordType {
    /// What a record of it starts with; empty where records have no type.
    pub(super) mark: String,
    pub(super) fields: Vec<Field>,
}

/// Names are cut to this, so that an array of many does not cost more than the file.
const LARGEST_NAME: usize = 64;

/// Whether a text has definitions, maybe after comments.
pub(super) fn is_definition(text: &str) -> bool {
    let mut lines = lines(text).map(|line| line.text.trim_start());
    let first = lines.find(|line| !line.is_empty() && !line.starts_with("COMM"));
    first.is_some_and(|line| rest_of_definition(line).is_some())
}

/// The sorts of records that a text defines, in its order.
pub(super) fn record_types(text: &str) -> Vec<RecordType> {
    let mut types: Vec<RecordType> = Vec::new();
    for rest in lines(text).filter_map(|line| rest_of_definition(line.text)) {
        let mut parts = rest.split(';');
        let mark = parts.next().map(mark).unwrap_or_default();
        let index = types.iter().position(|known| known.mark == mark).unwrap_or_else(|| {
            types.push(RecordType { mark, fields: Vec::new() });
            types.len() - 1
        });
        let fields = parts.take_while(|part| !is_end(part)).filter_map(field);
        if let Some(known) = types.get_mut(index) {
            known.fields.extend(fields);
        }
    }
    types
}

impl RecordType {
    /// Of a record, in characters; none where that is beyond all sense.
    pub(super) fn width(&self) -> Option<usize> {
        self.fields.iter().try_fold(0_usize, |sum, field| sum.checked_add(field.repeat.checked_mul(field.width)?))
    }
}

/// What follows `DEFN 12 ST=RECD,`, from `RT=` on.
fn rest_of_definition(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix("DEFN")?;
    let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ' || c == '\t');
    let (sort, rest) = rest.split_once(',')?;
    (sort.trim() == "ST=RECD").then_some(rest.trim())
}

fn mark(part: &str) -> String {
    part.trim().strip_prefix("RT=").unwrap_or_default().trim().chars().take(LARGEST_NAME).collect()
}

fn is_end(part: &&str) -> bool {
    part.split_ascii_whitespace().eq(["END", "DEFN"])
}

/// `EM_Z:15f12.6:UNIT=fT:NULL=-999.9,NAME=Windows` and the like.
fn field(part: &str) -> Option<Field> {
    // Blanks may have no name.
    let (name, rest) = part.trim().split_once(':').unwrap_or(("", part));
    let (format, attributes) = rest.split_once([':', ',']).unwrap_or((rest, ""));
    let (repeat, kind, width) = fortran(format.trim())?;
    let (name, count) = name_and_count(name.trim());
    let attribute = |wanted: &str| {
        let mut pairs = attributes.split([':', ',']).filter_map(|pair| pair.split_once('='));
        pairs.find(|(key, _)| key.trim().eq_ignore_ascii_case(wanted)).map(|(_, value)| value.trim())
    };
    if name.is_empty() && kind != Kind::Blank {
        return None;
    }
    Some(Field {
        name: name.chars().take(LARGEST_NAME).collect(),
        kind,
        repeat: repeat.or(count).unwrap_or(1),
        width,
        unit: attribute("UNIT").or(attribute("UNITS")).map(|unit| unit.chars().take(LARGEST_NAME).collect()),
        null: attribute("NULL").and_then(number),
    })
}

/// Repeat count, kind and width of `15f12.6`.
fn fortran(format: &str) -> Option<(Option<usize>, Kind, usize)> {
    let at = format.find(|c: char| c.is_ascii_alphabetic())?;
    let (repeat, rest) = format.split_at(at);
    let letter = rest.chars().next()?.to_ascii_uppercase();
    let width = rest.get(1..)?.split('.').next()?.trim();
    let repeat = if repeat.is_empty() { None } else { Some(repeat.trim().parse().ok()?) };
    let kind = match letter {
        'I' | 'F' | 'E' | 'D' | 'G' => Kind::Number,
        'A' => Kind::Text,
        // `3X` is three blanks.
        'X' => return Some((None, Kind::Blank, repeat.unwrap_or(1))),
        _ => return None,
    };
    Some((repeat, kind, width.parse().ok()?))
}

/// `EM_Z[15]` is an array of 15.
fn name_and_count(name: &str) -> (&str, Option<usize>) {
    let bracket = name.strip_suffix(']').and_then(|head| head.split_once('['));
    bracket.map_or((name, None), |(name, count)| (name.trim(), count.trim().parse().ok()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_have_formats_units_and_nulls() {
        let text = "DEFN   ST=RECD,RT=COMM;RT:A4;COMMENTS:A76\r\n\
            DEFN  1 ST=RECD,RT=;Line:i10:NULL=-99999999,NAME=Line Number\r\n\
            DEFN  2 ST=RECD,RT=;EM_Z:15f12.6:UNIT=fT:NULL=-999.9,NAME=Raw: windows, all\r\n\
            DEFN  3 ST=RECD,RT=;EM_X[3]:E12.4:UNITS=fT;3X;Name:A8;END DEFN\r\nDEFN 4 ST=RECD,RT=;END DEFN\r\n";
        let [comments, data] = &record_types(text)[..] else { panic!("{:?}", record_types(text)) };
        assert_eq!((&comments.mark[..], comments.width()), ("COMM", Some(80)));
        let found: Vec<_> = data.fields.iter().map(|f| (&f.name[..], f.kind, f.repeat, f.width, f.null)).collect();
        let wanted = [
            ("Line", Kind::Number, 1, 10, Some(-99_999_999.0)),
            ("EM_Z", Kind::Number, 15, 12, Some(-999.9)),
            ("EM_X", Kind::Number, 3, 12, None),
            ("", Kind::Blank, 1, 3, None),
            ("Name", Kind::Text, 1, 8, None),
        ];
        assert_eq!(found, wanted);
        assert_eq!(data.fields[1].unit.as_deref(), Some("fT"));
        assert_eq!(data.fields[2].unit.as_deref(), Some("fT"));
        assert_eq!(data.width(), Some(10 + 15 * 12 + 36 + 3 + 8));
    }

    #[test]
    fn all_fields_may_stand_on_one_line() {
        let types = record_types("DEFN 1 ST=RECD,RT=DATA;RT:A4;LINE:I8;MAG:F10.2:UNIT=nT;END DEFN;X:I4\n");
        assert_eq!((types.len(), &types[0].mark[..], types[0].width()), (1, "DATA", Some(22)));
    }

    #[test]
    fn widths_beyond_all_sense_are_none() {
        let text = format!("DEFN 1 ST=RECD,RT=;A:{0}I{0};B:2I{0}", usize::MAX / 2);
        assert_eq!(record_types(&text)[0].width(), None);
    }

    #[test]
    fn definitions_are_known_by_their_first_line() {
        assert!(is_definition("\r\nDEFN  0 ST=RECD,RT=;Line:i10\r\n"));
        assert!(is_definition("COMM# flown low\nDEFN ST=RECD,RT=COMM;RT:A4;COMMENTS:A76\n"));
        for text in ["", "COMM", "DEFN", "DEFN 1 ST=OTHER,RT=;", "DEFINE ST=RECD,RT=", "x\nDEFN 1 ST=RECD,RT=;A:I4"] {
            assert!(!is_definition(text), "{text:?}");
        }
    }
}
