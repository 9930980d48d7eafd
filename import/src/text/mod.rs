//! Text of any kind: its encoding, lines, fields and numbers; and delimited text, of which nothing is known beforehand: what
//! parts its fields, which sign its decimals have, where its header and its units stand.
//!
//! ```text
//! bytes -> decode: text -> dialect: found from the first lines -> rows: numbers where they are numbers, else text
//! ```

mod cell;
mod column;
mod comment;
mod decode;
mod delimited;
mod dialect;
mod fields;
mod header;
mod lines;
mod rows;
mod signs;
mod tally;
mod title;

pub(crate) use self::cell::{is_missing, number, parse_number};
pub(crate) use self::column::{Column, Missing, Words};
pub(crate) use self::decode::{decode, decoded};
pub(crate) use self::delimited::read;
pub(crate) use self::dialect::Dialect;
pub(crate) use self::fields::{Fields, loose_fields};
pub(crate) use self::lines::{Line, is_cut, lines};
pub(crate) use self::rows::{LARGEST_COLUMNS, Rows, are_text};
pub(crate) use self::signs::{Decimal, Delimiter};
pub(crate) use self::tally::Tally;
pub(crate) use self::title::name_and_unit;
