//! Formats that are known by their first bytes and not read: what to do instead.

use super::format::{Input, SourceFormat};
use crate::error::ImportError;
use crate::source::Source;

/// Formats that are only named.
#[derive(Debug)]
pub(super) struct NamedOnly;

/// A format, how to know it, and the way around.
struct Named {
    name: &'static str,
    is: fn(&[u8]) -> bool,
    instead: &'static str,
}

const CSV_FROM_PANDAS: &str = "write its table as CSV, as with pandas: `pandas.read_parquet(f).to_csv(g)`";
const NO_DATA: &str = "give the numbers themselves: a CSV export of the program that made it";

const NAMED: [Named; 14] = [
    Named {
        name: "PX4 ULog",
        is: |first| first.starts_with(b"ULog\x01\x12\x35"),
        instead: "run `ulog2csv` of pyulog on it, and import the CSV of the topic with the magnetometer",
    },
    // A DataFlash log starts with the format of its formats: https://ardupilot.org/dev/docs/code-overview-adding-a-new-log-message.html
    Named {
        name: "ArduPilot DataFlash log",
        is: |first| first.starts_with(b"\xa3\x95\x80\x80"),
        instead: "run `mavlogdump.py --types MAG --format csv` of pymavlink on it, and import the CSV",
    },
    // The first bytes: https://github.com/RichardScottOZ/Geosoft-GDB-Conversion
    Named {
        name: "Geosoft GDB",
        is: |first| first.starts_with(b"!CBD"),
        instead: "export it as XYZ (Oasis montaj: Database > Export > Geosoft XYZ), and import that",
    },
    Named { name: "Parquet", is: |first| first.starts_with(b"PAR1"), instead: CSV_FROM_PANDAS },
    Named {
        name: "MCAP",
        is: |first| first.starts_with(b"\x89MCAP0\r\n"),
        instead: "export the topic with the magnetometer as CSV, as with PlotJuggler, and import that",
    },
    Named {
        name: "netCDF classic",
        is: |first| [&b"CDF\x01"[..], b"CDF\x02", b"CDF\x05"].iter().any(|magic| first.starts_with(magic)),
        instead: "write its variables as CSV, as with xarray: `xarray.open_dataset(f).to_dataframe().to_csv(g)`",
    },
    Named {
        name: "GeoPackage",
        is: |first| is_sqlite(first) && first.get(68..72) == Some(b"GPKG"),
        instead: "export the layer as CSV: `ogr2ogr -f CSV out.csv in.gpkg`",
    },
    Named {
        name: "SQLite database",
        is: is_sqlite,
        instead: "export its table: `sqlite3 -header -csv in.db 'select * from t'`",
    },
    Named { name: "PDF document", is: |first| first.starts_with(b"%PDF-"), instead: NO_DATA },
    Named { name: "PNG picture", is: |first| first.starts_with(b"\x89PNG\r\n\x1a\n"), instead: NO_DATA },
    Named { name: "JPEG picture", is: |first| first.starts_with(b"\xff\xd8\xff"), instead: NO_DATA },
    Named { name: "zip archive", is: is_archive, instead: "unpack it, and give the files in it" },
    Named {
        name: "7-Zip archive",
        is: |first| first.starts_with(b"7z\xbc\xaf\x27\x1c"),
        instead: "unpack it, and give the files in it",
    },
    Named {
        name: "RAR archive",
        is: |first| first.starts_with(b"Rar!\x1a\x07"),
        instead: "unpack it, and give the files in it",
    },
];

impl SourceFormat for NamedOnly {
    fn name(&self) -> &'static str {
        "a format that is not read"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        named(first).is_some()
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let what = match named(input.bytes.get(..input.bytes.len().min(65_536)).unwrap_or_default()) {
            Some(known) => format!("a file of the kind {}, which is not read: {}", known.name, known.instead),
            None => format!("not read: {NO_DATA}"),
        };
        Err(ImportError::file(input.file, what))
    }
}

fn named(first: &[u8]) -> Option<&'static Named> {
    NAMED.iter().find(|named| (named.is)(first))
}

fn is_sqlite(first: &[u8]) -> bool {
    first.starts_with(b"SQLite format 3\0")
}

/// A zip that no spreadsheet is: those have one of these names among their first members.
fn is_archive(first: &[u8]) -> bool {
    let spreadsheets = [&b"[Content_Types].xml"[..], b"mimetype", b"_rels/", b"docProps/", b"xl/", b"META-INF/"];
    let has = |name: &[u8]| first.windows(name.len()).any(|window| window == name);
    first.starts_with(b"PK\x03\x04") && !spreadsheets.into_iter().any(has)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(bytes: &[u8]) -> String {
        assert!(NamedOnly.recognises(bytes), "{bytes:?}");
        NamedOnly.read(&Input { file: "a", bytes, companions: &[], part: None }).unwrap_err().to_string()
    }

    #[test]
    fn each_is_named_with_the_way_around() {
        let geopackage = [&b"SQLite format 3\0"[..], &[0; 52], b"GPKG"].concat();
        let cases: [(&[u8], &str, &str); 14] = [
            (b"\xa3\x95\x80\x80\x59", "ArduPilot DataFlash log", "mavlogdump.py"),
            (b"ULog\x01\x12\x35\x01", "PX4 ULog", "ulog2csv"),
            (b"!CBD\0\0", "Geosoft GDB", "XYZ"),
            (b"PAR1\x15", "Parquet", "to_csv"),
            (b"\x89MCAP0\r\n", "MCAP", "CSV"),
            (b"CDF\x01\0", "netCDF classic", "to_csv"),
            (b"CDF\x02\0", "netCDF classic", "to_csv"),
            (&geopackage, "GeoPackage", "ogr2ogr"),
            (b"SQLite format 3\0\x10", "SQLite", "sqlite3"),
            (b"%PDF-1.7", "PDF", "CSV"),
            (b"\x89PNG\r\n\x1a\n", "PNG", "CSV"),
            (b"\xff\xd8\xff\xe0", "JPEG", "CSV"),
            (b"PK\x03\x04\x14\0survey.csv", "zip", "unpack"),
            (b"Rar!\x1a\x07\0", "RAR", "unpack"),
        ];
        for (bytes, name, instead) in cases {
            let text = refusal(bytes);
            assert!(text.starts_with(&format!("a: a file of the kind {name}")) && text.contains(instead), "{text}");
        }
    }

    #[test]
    fn spreadsheets_and_text_are_not_named() {
        let others: [&[u8]; 6] = [
            b"",
            b"PK\x03\x04\x14\0[Content_Types].xml",
            b"PK\x03\x04\x14\0mimetypeapplication/vnd.oasis",
            b"PK\x03\x04\x14\0xl/workbook.xml",
            b"a,b\n1,2\n",
            b"\x89HDF\r\n\x1a\n",
        ];
        for bytes in others {
            assert!(!NamedOnly.recognises(bytes), "{bytes:?}");
        }
    }
}
