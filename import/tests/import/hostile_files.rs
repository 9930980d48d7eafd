//! Damaged and made-up files: an answer in words, never a panic, and no more memory than the file warrants.
//!
//! The memory is seen where a limit is set from outside, as by `ulimit -v 1000000`.

use std::io::{Cursor, Read as _, Write as _};

use proptest::prelude::*;
use towmag_import::formats::{FORMATS, Input};
use zip::{ZipArchive, ZipWriter};

macro_rules! corpus {
    ($($name:literal),*) => { [$(include_bytes!(concat!("../corpus/", $name)).as_slice()),*] };
}

/// Files whose bytes may be changed anywhere.
const FILES: [&[u8]; 9] = corpus!(
    "magnav_deflate.h5",
    "magnav_1_14.h5",
    "magnav_groups.h5",
    "magnav_mixed.h5",
    "mat_plain.mat",
    "mat_struct.mat",
    "mat_73.mat",
    "tow.xls",
    "tow.ods"
);
/// Files whose parts have sums that a change would not pass: the parts are changed, and packed again.
const ARCHIVES: [&[u8]; 3] = corpus!("tow.ods", "two_sheets.xlsx", "units_row.xlsx");

/// What is done to a file's bytes.
#[derive(Clone, Debug)]
enum Damage {
    Flip(usize, u8),
    Overwrite(usize, Vec<u8>),
    Cut(usize),
    Repeat(usize, usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    let place = || any::<prop::sample::Index>().prop_map(|index| index.index(1 << 20));
    let bytes = prop_oneof![
        Just(vec![0xff; 8]),
        Just(vec![0; 8]),
        Just(b"99999999".to_vec()),
        any::<[u8; 4]>().prop_map(Vec::from)
    ];
    prop_oneof![
        6 => (place(), 0_u8..8).prop_map(|(place, bit)| Damage::Flip(place, bit)),
        // Sizes and addresses stand near the beginning.
        6 => (0_usize..4096, 0_u8..8).prop_map(|(place, bit)| Damage::Flip(place, bit)),
        3 => (place(), bytes).prop_map(|(place, bytes)| Damage::Overwrite(place, bytes)),
        1 => place().prop_map(Damage::Cut),
        1 => (place(), 1_usize..64).prop_map(|(place, length)| Damage::Repeat(place, length)),
    ]
}

fn damaged(bytes: &[u8], damages: &[Damage]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for damage in damages {
        let length = bytes.len().max(1);
        match damage {
            Damage::Flip(place, bit) if !bytes.is_empty() => bytes[place % length] ^= 1 << bit,
            Damage::Overwrite(place, new) => {
                bytes.iter_mut().skip(place % length).zip(new).for_each(|(old, new)| *old = *new);
            }
            Damage::Cut(place) => bytes.truncate(place % length),
            Damage::Repeat(place, size) => {
                let start = place % length;
                let piece: Vec<u8> = bytes.iter().skip(start).take(*size).copied().collect();
                bytes.splice(start..start, piece);
            }
            Damage::Flip(..) => {}
        }
    }
    bytes
}

/// Gives the bytes to every reader, whether it takes them for its own or not.
fn read(bytes: &[u8]) -> Result<(), TestCaseError> {
    for format in FORMATS {
        format.recognises(&bytes[..bytes.len().min(65_536)]);
        match format.read(&Input { file: "f", bytes, companions: &[], part: None }) {
            Ok(source) => {
                for table in &source.tables {
                    prop_assert!(table.columns.iter().all(|column| column.values.len() == table.rows));
                }
            }
            Err(refusal) => prop_assert!(refusal.to_string().len() > 10),
        }
    }
    Ok(())
}

/// The archive with one of its parts damaged.
fn with_damaged_part(bytes: &[u8], part: usize, damages: &[Damage]) -> Vec<u8> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut out = ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).unwrap();
        let mut content = Vec::new();
        entry.read_to_end(&mut content).unwrap();
        if index == part % 16 {
            content = damaged(&content, damages);
        }
        // The type of an OpenDocument file must not be compressed.
        let options = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        out.start_file(entry.name().unwrap(), options).unwrap();
        out.write_all(&content).unwrap();
    }
    out.finish().unwrap().into_inner()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_are_refused_in_words(bytes in prop::collection::vec(any::<u8>(), 0..2000), start in 0_usize..5) {
        let starts: [&[u8]; 5] = [b"", b"\x89HDF\r\n\x1a\n", b"PK\x03\x04[Content_Types].xml", FILES[7], b"MATLAB 5.0"];
        let start = &starts[start][..starts[start].len().min(600)];
        read(&[start, &bytes].concat())?;
    }

    #[test]
    fn damaged_files_are_read_or_refused_in_words(
        file in 0..FILES.len(),
        damages in prop::collection::vec(damage(), 1..8),
    ) {
        read(&damaged(FILES[file], &damages))?;
    }

    #[test]
    fn archives_with_damaged_parts_are_read_or_refused_in_words(
        file in 0..ARCHIVES.len(),
        part in 0_usize..16,
        damages in prop::collection::vec(damage(), 1..4),
    ) {
        read(&with_damaged_part(ARCHIVES[file], part, &damages))?;
    }
}
