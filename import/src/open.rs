//! Files to sources: decompressed, recognised, read.

use crate::apart::tell_apart;
use crate::by_values;
use crate::compressed;
use crate::error::ImportError;
use crate::finding::Finding;
use crate::formats::{self, FORMATS};
use crate::options::Options;
use crate::profile::TextProfile;
use crate::source::{FindingKind, Source, SourceTable};
use crate::text::{Decimal, Delimiter, Dialect, decode, read};

/// A file that was read into memory.
#[derive(Clone, Debug)]
pub struct File {
    /// As the user named it.
    pub name: String,
    /// All of it.
    pub bytes: Vec<u8>,
}

/// What is to be imported.
#[derive(Clone, Debug)]
pub enum Input {
    /// A file of any format.
    File(File),
    /// What somebody else has read.
    Source(Source),
}

/// A file that was recognised and read.
#[derive(Clone, Debug)]
pub(crate) struct Opened {
    pub(crate) source: Source,
    /// How it was read, where it is text.
    pub(crate) text: TextProfile,
    pub(crate) findings: Vec<Finding>,
}

/// So much of a file is shown to those that recognise formats, bytes.
const SHOWN: usize = 1 << 16;
/// Of text so much may be characters that no text has.
const MOST_CONTROLS: f64 = 0.01;

/// All files, each in its format; a file that another one has taken along is not read again.
pub(crate) fn open(inputs: Vec<Input>, options: &Options) -> Result<Vec<Opened>, ImportError> {
    let (mut expanded, mut opened) = (Vec::new(), Vec::new());
    for input in inputs {
        match input {
            Input::File(File { name, bytes }) => {
                let (bytes, note) = compressed::expand(&name, bytes)?;
                expanded.push((name, bytes, note));
            }
            Input::Source(source) => {
                opened.push(Opened { source, text: TextProfile::default(), findings: Vec::new() });
            }
        }
    }
    let taken_along = taken_along(&expanded);
    let others: Vec<(String, Vec<u8>)> =
        taken_along.iter().map(|&at| (expanded[at].0.clone(), expanded[at].1.clone())).collect();
    for (at, (name, bytes, note)) in expanded.iter().enumerate() {
        if taken_along.contains(&at) {
            continue;
        }
        let mut one = open_one(name, bytes, &others, options)?;
        one.findings.extend(note.iter().map(|note| Finding::warning(FindingKind::Truncated, note.clone())));
        opened.push(one);
    }
    opened.iter_mut().flat_map(|one| &mut one.source.tables).for_each(tell_apart);
    Ok(opened)
}

/// The data of definitions: the file of the same stem, else the only other one.
fn taken_along(files: &[(String, Vec<u8>, Option<String>)]) -> Vec<usize> {
    let is_definition = |bytes: &[u8]| {
        FORMATS.iter().any(|format| format.takes_companions() && format.recognises(&bytes[..bytes.len().min(SHOWN)]))
    };
    let stem = |name: &str| std::path::Path::new(name).file_stem().map(|stem| stem.to_ascii_lowercase());
    let mut taken = Vec::new();
    for (name, bytes, _) in files.iter().filter(|(_, bytes, _)| is_definition(bytes)) {
        let others = || files.iter().enumerate().filter(|(_, (_, other, _))| !is_definition(other) && other != bytes);
        let same = others().find(|(_, (other, ..))| stem(other) == stem(name));
        if let Some((at, _)) = same.or_else(|| others().next().filter(|_| files.len() == 2)) {
            taken.push(at);
        }
    }
    taken
}

fn open_one(
    file: &str,
    bytes: &[u8],
    companions: &[(String, Vec<u8>)],
    options: &Options,
) -> Result<Opened, ImportError> {
    if bytes.is_empty() {
        return Err(ImportError::file(file, "is empty: copy it again from where it came"));
    }
    let first = &bytes[..bytes.len().min(SHOWN)];
    if let Some(format) = FORMATS.iter().find(|format| format.recognises(first)) {
        let source = format.read(&formats::Input { file, bytes, companions, part: options.profile.part.as_deref() })?;
        return Ok(Opened { source, text: TextProfile::default(), findings: Vec::new() });
    }
    open_text(file, bytes, &options.profile.text)
}

/// The table of a delimited text, of which nobody has said yet what its columns mean.
///
/// # Errors
///
/// When it holds no table of numbers.
pub fn read_text(file: &str, bytes: &[u8]) -> Result<Source, ImportError> {
    Ok(open_text(file, bytes, &TextProfile::default())?.source)
}

fn open_text(file: &str, bytes: &[u8], asked: &TextProfile) -> Result<Opened, ImportError> {
    let decoded = decode(bytes, asked.encoding.as_deref()).ok_or_else(|| {
        let encoding = asked.encoding.clone().unwrap_or_default();
        ImportError::Usage(format!("\"{encoding}\" is no encoding: utf-8, utf-16le, windows-1252 and the like"))
    })?;
    let controls = decoded.text.chars().take(SHOWN).filter(|c| c.is_control() && !c.is_whitespace()).count();
    if controls as f64 > MOST_CONTROLS * decoded.text.chars().take(SHOWN).count() as f64 {
        return Err(unknown(file));
    }
    let delimiter = asked.delimiter.as_deref().map(delimiter).transpose()?;
    let decimal = asked.decimal.as_deref().map(decimal).transpose()?;
    let dialect = Dialect::of(&decoded.text, delimiter, decimal).ok_or_else(|| no_table(file, &decoded.text))?;
    let mut source = read(file, &decoded.text, &dialect)?;
    let by_values = (dialect.header_line == 0).then(|| source.tables.first_mut().and_then(by_values::name)).flatten();
    let text = TextProfile {
        delimiter: Some(dialect.delimiter.name().into()),
        decimal: Some(dialect.decimal.name().into()),
        encoding: Some(decoded.encoding.to_lowercase()),
    };
    let told = told(&dialect, decoded.encoding).map(|text| Finding::new(FindingKind::Delimiter, text));
    Ok(Opened { source, text, findings: told.into_iter().chain(by_values).collect() })
}

/// What is told of a text that is not read as every CSV file is.
fn told(dialect: &Dialect, encoding: &str) -> Option<String> {
    let mut told = Vec::new();
    if dialect.delimiter != Delimiter::Byte(b',') {
        told.push(format!("fields are parted by {}", dialect.delimiter.name()));
    }
    if dialect.decimal == Decimal::Comma {
        told.push("decimals stand behind a comma".into());
    }
    if encoding != "UTF-8" {
        told.push(format!("the text is {encoding}"));
    }
    match dialect.header_line {
        0 => told.push("there is no header".into()),
        1 => {}
        line => told.push(format!("the names stand in line {line}")),
    }
    if !dialect.units.is_empty() {
        told.push("their units below them".into());
    }
    (!told.is_empty()).then(|| told.join("; "))
}

fn delimiter(name: &str) -> Result<Delimiter, ImportError> {
    let names = Delimiter::ALL.map(Delimiter::name).join(", ");
    Delimiter::named(name).ok_or_else(|| ImportError::Usage(format!("\"{name}\" is no delimiter: {names}")))
}

fn decimal(name: &str) -> Result<Decimal, ImportError> {
    Decimal::named(name).ok_or_else(|| ImportError::Usage(format!("\"{name}\" is no decimal sign: point, comma")))
}

fn unknown(file: &str) -> ImportError {
    ImportError::file(
        file,
        "is no format that this program knows: export it as text (CSV or Geosoft XYZ) from the program that wrote it",
    )
}

fn no_table(file: &str, text: &str) -> ImportError {
    let names = text.lines().next().unwrap_or_default();
    let has_header = names.split([',', ';', '\t']).count() >= 2 && text.lines().nth(1).is_none();
    let what =
        if has_header { "has a header and no rows" } else { "holds no table of numbers that this program can see" };
    ImportError::file(file, format!("{what}: is it the right file? A delimiter can be given with --delimiter"))
}

/// The table of a source that is taken: the one asked for, else the first with most rows.
pub(crate) fn table<'a>(
    source: &'a Source,
    part: Option<&str>,
) -> Result<(&'a SourceTable, Vec<Finding>), ImportError> {
    let names =
        || source.tables.iter().map(|table| table.name.as_str()).filter(|name| !name.is_empty()).collect::<Vec<_>>();
    if let Some(part) = part.filter(|_| source.tables.len() > 1) {
        let found = source.tables.iter().find(|table| table.name.eq_ignore_ascii_case(part));
        let what = || format!("has no part \"{part}\"; it has {}", names().join(", "));
        return Ok((found.ok_or_else(|| ImportError::file(&source.file, what()))?, Vec::new()));
    }
    let longest = source.tables.iter().enumerate().max_by_key(|(at, table)| (table.rows, usize::MAX - at));
    let table = longest.map(|(_, table)| table).filter(|table| table.rows > 0);
    let table =
        table.ok_or_else(|| ImportError::file(&source.file, "holds no rows: is it the right file, and whole?"))?;
    let mut findings = Vec::new();
    if source.tables.len() > 1 {
        let others = names().into_iter().filter(|name| *name != table.name).collect::<Vec<_>>().join(", ");
        let text = format!("\"{}\" was taken of its parts; there are also {others}", table.name);
        findings.push(Finding::new(FindingKind::Choice, text).with("--part NAME"));
    }
    Ok((table, findings))
}

#[cfg(test)]
#[path = "open_tests.rs"]
mod tests;
