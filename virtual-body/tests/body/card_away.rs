//! A card that is not there, goes, comes back, or loses its power: the body lives on, and the log tells what is missing.

use towmag::log::{Record, Recovered};
use towmag_virtual_body::disk::{Cut, Disk};
use towmag_virtual_body::fat::{Layout, fat16, fat16_of};
use towmag_virtual_body::log::{Log, epoch, recover_image};
use towmag_virtual_body::rng::Rng;
use towmag_virtual_body::sd::{Capacity, Fault, SdCard};
use towmag_virtual_body::voyage::Voyage;

/// A card with room for the file of an hour and some more.
fn card(capacity: Capacity) -> SdCard {
    SdCard::new(fat16(20_000), capacity)
}

/// The contents of the card in the socket.
fn log_of(voyage: &Voyage) -> Log {
    recover_image(&voyage.world.socket.borrow().as_ref().expect("a card").disk)
}

/// Records that the log itself says are missing.
fn told(log: &Log) -> u32 {
    let lost = |item: &Recovered| match item {
        Recovered::Record(Record::Loss(loss)) => loss.epochs + loss.others,
        _ => 0,
    };
    log.items.iter().map(lost).sum()
}

/// Every epoch is in the log, or told of in its place.
fn assert_complete(voyage: &Voyage, context: &str) {
    let log = log_of(voyage);
    log.assert_true(context);
    let mut gap = 0;
    let mut next = 0;
    for item in &log.items {
        match item {
            Recovered::Record(Record::Loss(loss)) => {
                assert_eq!(loss.first_tick, next, "{context}: a gap in its place");
                gap += loss.epochs;
                next += loss.epochs;
            }
            Recovered::Record(record @ Record::Epoch(found)) => {
                assert_eq!(found.epoch.tick, next, "{context}: no epoch is missing without a word");
                assert_eq!(record, &epoch(next), "{context}");
                next += 1;
            }
            _ => {}
        }
    }
    assert_eq!(gap, told(&log), "{context}");
}

#[test]
fn ten_minutes_without_a_card() {
    let mut voyage = Voyage::start(None, 1);
    voyage.sail(600.0);
    let silence_s = voyage.seen.longest_silence_ns.get() as f64 * 1e-9;
    println!(
        "10 min without a card: {} watchdog resets, {} epochs, longest silence {silence_s:.2} s, longest step {:.3} s",
        voyage.seen.resets.get(),
        voyage.seen.epochs.get(),
        voyage.longest_step_ns as f64 * 1e-9
    );
    assert_eq!(voyage.seen.resets.get(), 0);
    assert!(voyage.seen.epochs.get() >= 5_990);
    assert!(voyage.longest_step_ns < 100_000_000);
    // And then somebody finds one.
    voyage.world.socket.replace(Some(card(Capacity::High)));
    voyage.sail(20.0);
    voyage.close();
    assert_complete(&voyage, "a card at last");
}

#[test]
fn every_kind_of_card_is_logged_to() {
    for capacity in [Capacity::Standard, Capacity::High] {
        let mut voyage = Voyage::start(Some(card(capacity)), 1);
        voyage.sail(60.0);
        voyage.close();
        assert_eq!((voyage.lost(), voyage.seen.resets.get()), (0, 0), "{capacity:?}");
        assert!(voyage.safe() >= 595, "{capacity:?}: {}", voyage.safe());
        assert_complete(&voyage, &format!("{capacity:?}"));
    }
}

/// From 0.01 to 60 s, as often below as above 0.8 s.
fn duration_s(rng: &mut Rng) -> f64 {
    0.01 * 6000_f64.powf(rng.below(1_000_000) as f64 * 1e-6)
}

#[test]
fn a_bad_day() {
    const FAULTS: u32 = 1000;
    let mut rng = Rng(11);
    let disk = fat16_of(40_000, 1, Layout::Aligned);
    disk.set_mode(Cut::Garbage, 5);
    let mut voyage = Voyage::start(Some(SdCard::new(disk, Capacity::High)), 3);
    voyage.sail(20.0);
    let mut longest_s: f64 = 0.0;
    for number in 0..FAULTS {
        let away_s = duration_s(&mut rng);
        let begins_s = rng.below(1_000_000) as f64 * 1e-6;
        match rng.below(3) {
            0 => {
                voyage.world.plan(begins_s, Fault::Removed);
                voyage.world.plan(begins_s + away_s, Fault::Inserted);
            }
            1 => voyage.world.plan(begins_s, Fault::PowerLost),
            _ => voyage.world.plan(begins_s, Fault::Stalls(10 + rng.below(491) as u32)),
        }
        voyage.sail(begins_s + away_s);
        // Back in its socket: until something is safe again.
        let (back_s, safe) = (voyage.world.now_s(), voyage.safe());
        while voyage.safe() == safe {
            voyage.step();
            assert!(voyage.world.now_s() < back_s + 30.0, "fault {number}: nothing is logged any more");
        }
        longest_s = longest_s.max(voyage.world.now_s() - back_s);
    }
    voyage.close();
    println!(
        "{FAULTS} faults in {:.1} h: {} epochs, {} lost and told, logging again after {longest_s:.1} s at most",
        voyage.world.now_s() / 3600.0,
        voyage.seen.epochs.get(),
        told(&log_of(&voyage)),
    );
    assert!(longest_s <= 10.0, "{longest_s}");
    assert_eq!(voyage.seen.resets.get(), 0);
    assert_eq!(told(&log_of(&voyage)), voyage.lost());
    assert_complete(&voyage, "a bad day");
}

#[test]
fn a_bad_wire_costs_nothing() {
    let mut voyage = Voyage::start(Some(card(Capacity::High)), 1);
    voyage.sail(20.0);
    // About one block in fifty is wrong.
    voyage.world.happen(Fault::BitErrors(400_000));
    voyage.sail(300.0);
    voyage.world.happen(Fault::BitErrors(0));
    voyage.sail(10.0);
    voyage.close();
    assert_eq!((voyage.lost(), voyage.seen.resets.get()), (0, 0));
    assert_complete(&voyage, "a bad wire");
}

#[test]
fn errors_of_single_blocks_cost_nothing() {
    let mut voyage = Voyage::start(Some(card(Capacity::High)), 1);
    voyage.sail(20.0);
    for fault in [Fault::ReadError, Fault::WriteError, Fault::Stalls(500), Fault::WriteError, Fault::ReadError] {
        voyage.world.happen(fault);
        voyage.sail(5.0);
    }
    voyage.close();
    assert_eq!(voyage.lost(), 0);
    assert_complete(&voyage, "single errors");
}

#[test]
fn a_card_that_can_only_be_read_holds_nothing_up() {
    let mut voyage = Voyage::start(Some(card(Capacity::High)), 1);
    voyage.sail(20.0);
    let safe = voyage.safe();
    voyage.world.happen(Fault::ReadOnly);
    voyage.sail(120.0);
    assert_eq!(voyage.seen.resets.get(), 0);
    assert!(voyage.health.activity(false).log_failing);
    let log = log_of(&voyage);
    log.assert_true("read only");
    assert!(log.epochs.len() as u32 + 12 >= safe, "what was safe is there");
}

#[test]
fn no_call_outlasts_two_seconds() {
    let mut voyage = Voyage::start(Some(card(Capacity::High)), 1);
    voyage.sail(20.0);
    voyage.world.happen(Fault::Stalls(30_000));
    voyage.sail(60.0);
    voyage.close();
    let longest_s = voyage.longest_step_ns as f64 * 1e-9;
    println!("a card that is busy for 30 s: longest step {longest_s:.2} s, {} records lost and told", voyage.lost());
    assert!(longest_s < 2.5, "{longest_s}");
    assert_eq!(voyage.seen.resets.get(), 0);
    assert_complete(&voyage, "a card that is busy for 30 s");
}

#[test]
fn another_card_goes_on_with_the_session() {
    let mut voyage = Voyage::start(Some(card(Capacity::High)), 1);
    voyage.sail(30.0);
    let first = voyage.world.socket.take().unwrap();
    voyage.sail(3.0);
    voyage.world.socket.replace(Some(card(Capacity::Standard)));
    voyage.sail(30.0);
    voyage.close();
    let log = log_of(&voyage);
    assert!(matches!(log.items[1], Recovered::Record(Record::Header(_))), "{:?}", &log.items[..3]);
    let both: Vec<u32> = recover_image(&first.disk).epochs.into_keys().chain(log.epochs.into_keys()).collect();
    assert_eq!(both, (0..both.len() as u32).collect::<Vec<_>>());
    assert!(both.len() as u32 + 2 >= voyage.seen.epochs.get());
}

#[test]
fn a_card_that_lies_loses_what_it_held() {
    let disk: Disk = fat16(20_000);
    disk.set_mode(Cut::Lying, 3);
    let mut voyage = Voyage::start(Some(SdCard::new(disk, Capacity::High)), 1);
    for _ in 0..50 {
        voyage.sail(7.0);
        voyage.world.happen(Fault::PowerLost);
    }
    voyage.sail(7.0);
    voyage.close();
    assert_eq!(voyage.lost(), 0);
    let log = log_of(&voyage);
    log.assert_true("a lying card");
    let missing = voyage.seen.epochs.get() - log.epochs.len() as u32;
    println!(
        "50 power losses of a card that lies about its last 4 blocks: {missing} epochs of {}",
        voyage.seen.epochs.get()
    );
    assert!(missing <= 50 * 40, "{missing}");
}
