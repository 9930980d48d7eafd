//! Long voyages: files are made and changed while the log goes on.

use std::collections::BTreeSet;
use towmag::log::{Record, Recovered};
use towmag_virtual_body::fat::{Layout, fat16_of};
use towmag_virtual_body::log::recover_image;
use towmag_virtual_body::sd::{Capacity, SdCard};
use towmag_virtual_body::voyage::Voyage;

/// A card of so many blocks, in clusters of 64.
fn card(blocks: usize) -> SdCard {
    SdCard::new(fat16_of((blocks / 64).max(4085), 64, Layout::Aligned), Capacity::High)
}

/// Files that the log is in, and the epochs of it.
fn logged(voyage: &Voyage) -> (BTreeSet<u16>, u32) {
    let log = recover_image(&voyage.world.socket.borrow().as_ref().unwrap().disk);
    log.assert_true("a voyage");
    let ticks: Vec<u32> = log.epochs.keys().copied().collect();
    assert!(ticks.iter().copied().eq(0..ticks.len() as u32), "no epoch is missing");
    let is_loss = |item: &Recovered| matches!(item, Recovered::Record(Record::Loss(_)) | Recovered::Missing { .. });
    assert!(!log.items.iter().any(is_loss));
    (log.keys.iter().map(|key| key.id.file_number).collect(), ticks.len() as u32)
}

#[test]
fn a_file_of_72_hours_is_made_while_the_log_goes_on() {
    let mut voyage = Voyage::start(Some(card(600_000)), 72);
    let begin_s = voyage.world.now_s();
    let (mut bus_s, mut first_s) = (0.0, None);
    while !voyage.is_idle() {
        bus_s += voyage.step();
        if first_s.is_none() && voyage.safe() > 0 {
            first_s = Some(voyage.world.now_s() - begin_s);
        }
    }
    println!(
        "a file of 72 h: {bus_s:.0} s of the bus within {:.0} s, logging after {:.1} s, longest step {:.2} s, {} records lost",
        voyage.world.now_s() - begin_s,
        first_s.unwrap(),
        voyage.longest_step_ns as f64 * 1e-9,
        voyage.lost()
    );
    assert!(bus_s < 360.0, "{bus_s}");
    assert!(voyage.longest_step_ns < 250_000_000);
    assert_eq!((voyage.lost(), voyage.seen.resets.get()), (0, 0));
    voyage.sail(10.0);
    voyage.close();
    let (files, epochs) = logged(&voyage);
    assert_eq!(files, [1].into());
    assert!(epochs + 1 >= voyage.seen.epochs.get());
}

#[test]
fn a_day_over_three_changes_of_file() {
    let mut voyage = Voyage::start(Some(card(300_000)), 7);
    voyage.sail(24.0 * 3600.0);
    voyage.close();
    let (files, epochs) = logged(&voyage);
    println!(
        "24 h: {epochs} epochs in files {files:?}, {} records lost, longest step {:.2} s",
        voyage.lost(),
        voyage.longest_step_ns as f64 * 1e-9
    );
    assert_eq!(files, [1, 2, 3, 4].into());
    assert_eq!((voyage.lost(), voyage.seen.resets.get()), (0, 0));
    assert!(epochs + 1 >= voyage.seen.epochs.get());
}
