//! Geosoft XYZ: columns of text, a record `Line` before the rows of each line.
//!
//! <https://help.seequent.com/Oasismontaj/2024.2/Content/ss/glossary/xyz_data.htm>. Comments begin with `/`, the last one
//! before the first line names the columns, and `*` stands for what is missing.

use std::fmt::Write;

use towmag_recording::Column;

use crate::legs::legs;
use crate::position::Position;
use crate::table::{Table, TableColumn, Values};

const MISSING: &str = "*";

/// The table as text.
pub(crate) fn encode(table: &Table) -> Vec<u8> {
    let position = Position::any(table);
    let is_position = |name: &str| position.is_some_and(|position| position.names.contains(&name));
    // The line has records of its own, and the position goes in front.
    let is_shown = |column: &&TableColumn| column.name != Column::Line.name() && !is_position(&column.name);
    let columns: Vec<&TableColumn> = table.columns.iter().filter(is_shown).collect();
    let mut text = header(table, position, &columns);
    for leg in legs(table) {
        if let Some(label) = leg.label.filter(|_| leg.is_renumbered()) {
            line(&mut text, format_args!("/ Line {} is {label:?}", leg.number));
        }
        line(&mut text, format_args!("Line {}", leg.number));
        for row in leg.rows {
            let place = position.iter().flat_map(|position| [position.x[row], position.y[row]]).map(number);
            let fields: Vec<String> = place.chain(columns.iter().map(|column| field(&column.values, row))).collect();
            line(&mut text, format_args!("{}", fields.join(" ")));
        }
    }
    text.into_bytes()
}

fn header(table: &Table, position: Option<Position<'_>>, columns: &[&TableColumn]) -> String {
    let mut text = String::new();
    line(&mut text, format_args!("/ {:?}", table.file_name()));
    line(&mut text, format_args!("/ {MISSING} where a value is missing"));
    let (names, units) = match position {
        Some(Position { names: [x, y], is_wgs84: true, .. }) => {
            line(&mut text, format_args!("/ x is {x}, y is {y}, WGS 84"));
            (vec!["x", "y"], vec!["deg", "deg"])
        }
        Some(Position { names: [x, y], .. }) => {
            line(&mut text, format_args!("/ x is {x}, y is {y}"));
            (vec!["x", "y"], vec!["m", "m"])
        }
        None => (vec![], vec![]),
    };
    let unit = |column: &&TableColumn| if column.unit.is_empty() { "-" } else { column.unit };
    let units: Vec<&str> = units.into_iter().chain(columns.iter().map(unit)).collect();
    let names: Vec<String> =
        names.into_iter().map(String::from).chain(columns.iter().map(|column| word(&column.name))).collect();
    line(&mut text, format_args!("/ units: {}", units.join(" ")));
    line(&mut text, format_args!("/ {}", names.join(" ")));
    text
}

fn field(values: &Values, row: usize) -> String {
    match values {
        Values::Number(numbers) => number(numbers[row]),
        Values::Flag(flags) => flags[row].map_or(MISSING, |flag| if flag { "1" } else { "0" }).into(),
        Values::Label(labels) => labels[row].as_deref().map_or(MISSING.into(), word),
    }
}

fn number(number: f64) -> String {
    if number.is_nan() { MISSING.into() } else { number.to_string() }
}

/// Blanks would begin another column.
fn word(text: &str) -> String {
    text.replace(|c: char| c.is_whitespace() || c.is_control(), "_")
}

fn line(text: &mut String, content: std::fmt::Arguments<'_>) {
    // A string takes everything.
    let _ = writeln!(text, "{content}");
}
