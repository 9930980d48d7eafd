//! The task of the storage: from the first look for a card to the restart.

use std::rc::Rc;
use towmag::health::Count;
use towmag::log::{Event, EventKind, Record, Recovered, ResetCause};
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::log::{Log, recover_file};

const FILE: &str = "TOWMAG01.BIN";

fn bench_with_card() -> Rc<Bench> {
    let bench = Bench::new();
    store(&bench, |_| ());
    bench.card.replace(Some(fat16(8000)));
    bench
}

fn log_of(bench: &Bench) -> Log {
    recover_file(bench.card.borrow().as_ref().unwrap(), FILE).unwrap()
}

fn records(log: &Log) -> Vec<Record> {
    let record = |item: &Recovered| match item {
        Recovered::Record(record) => Some(record.clone()),
        _ => None,
    };
    log.items.iter().filter_map(record).collect()
}

fn events(log: &Log) -> Vec<EventKind> {
    let kind = |record: Record| match record {
        Record::Event(Event { kind, .. }) => Some(kind),
        _ => None,
    };
    records(log).into_iter().filter_map(kind).collect()
}

#[test]
fn a_session_begins_with_what_it_runs_with_and_why() {
    let bench = bench_with_card();
    bench.last_words.replace(Some("it fell over".try_into().unwrap()));
    Body::start(&bench).live(1);
    let log = log_of(&bench);
    let Record::Header(header) = &records(&log)[0] else { panic!("{:?}", log.items) };
    assert_eq!((header.firmware_version.as_str(), &header.build_hash[..3]), ("0.1.0-test", &[0x5a, 0x5a, 0][..]));
    let panic = EventKind::Panic("it fell over".try_into().unwrap());
    assert_eq!(events(&log), [panic, EventKind::Reset(ResetCause::PowerOn)]);
    // Told once: the next session has nothing to say.
    Body::start(&bench).live(1);
    assert_eq!(events(&log_of(&bench)).len(), 3);
}

#[test]
fn epochs_reach_the_card_and_a_restart_leaves_none_behind() {
    let bench = bench_with_card();
    let mut body = Body::start(&bench);
    body.live(60);
    let safe = body.health.counts.get(Count::LogRecordsSafe);
    assert!((570..=602).contains(&safe), "{safe} records of a minute");
    assert!(body.health.log.sectors_left().is_some_and(|left| (3500..3600).contains(&left)));
    assert!(body.health.activity(false).logging && !body.health.activity(false).log_failing);
    body.health.ask_for_restart();
    body.live(1);
    assert!(bench.restarts.get() > 0);
    // Nothing is left over in a sector that is not full.
    let logged = log_of(&bench).epochs.len() as u32;
    assert!(logged + 2 >= body.health.tasks.epochs(), "{logged} of {}", body.health.tasks.epochs());
    assert_eq!(body.health.counts.get(Count::LogErrors), 0);
}

#[test]
fn a_card_that_is_not_there_is_looked_for_at_growing_pauses() {
    let bench = Bench::new();
    store(&bench, |_| ());
    let mut body = Body::start(&bench);
    body.live(30);
    assert_eq!(body.health.counts.get(Count::LogErrors), 6);
    assert!(body.health.activity(false).log_failing);
    assert_eq!(body.health.log.sectors_left(), None);
    // The queue holds 19 s; the rest is counted, and told in its place.
    let lost = body.health.counts.get(Count::RecordsLost);
    assert!((100..=120).contains(&lost), "{lost}");
    bench.card.replace(Some(fat16(8000)));
    body.live(10);
    assert!(body.health.activity(false).logging && !body.health.activity(false).log_failing);
    let log = log_of(&bench);
    let told: u32 =
        records(&log).iter().map(|record| if let Record::Loss(loss) = record { loss.epochs } else { 0 }).sum();
    assert_eq!(told, body.health.counts.get(Count::RecordsLost));
}

#[test]
fn a_card_that_takes_its_time_costs_records_that_the_log_tells_of() {
    let bench = bench_with_card();
    let mut body = Body::start(&bench);
    body.live(5);
    body.storage_waits = true;
    body.live(30);
    body.storage_waits = false;
    body.live(5);
    let lost = body.health.counts.get(Count::RecordsLost);
    assert!((100..=115).contains(&lost), "{lost}");
    let log = log_of(&bench);
    assert!(records(&log).iter().any(|record| matches!(record, Record::Loss(loss) if loss.epochs == lost)));
}

#[test]
fn a_card_that_fails_is_told_and_comes_back() {
    let bench = bench_with_card();
    let mut body = Body::start(&bench);
    body.live(10);
    let card = bench.card.take();
    body.live(5);
    assert!(body.health.activity(false).log_failing && body.health.counts.get(Count::LogErrors) > 0);
    bench.card.replace(card);
    body.live(5);
    assert!(!body.health.activity(false).log_failing);
    assert_eq!(body.health.counts.get(Count::RecordsLost), 0, "the queue has held them");
    body.health.ask_for_restart();
    body.live(1);
    let log = log_of(&bench);
    let ticks: Vec<u32> = log.epochs.keys().copied().collect();
    // The grid leaves out a tick when it finds the scalar sensor's phase at the start, and none later.
    assert!(ticks.windows(2).skip(5).all(|pair| pair[1] == pair[0] + 1), "{ticks:?}");
}

#[test]
fn nothing_is_logged_that_is_not_wanted() {
    let bench = bench_with_card();
    store(&bench, |stored| stored.settings.log = false);
    let mut body = Body::start(&bench);
    body.live(5);
    assert_eq!(bench.card.borrow().as_ref().unwrap().writes(), 0, "the card is not even looked at");
    assert!(!body.health.activity(false).log_failing);
}

#[test]
fn every_block_tells_the_watchdog_that_storage_is_at_work() {
    let bench = bench_with_card();
    let mut body = Body::start(&bench);
    bench.watch.set(Some(body.health));
    // These find no file, make one of an hour and mark all of its blocks.
    (0..8).for_each(|_| body.tasks.storage.run());
    assert!(bench.card.borrow().as_ref().unwrap().writes() > 7200);
}
