//! Delimited text of any kind: what parts its fields, which sign its decimals have, where its header and its units stand.
//!
//! ```text
//! bytes -> decode: text -> dialect: found from the first lines -> columns: numbers where they are numbers, else text
//! ```

mod cell;
mod columns;
mod decode;
mod dialect;
mod header;
mod lines;

pub use self::cell::{is_missing, parse_number};
pub use self::columns::read;
pub use self::decode::{Decoded, decode};
pub use self::dialect::{Decimal, Delimiter, Dialect};
