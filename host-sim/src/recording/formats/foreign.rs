//! Files that are no recordings and are easily taken for one: each refused with what does read it.

use towmag_import::compressed::is_gzip;

use crate::recording::error::{BadInput, RecordingError};
use crate::recording::reader::Format;

/// Recognises them; opening one says what it is.
pub(super) const FORMAT: Format = Format {
    is_start: |start| kind_of(start).is_some(),
    open: |path, name| {
        let start = crate::recording::reader::start_of(path);
        Err(refusal(kind_of(&start).unwrap_or(Kind::Binary), name))
    },
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Gzip,
    Zip,
    Utf16,
    Importable,
    Binary,
}

/// First bytes of files that `import` may know: HDF5, Parquet, SQLite, MCAP.
const IMPORTABLE: [&[u8]; 4] = [b"\x89HDF\r\n\x1a\n", b"PAR1", b"SQLite format 3", b"\x89MCAP0\r\n"];

fn kind_of(start: &[u8]) -> Option<Kind> {
    match start {
        _ if is_gzip(start) => Some(Kind::Gzip),
        [b'P', b'K', 3, 4, ..] => Some(Kind::Zip),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some(Kind::Utf16),
        _ if IMPORTABLE.iter().any(|known| start.starts_with(known)) => Some(Kind::Importable),
        // No text has a zero in it; the first sector of a card does.
        _ if start.contains(&0) => Some(Kind::Binary),
        _ => None,
    }
}

fn refusal(kind: Kind, name: &str) -> RecordingError {
    let what = match kind {
        Kind::Gzip => "is compressed: unpack it with gunzip".into(),
        Kind::Zip => format!(
            "is a zip file or a spreadsheet: unpack it, or try `host-sim import {name} --out REC.csv`, or save the table as CSV"
        ),
        Kind::Utf16 => format!("is text in UTF-16: save it as UTF-8, or try `host-sim import {name} --out REC.csv`"),
        Kind::Importable => format!("is no CSV: try `host-sim import {name} --out REC.csv`"),
        Kind::Binary => format!(
            "is no text: what a card or an image of one holds is had by `host-sim recover {name} --out DIR`, another \
             recorder's file by `host-sim import {name} --out REC.csv`"
        ),
    };
    BadInput::of_line(what).at(name, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cards_and_tables_of_others_are_told_from_text() {
        let mut boot_sector = [0; 64];
        boot_sector[..11].copy_from_slice(b"\xeb\x3c\x90MSDOS5.0");
        assert_eq!(kind_of(&boot_sector), Some(Kind::Binary));
        assert_eq!(kind_of(b"PK\x03\x04rest"), Some(Kind::Zip));
        assert_eq!(kind_of(b"\xff\xfet\0i\0m\0e\0"), Some(Kind::Utf16));
        assert_eq!(kind_of(b"PAR1\x15"), Some(Kind::Importable));
        for text in ["", "time_s,scalar_nT", "\u{feff}time_s,scalar_nT", "P"] {
            assert_eq!(kind_of(text.as_bytes()), None);
        }
    }
}
