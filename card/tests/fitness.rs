//! Cards that are tried on the desk: honest ones, fakes, slow and broken ones.
#![cfg(not(target_os = "none"))]

mod common;

use std::cell::Cell;
use std::io;
use std::path::Path;
use std::time::Duration;

use common::Memory;
use towmag_card::fitness::{Clock, Effort, FolderStore, Report, Trial};
use towmag_card::{CardError, Store, Wanted, prepare};
use towmag_virtual_body::fat::{Layout, fat16, fat16_of, leave_runs};

/// Time that passes when somebody waits, and a little with each look at it.
#[derive(Default)]
struct TestClock(Cell<Duration>);

impl Clock for TestClock {
    fn now(&self) -> Duration {
        self.0.set(self.0.get() + Duration::from_micros(100));
        self.0.get()
    }

    fn sleep(&self, pause: Duration) {
        self.0.set(self.0.get() + pause);
    }
}

fn trial(clock: &TestClock) -> Trial<'_> {
    Trial { effort: Effort::QUICK, seed: 99, clock, progress: &() }
}

fn tried<S: Store>(card: &S) -> Result<Report, CardError> {
    trial(&TestClock::default()).of_card(card)
}

/// 64 MiB with a log on it.
fn card() -> Memory {
    let card = Memory::from(&fat16_of(16_384, 8, Layout::Aligned));
    prepare(&card, &Wanted { hours: 1, files: 1, nonce: 7 }, &()).unwrap();
    card
}

#[test]
fn an_honest_card_is_fit_and_stays_as_it_was() {
    let card = card();
    let before = card.bytes.borrow().clone();
    let report = tried(&card).unwrap();
    let text = report.to_string();
    assert!(text.starts_with("fit\n"), "{text}");
    assert!(text.contains("0 bad blocks"), "{text}");
    assert!(before == *card.bytes.borrow());
}

#[test]
fn a_card_that_starts_again_from_its_beginning_is_found_and_loses_nothing() {
    for real_bytes in [40_000_000, 33 << 20, (20 << 20) + 512] {
        let card = card();
        card.bytes.borrow_mut().truncate(real_bytes / 512 * 512);
        let before = card.bytes.borrow().clone();
        assert!(card.told_blocks * 512 > real_bytes as u64);
        let report = tried(&card).unwrap();
        let text = report.to_string();
        let wanted = format!(
            "not fit: it lies about its size: it starts again from its beginning after {} MB",
            real_bytes / 1_000_000
        );
        assert!(text.starts_with(&wanted), "{text}");
        assert!(before == *card.bytes.borrow(), "what was on the card changed");
    }
}

/// A card with a fault.
struct Faulty<'a> {
    card: Memory,
    clock: &'a TestClock,
    /// From this byte on nothing is stored.
    forgets_from: u64,
    /// One write in so many takes 600 ms.
    slow_every: usize,
    /// After so many bytes writing fails.
    fails_after: Cell<u64>,
    writes: Cell<usize>,
}

impl<'a> Faulty<'a> {
    fn new(clock: &'a TestClock) -> Self {
        let never = Cell::new(u64::MAX);
        Self {
            card: card(),
            clock,
            forgets_from: u64::MAX,
            slow_every: usize::MAX,
            fails_after: never,
            writes: Cell::new(0),
        }
    }
}

impl Store for Faulty<'_> {
    fn blocks(&self) -> u64 {
        self.card.blocks()
    }

    fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.card.read(at, bytes)
    }

    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.writes.set(self.writes.get() + 1);
        if self.writes.get().is_multiple_of(self.slow_every) {
            self.clock.sleep(Duration::from_millis(600));
        }
        if at == self.fails_after.get() {
            return Err(io::Error::other("out of order"));
        }
        if at < self.forgets_from { self.card.write(at, bytes) } else { Ok(()) }
    }

    fn sync(&self) -> io::Result<()> {
        Ok(())
    }

    fn forget_cache(&self) -> bool {
        false
    }
}

#[test]
fn a_card_that_drops_what_it_has_no_room_for_is_found() {
    let clock = TestClock::default();
    let card = Faulty { forgets_from: 50 << 20, ..Faulty::new(&clock) };
    let text = trial(&clock).of_card(&card).unwrap().to_string();
    assert!(text.starts_with("not fit: ") && text.contains("blocks do not hold what was written"), "{text}");
}

#[test]
fn a_card_that_makes_the_body_wait_is_not_fit() {
    let clock = TestClock::default();
    let card = Faulty { slow_every: 150, ..Faulty::new(&clock) };
    let text = trial(&clock).of_card(&card).unwrap().to_string();
    assert!(text.starts_with("not fit: a write of one block took 600 ms, and 500 ms is the most\n"), "{text}");
}

#[test]
fn what_cannot_be_known_is_said() {
    let clock = TestClock::default();
    let text = trial(&clock).of_card(&Faulty::new(&clock)).unwrap().to_string();
    assert!(text.starts_with("fit: what was read back may come from this computer's memory"), "{text}");
}

#[test]
fn a_card_that_fails_on_the_way_is_put_back_as_far_as_it_goes() {
    let clock = TestClock::default();
    let card = Faulty { fails_after: Cell::new(32 << 20), ..Faulty::new(&clock) };
    let before = card.card.bytes.borrow().clone();
    let error = trial(&clock).of_card(&card).unwrap_err();
    assert!(matches!(error, CardError::Failed(_)) && !error.is_bad_usage(), "{error}");
    assert!(before == *card.card.bytes.borrow());
}

#[test]
fn a_full_card_has_nothing_to_try() {
    let full = fat16(8_000);
    leave_runs(&full, 0, 1);
    let error = tried(&Memory::from(&full)).unwrap_err();
    assert!(error.is_bad_usage() && error.to_string().contains("no free space"), "{error}");
    assert!(tried(&Memory::from(vec![0; 51_200])).unwrap_err().is_bad_usage());
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    entries.map(|name| name.to_string_lossy().into_owned()).collect()
}

#[test]
fn a_folder_is_as_it_was_afterwards() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("photo.jpg"), "kept").unwrap();
    let report = trial(&TestClock::default()).of_folder(&FolderStore::new(folder.path())).unwrap();
    let text = report.to_string();
    assert!(text.starts_with("fit") && text.contains("0 bad blocks"), "{text}");
    assert_eq!(names(folder.path()), ["photo.jpg"]);
}

#[test]
fn the_disk_of_the_system_is_never_filled() {
    let error = FolderStore::on_card(Path::new("/")).unwrap_err();
    assert!(error.is_bad_usage(), "{error}");
}
