//! Cards that are prepared on the desk, and the body that logs on them.
#![cfg(not(target_os = "none"))]

mod common;

use common::Memory;
use proptest::prelude::*;
use towmag::health::Count;
use towmag_card::{CardError, Listing, Wanted, prepare};
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::disk::Disk;
use towmag_virtual_body::fat::{Layout, fat16, fat16_of, fat32, leave_runs};
use towmag_virtual_body::log::{read_file, recover_file};

const HOUR: Wanted = Wanted { hours: 1, files: 1, nonce: 7 };

/// What the body finds in its socket.
fn disk(card: &Memory) -> Disk {
    Disk::from_blocks(card.bytes.borrow().as_chunks::<512>().0.to_vec())
}

fn prepared(disk: &Disk, wanted: &Wanted) -> Memory {
    let card = Memory::from(disk);
    let files = prepare(&card, wanted, &()).unwrap();
    assert_eq!(files.len(), wanted.files as usize);
    card
}

#[test]
fn the_body_logs_on_a_prepared_card_at_once() {
    for formatted in [fat16(8_000), fat16_of(4_100, 8, Layout::Aligned), fat32()] {
        let bench = Bench::new();
        store(&bench, |_| ());
        bench.card.replace(Some(disk(&prepared(&formatted, &HOUR))));
        let mut body = Body::start(&bench);
        body.live(30);
        assert_eq!(body.health.counts.get(Count::LogErrors), 0);
        let card = bench.card.take().unwrap();
        // No table, no directory, no marker: each sector twice, and nothing else.
        assert!(card.writes() < 80, "{} writes", card.writes());
        assert!(recover_file(&card, "TOWMAG01.BIN").unwrap().epochs.len() > 250);
        assert!(read_file(&card, "TOWMAG02.BIN").is_none());
    }
}

#[test]
fn several_files_are_used_from_the_first_to_the_last() {
    let bench = Bench::new();
    store(&bench, |_| ());
    let card = prepared(&fat16(30_000), &Wanted { files: 3, ..HOUR });
    bench.card.replace(Some(disk(&card)));
    Body::start(&bench).live(16_000);
    let epochs = |number| recover_file(bench.card.borrow().as_ref().unwrap(), number).unwrap().epochs.len();
    let found = ["TOWMAG01.BIN", "TOWMAG02.BIN", "TOWMAG03.BIN"].map(epochs);
    assert!(found[0] > 30_000 && found[1] > 300 && found[2] == 0, "{found:?}");
    // A body that starts anew goes on where the last one ended.
    Body::start(&bench).live(20);
    assert_eq!(epochs("TOWMAG03.BIN"), 0);
    let card = bench.card.take().unwrap();
    assert!(read_file(&card, "TOWMAG04.BIN").is_none(), "there was room in the files that were prepared");
}

#[test]
fn a_card_that_was_prepared_is_told_by_its_files() {
    let card = prepared(&fat16(30_000), &Wanted { files: 2, ..HOUR });
    let listing = Listing::of(&card).unwrap();
    assert!(listing.holds_only_logs() && !listing.is_fat32);
    let names: Vec<&str> = listing.items.iter().map(|item| item.name.as_str()).collect();
    assert_eq!(names, ["TOWMAG01.BIN", "TOWMAG02.BIN"]);
    assert_eq!(listing.free_bytes(), (30_000 - 2 * 7_200) * 512);
    // The next ones come after them.
    let more = prepare(&card, &HOUR, &()).unwrap();
    assert_eq!(more[0].number, 3);
}

fn refusal(card: &Memory, wanted: &Wanted) -> CardError {
    let before = card.bytes.borrow().clone();
    let error = prepare(card, wanted, &()).unwrap_err();
    assert!(before == *card.bytes.borrow(), "{error}: and yet it was written to");
    assert!(error.is_bad_usage(), "{error}");
    error
}

#[test]
fn what_does_not_fit_leaves_the_card_as_it_was() {
    let card = Memory::from(&fat16(20_000));
    let message = refusal(&card, &Wanted { files: 3, ..HOUR }).to_string();
    assert!(message.starts_with("no room for file 3 of 3: 1 h take 3 MB"), "{message}");
    let full = fat16(8_000);
    leave_runs(&full, 1, 50);
    assert!(refusal(&Memory::from(&full), &HOUR).to_string().contains("empty the card"));
    for wanted in [Wanted { hours: 0, ..HOUR }, Wanted { hours: 241, ..HOUR }, Wanted { files: 0, ..HOUR }] {
        assert!(matches!(refusal(&card, &wanted), CardError::Usage(_)));
    }
}

/// A card whose blocks were changed.
fn changed(change: impl FnOnce(&mut [u8])) -> Memory {
    let card = Memory::from(&fat16(8_000));
    change(&mut card.bytes.borrow_mut());
    card
}

#[test]
fn other_formats_are_called_by_their_names() {
    const BOOT: usize = 8 * 512;
    let gpt = changed(|bytes| bytes[450..458].copy_from_slice(&[0xEE, 0, 0, 0, 1, 0, 0, 0]));
    let exfat = changed(|bytes| bytes[BOOT + 3..BOOT + 11].copy_from_slice(b"EXFAT   "));
    let ntfs = changed(|bytes| bytes[BOOT + 3..BOOT + 11].copy_from_slice(b"NTFS    "));
    let partition = changed(|bytes| {
        bytes[BOOT + 3..BOOT + 11].copy_from_slice(b"MSDOS5.0");
        bytes.drain_front(BOOT);
    });
    let cut = Memory::from(Memory::from(&fat16(8_000)).bytes.borrow()[..4_000 * 512].to_vec());
    let cases = [
        (gpt, "GUID"),
        (exfat, "exFAT"),
        (ntfs, "NTFS"),
        (partition, "one partition"),
        (cut, "cut short"),
        (Memory::from(vec![0; 512 * 100]), "no FAT16 or FAT32"),
        (Memory::from(Vec::new()), "less than a block"),
    ];
    for (card, word) in cases {
        let message = refusal(&card, &HOUR).to_string();
        assert!(message.contains(word) && message.contains("format the card FAT32"), "{word}: {message}");
    }
}

/// Bytes move to the front, zeros come in behind.
trait DrainFront {
    fn drain_front(&mut self, count: usize);
}

impl DrainFront for [u8] {
    fn drain_front(&mut self, count: usize) {
        self.rotate_left(count);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Whatever is in table, boot block, tables and directory.
    #[test]
    fn garbage_is_refused_or_prepared(
        changes in proptest::collection::vec((0_usize..80 * 512, any::<u8>()), 1..40),
        near_boot in proptest::collection::vec((0_usize..64, any::<u8>()), 0..8),
        cut in 1_usize..8_000,
    ) {
        let disk = fat16(8_000);
        let mut image = disk.image();
        for (at, value) in changes {
            image[at] = value;
        }
        for (at, value) in near_boot {
            image[8 * 512 + at] = value;
        }
        let len = image.len().min(if cut % 3 == 0 { cut * 512 } else { usize::MAX });
        let card = Memory::from(image[..len].to_vec());
        let _ = Listing::of(&card).map(|listing| listing.to_string());
        let _ = prepare(&card, &HOUR, &());
    }

    #[test]
    fn noise_is_refused(seed in any::<u64>(), blocks in 0_usize..200) {
        let mut value = seed | 1;
        let noise = (0..blocks * 512).map(|_| {
            value = value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (value >> 56) as u8
        });
        let card = Memory::from(noise.collect::<Vec<u8>>());
        prop_assert!(prepare(&card, &HOUR, &()).is_err());
    }
}
