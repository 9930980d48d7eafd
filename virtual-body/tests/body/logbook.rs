//! The log on cards that fail, fill up, fall apart or get swapped.

use embedded_sdmmc::{Mode, VolumeIdx, VolumeManager};
use towmag::log::{
    AppendError, BLOCK_LEN, Event, EventKind, FileMap, Loss, Record, RecordConsumer, RecordProducer, RecordQueue,
    Recovered, Sector, SliceSource, VolumeError, blank_block,
};
use towmag_virtual_body::disk::{Disk, Failure, Shared};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::log::{
    NoDate, Writer, epoch, header, open, read_file, recover, recover_file, recover_image, writer,
};
use towmag_virtual_body::rng::Rng;

const FILE: &str = "TOWMAG01.BIN";

fn card() -> (Disk, FileMap) {
    let disk = fat16(4100);
    let map = open(&disk, 600, 5).unwrap();
    (disk, map)
}

fn append(log: &mut Writer<'_>, ticks: std::ops::Range<u32>) {
    ticks.for_each(|tick| log.append(&epoch(tick)).unwrap());
}

fn events(items: &[Recovered]) -> Vec<EventKind> {
    let kind = |item: &Recovered| match item {
        Recovered::Record(Record::Event(event)) => Some(event.kind.clone()),
        _ => None,
    };
    items.iter().filter_map(kind).collect()
}

#[test]
fn ten_epochs_fill_a_sector() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    let before = disk.writes();
    append(&mut log, 0..1001);
    assert_eq!(disk.writes() - before, 200, "two block writes per sector and no other");
    assert_eq!((log.durable().records, log.durable().sectors, log.durable().last_tick), (1000, 100, Some(999)));
    assert_eq!((log.taken(), log.blocks_left()), (1001, 199));
}

#[test]
fn nothing_is_durable_before_its_sector_is() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..10);
    assert_eq!(log.durable().records, 0);
    log.flush().unwrap();
    assert_eq!(log.durable().records, 10);
    log.flush().unwrap();
    assert_eq!(log.durable().sectors, 1, "nothing to flush");
}

#[test]
fn a_laptop_reads_the_file() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    log.append(&header(0)).unwrap();
    append(&mut log, 0..100);
    log.flush().unwrap();
    let bytes = read_file(&disk, FILE).unwrap();
    assert_eq!(bytes.len(), 600 * BLOCK_LEN);
    let found = recover(&mut SliceSource(&bytes));
    assert_eq!(found.items[1], Recovered::Record(header(0)));
    found.assert_has(0..100, "file");
    // A dump that starts anywhere.
    recover(&mut SliceSource::aligned_to_sectors(&bytes[300..])).assert_has(0..100, "cut dump");
}

#[test]
fn sessions_follow_each_other() {
    let (disk, map) = card();
    for session in 0..20 {
        let mut log = writer(&disk, map, 1000 - session);
        append(&mut log, session * 100..session * 100 + 55);
        log.flush().unwrap();
    }
    let found = recover_file(&disk, FILE).unwrap();
    let ticks: Vec<u32> = found.epochs.keys().copied().collect();
    let in_order = found.items.iter().filter_map(|item| match item {
        Recovered::Record(record) => Some(record.tick()),
        _ => None,
    });
    assert!(in_order.eq(ticks), "in the order of writing");
    assert_eq!(found.epochs.len(), 20 * 55);
}

#[test]
fn bad_blocks_are_left_out_and_recorded() {
    for failure in
        [Failure::Refuses, Failure::WritesAndComplains, Failure::Ignores, Failure::FlipsBit, Failure::Unreadable]
    {
        let (disk, map) = card();
        // Good when they were marked.
        _ = writer(&disk, map, 0);
        for position in [0, 10, 11, 12, 40] {
            disk.fail(map.locate(position).unwrap(), failure);
        }
        let mut log = writer(&disk, map, 1);
        append(&mut log, 0..500);
        log.flush().unwrap();
        assert_eq!(log.durable().records, 500, "{failure:?}");
        let found = recover_image(&disk);
        found.assert_has(0..500, &format!("{failure:?}"));
        let bad = |first_position, blocks| EventKind::BadBlocks { first_position, blocks };
        assert_eq!(events(&found.items), [bad(0, 1), bad(10, 3), bad(40, 1)], "{failure:?}");
        disk.heal();
        let mut log = writer(&disk, map, 2);
        append(&mut log, 500..1000);
        log.flush().unwrap();
        let healed = recover_image(&disk);
        healed.assert_has(0..1000, &format!("{failure:?}, healed"));
        assert!(!healed.items.iter().any(|item| matches!(item, Recovered::Missing { .. })), "{failure:?}");
    }
}

#[test]
fn a_dead_card_loses_nothing_that_was_taken() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..10);
    for position in 0..map.places() {
        disk.fail(map.locate(position).unwrap(), Failure::WritesAndComplains);
    }
    for _ in 0..3 {
        assert!(matches!(log.append(&epoch(10)), Err(AppendError::Device(_))));
    }
    assert_eq!(log.durable().records, 0, "nobody was told");
    disk.heal();
    append(&mut log, 10..30);
    log.flush().unwrap();
    assert_eq!(log.durable().records, 30);
    let found = recover_image(&disk);
    found.assert_has(0..30, "after the card came back");
    assert!(found.survey.duplicates > 0, "the complaints were wrong");
}

#[test]
fn a_failed_sync_is_not_an_acknowledgement() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    disk.fail_next_syncs(8);
    append(&mut log, 0..10);
    assert!(log.flush().is_err());
    assert_eq!(log.durable().records, 0);
    // More of the same sector: the copies of it grow, and the longest must win.
    log.flush().unwrap();
    assert_eq!(log.durable().records, 10);
    recover_image(&disk).assert_has(0..10, "after the syncs");
}

#[test]
fn of_two_copies_the_longer_one_counts() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..4);
    disk.fail_next_syncs(8);
    assert!(log.flush().is_err());
    append(&mut log, 4..9);
    log.flush().unwrap();
    let found = recover_image(&disk);
    assert_eq!(found.survey.duplicates, 9, "the first copies of eight attempts, and the second of the last");
    found.assert_has(0..9, "grown sector");
}

#[test]
fn a_full_region_says_so_and_the_next_file_follows() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    let mut tick = 0;
    let error = loop {
        match log.append(&epoch(tick)) {
            Ok(()) => tick += 1,
            Err(error) => break error,
        }
    };
    assert_eq!(error, AppendError::Full);
    assert_eq!((log.durable().records, tick), (2990, 3000), "299 sectors, and one that has no place");
    assert_eq!(log.append(&epoch(tick)), Err(AppendError::Full));
    let second = open(&disk, 600, 6).unwrap();
    assert_eq!(second.region().file_number, 2);
    let mut log = writer(&disk, second, 2);
    append(&mut log, 2990..3500);
    log.flush().unwrap();
    recover_image(&disk).assert_has(0..3500, "both files");
    recover_file(&disk, "TOWMAG02.BIN").unwrap().assert_has(2990..3500, "the second file");
    assert_eq!(open(&disk, 600, 7).unwrap().region().file_number, 2, "it has room");
}

#[test]
fn a_full_card_gives_what_it_has() {
    let disk = fat16(4100);
    let map = open(&disk, 1_000_000, 5).unwrap();
    assert!((4000..=4100).contains(&map.file_blocks()), "{}", map.file_blocks());
    let last = map.places() - 1;
    let mut log = writer(&disk, map, 1);
    while log.append(&epoch(log.taken())).is_ok() {}
    assert_eq!(log.durable().sectors, last + 1);
    recover_image(&disk).assert_has(0..log.durable().records, "full card");
    assert!(matches!(open(&disk, 600, 6), Err(VolumeError::NoSpace)));
    recover_image(&disk).assert_has(0..log.durable().records, "after the refusal");
}

/// Files of a few blocks each, every second one deleted.
fn fragment(disk: &Disk, files: u32) {
    let manager: VolumeManager<Shared<'_>, NoDate, 1, 1, 1> = VolumeManager::new_with_limits(Shared(disk), NoDate, 1);
    let volume = manager.open_volume(VolumeIdx(0)).unwrap();
    let root = volume.open_root_dir().unwrap();
    for i in 0..files {
        let file = root.open_file_in_dir(format!("F{i}.DAT").as_str(), Mode::ReadWriteCreate).unwrap();
        file.write(&[0x33; 40 * BLOCK_LEN]).unwrap();
        file.close().unwrap();
    }
    for i in (0..files).step_by(2) {
        // Deleting alone keeps the clusters; truncating frees all but one.
        let name = format!("F{i}.DAT");
        root.open_file_in_dir(name.as_str(), Mode::ReadWriteTruncate).unwrap().close().unwrap();
    }
}

#[test]
fn a_fragmented_card_keeps_its_files() {
    let disk = fat16(4100);
    fragment(&disk, 20);
    let map = open(&disk, 600, 5).unwrap();
    assert_eq!(map.file_blocks(), 600, "behind the pieces there is room");
    assert_eq!(open(&disk, 600, 6).unwrap(), map, "the same when it is opened again");
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..2000);
    log.flush().unwrap();
    recover_file(&disk, FILE).unwrap().assert_has(0..2000, "through the file system");
    recover_image(&disk).assert_has(0..2000, "image");
    for i in (1..20).step_by(2) {
        let other = read_file(&disk, &format!("F{i}.DAT")).unwrap();
        assert!(other.iter().all(|&byte| byte == 0x33), "file {i}");
    }
}

/// The card is swapped under a writer that knows where it would go on.
#[test]
fn another_card_is_not_written_to() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..100);
    (20..4000).for_each(|index| disk.set_block(index, [0x77; BLOCK_LEN]));
    let before = disk.image();
    for tick in 100..200 {
        let _ = log.append(&epoch(tick));
    }
    assert_eq!(log.flush(), Err(AppendError::Full));
    assert!(disk.image() == before, "not one block");
}

/// A card that has forgotten a long stretch of writes: the end is looked for in the wrong place, and nothing behind
/// the hole is written over.
#[test]
fn a_long_hole_is_filled_and_what_lies_behind_it_is_kept() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..2500);
    log.flush().unwrap();
    for position in 100..200 {
        for position in [position, position + map.places()] {
            disk.set_block(map.locate(position).unwrap(), blank_block(map.region(), position));
        }
    }
    let mut log = writer(&disk, map, 2);
    assert!(log.blocks_left() > 100, "in the hole: {}", log.blocks_left());
    append(&mut log, 3000..4200);
    log.flush().unwrap();
    let found = recover_image(&disk);
    found.assert_has((0..1000).chain(2000..2500).chain(3000..4200), "around and in the hole");
}

/// Whatever is destroyed, a later session neither overwrites what is left nor fails to find room.
#[test]
fn any_damage_leaves_the_rest() {
    let mut rng = Rng(99);
    for round in 0..60 {
        let (disk, map) = card();
        let mut log = writer(&disk, map, 1);
        append(&mut log, 0..10 * (1 + rng.below(200) as u32));
        log.flush().unwrap();
        for _ in 0..rng.below(60) {
            let position = rng.below(u64::from(map.places())) as u32;
            let junk = [0x00, 0xFF, rng.draw() as u8][rng.below(3) as usize];
            disk.set_block(map.locate(position).unwrap(), [junk; BLOCK_LEN]);
        }
        let left: Vec<u32> = recover_image(&disk).epochs.into_keys().collect();
        let mut log = writer(&disk, map, 2);
        let mut tick = 100_000;
        while tick < 100_200 && log.append(&epoch(tick)).is_ok() {
            tick += 1;
        }
        let durable = log.durable().records;
        let found = recover_image(&disk);
        found.assert_has(left, &format!("round {round}"));
        found.assert_has(100_000..100_000 + durable, &format!("round {round}"));
    }
}

#[test]
fn finding_the_end_reads_a_bounded_number_of_blocks() {
    let disk = fat16(60_000);
    let map = open(&disk, 50_000, 5).unwrap();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..3000);
    disk.reads.set(0);
    let log = writer(&disk, map, 2);
    assert_eq!(map.places() - log.blocks_left(), 299);
    assert!(disk.reads.get() <= 4 * 17 * 32, "{}", disk.reads.get());
}

#[test]
fn arbitrary_blocks_never_panic() {
    let mut rng = Rng(4);
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    append(&mut log, 0..10);
    log.flush().unwrap();
    let whole = disk.block(map.locate(0).unwrap());
    for _ in 0..20_000 {
        let mut block = whole;
        for _ in 0..1 + rng.below(4) {
            block[rng.below(512) as usize] = rng.draw() as u8;
        }
        if block != whole {
            assert!(Sector::parse(&block).is_err());
        }
    }
    let image: Vec<u8> = (0..64 * BLOCK_LEN).map(|_| rng.draw() as u8).collect();
    assert!(recover(&mut SliceSource(&image)).items.is_empty());
}

#[test]
fn the_queue_holds_nineteen_seconds_and_counts_the_rest() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    let mut queue = RecordQueue::new();
    let (producer, consumer) = queue.split();
    let (mut producer, mut consumer) = (RecordProducer::new(producer), RecordConsumer::new(consumer));
    let queued = (0..200).filter(|&tick| producer.push(&epoch(tick))).count();
    assert_eq!((queued, producer.dropped()), (191, 9));
    assert!(!producer.push(&Record::Event(Event { tick: 200, kind: EventKind::LogStop })));
    assert_eq!(consumer.drain(&mut log), Ok(191));
    (201..211).for_each(|tick| assert!(producer.push(&epoch(tick))));
    assert_eq!(consumer.drain(&mut log), Ok(11), "and the loss record");
    log.flush().unwrap();
    let found = recover_image(&disk);
    found.assert_has((0..191).chain(201..211), "queue");
    let loss = Recovered::Record(Record::Loss(Loss { first_tick: 191, epochs: 9, others: 1 }));
    let at = found.items.iter().position(|item| *item == loss).expect("a loss record");
    assert_eq!(found.items[at + 1], Recovered::Record(epoch(201)), "in the place of the gap");
}

#[test]
fn a_card_that_stalls_keeps_the_queue() {
    let (disk, map) = card();
    let mut log = writer(&disk, map, 1);
    let mut queue = RecordQueue::new();
    let (producer, consumer) = queue.split();
    let (mut producer, mut consumer) = (RecordProducer::new(producer), RecordConsumer::new(consumer));
    (0..40).for_each(|tick| assert!(producer.push(&epoch(tick))));
    for position in 0..map.places() {
        disk.fail(map.locate(position).unwrap(), Failure::Refuses);
    }
    assert!(consumer.drain(&mut log).is_err());
    disk.heal();
    consumer.drain(&mut log).unwrap();
    log.flush().unwrap();
    recover_image(&disk).assert_has(0..40, "stalled card");
}

#[test]
fn a_copied_file_is_left_alone() {
    let (disk, map) = card();
    // The first block of the file says where the file lies; elsewhere it is a lie.
    let manager: VolumeManager<Shared<'_>, NoDate, 1, 1, 1> = VolumeManager::new_with_limits(Shared(&disk), NoDate, 1);
    let bytes = read_file(&disk, FILE).unwrap();
    {
        let volume = manager.open_volume(VolumeIdx(0)).unwrap();
        let root = volume.open_root_dir().unwrap();
        root.delete_entry_in_dir(FILE).unwrap();
        let copy = root.open_file_in_dir(FILE, Mode::ReadWriteCreate).unwrap();
        copy.write(&bytes).unwrap();
        copy.close().unwrap();
    }
    let next = open(&disk, 600, 6).unwrap();
    assert_eq!(next.region().file_number, 2);
    assert_ne!(next.first_block(), map.first_block());
    assert_eq!(next.places(), 299);
}
