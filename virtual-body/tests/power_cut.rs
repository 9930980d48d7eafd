//! The power goes at every single block write, up to three times in a run, and nothing acknowledged is ever lost.

use towmag_virtual_body::disk::{CUTS, Cut, Disk, LYING_WINDOW};
use towmag_virtual_body::fat::{fat16, fat32};
use towmag_virtual_body::log::{epoch, header, open, recover_file, recover_image, writer};
use towmag_virtual_body::rng::Rng;

const FILE: &str = "TOWMAG01.BIN";
const RECORDS: u32 = 1000;
/// Of the session that is not cut.
const LAST_RECORDS: u32 = 100;
const FILE_BLOCKS: u32 = 600;

/// Ticks that a run was told are safe, and how many ticks it has handed out.
#[derive(Clone, Debug, Default)]
struct Told {
    safe: Vec<u32>,
    next_tick: u32,
}

/// One start of the firmware: mount, go on, write until the records are through or the power goes. Flushes now and
/// then, as the firmware does when the operator asks for it.
fn session(disk: &Disk, told: &mut Told, session: u32, records: u32) {
    let Ok(map) = open(disk, FILE_BLOCKS, 77) else { return };
    let mut log = writer(disk, map, session);
    let first = told.next_tick;
    let mut appended = log.append(&header(first)).is_ok();
    while appended && told.next_tick < first + records {
        let tick = told.next_tick;
        told.next_tick += 1;
        appended = log.append(&epoch(tick)).is_ok() && (!tick.is_multiple_of(137) || log.flush().is_ok());
    }
    let flushed = appended && log.flush().is_ok();
    assert!(flushed || !disk.is_on(), "the writer gave up with the power on");
    // The header is the first record of the session.
    told.safe.extend(first..first + log.durable().records.saturating_sub(1));
}

/// What must hold after each cut, on the bare card and through the file system. A lying card may lose what it had in
/// its cache at the cut, and nothing else.
fn check(disk: &Disk, told: &mut Told, mode: Cut, context: &str) {
    let image = recover_image(disk);
    let file = recover_file(disk, FILE).unwrap_or_else(|| panic!("{context}: the file cannot be read"));
    if mode == Cut::Lying {
        let before = told.safe.len();
        told.safe.retain(|tick| image.epochs.contains_key(tick));
        assert!(before - told.safe.len() <= LYING_WINDOW * 10, "{context}: {} lost", before - told.safe.len());
    }
    for log in [&image, &file] {
        log.assert_true(context);
        log.assert_has(told.safe.iter().copied(), context);
    }
    assert_eq!(image.epochs.len(), file.epochs.len(), "{context}");
    assert!(image.survey.damaged <= 3 * LYING_WINDOW, "{context}: {:?}", image.survey);
}

/// A card with an empty log file, and the block writes of a whole session on it.
fn prepared() -> (Disk, u64) {
    let disk = fat16(4100);
    open(&disk, FILE_BLOCKS, 77).unwrap();
    disk.power_on();
    let trial = disk.clone();
    session(&trial, &mut Told::default(), 1, RECORDS);
    (disk.clone(), trial.writes() - disk.writes())
}

/// Sessions with a cut each, then one without.
fn run(disk: &Disk, cuts: &[u64], mode: Cut, seed: u64) {
    let disk = disk.clone();
    let mut told = Told::default();
    for (i, &cut) in cuts.iter().enumerate() {
        disk.cut_after(cut, mode, seed + i as u64);
        session(&disk, &mut told, 100 + i as u32, RECORDS);
        disk.power_on();
        check(&disk, &mut told, mode, &format!("{mode:?}, cuts {cuts:?}, after number {i}, seed {seed}"));
    }
    let before = told.safe.len();
    session(&disk, &mut told, 200, LAST_RECORDS);
    assert_eq!(told.safe.len() - before, LAST_RECORDS as usize, "{mode:?} {cuts:?}: the last session was not cut");
    check(&disk, &mut told, Cut::Whole, &format!("{mode:?}, cuts {cuts:?}, at the end, seed {seed}"));
}

#[test]
fn one_cut_at_every_block_write() {
    let (disk, writes) = prepared();
    for mode in CUTS {
        for cut in 0..writes {
            run(&disk, &[cut], mode, cut);
        }
    }
    println!("{} cuts: {} block writes, {} modes", writes * CUTS.len() as u64, writes, CUTS.len());
    assert!(writes >= u64::from(RECORDS) / 10, "{writes}");
}

#[test]
fn two_and_three_cuts() {
    let (disk, writes) = prepared();
    let mut rng = Rng(2024);
    let mut runs = 0;
    for mode in CUTS {
        // The second cut matters most when it follows soon: it meets what the first has left.
        for first in (0..writes).step_by(24) {
            for second in [0, 1, 3] {
                run(&disk, &[first, second], mode, rng.next() >> 8);
                run(&disk, &[first, second, rng.below(4)], mode, rng.next() >> 8);
                runs += 2;
            }
        }
        for _ in 0..20 {
            let cuts = [rng.below(writes), rng.below(writes), rng.below(writes)];
            run(&disk, &cuts, mode, rng.next() >> 8);
            runs += 1;
        }
    }
    println!("{runs} runs of two or three cuts");
}

/// Cuts while the second file is being made. A log that lies on the card already must survive it in the blocks; what
/// a torn FAT or directory block does to the file system is beyond us.
fn cut_while_creating(empty: &Disk, modes: &[Cut], step: usize) -> u64 {
    const BLOCKS: u32 = 120;
    let full = empty.clone();
    let map = open(&full, BLOCKS, 1).unwrap();
    let mut log = writer(&full, map, 7);
    let mut tick = 0;
    while log.append(&epoch(tick)).is_ok() {
        tick += 1;
    }
    let safe = log.durable().records;
    full.power_on();
    let trial = full.clone();
    assert_eq!(open(&trial, BLOCKS, 2).unwrap().region().file_number, 2);
    let writes = trial.writes() - full.writes();
    for &mode in modes {
        for cut in (0..writes).step_by(step) {
            let disk = full.clone();
            disk.cut_after(cut, mode, cut);
            assert!(open(&disk, BLOCKS, 2).is_err(), "{mode:?} {cut}");
            disk.power_on();
            let context = format!("{mode:?}, cut {cut} of the creation");
            let mut safe_now: Vec<u32> = (0..safe).collect();
            // The next start makes a file, or says that it cannot; it never harms the log.
            if let Ok(map) = open(&disk, BLOCKS, 3) {
                let mut log = writer(&disk, map, 8);
                for tick in 10_000..10_100 {
                    log.append(&epoch(tick)).unwrap();
                }
                log.flush().unwrap();
                safe_now.extend(10_000..10_100);
            }
            recover_image(&disk).assert_has(safe_now, &context);
        }
    }
    writes
}

#[test]
fn cut_at_every_block_write_of_a_new_file() {
    // The others differ from these in a part of a block.
    const MODES: [Cut; 4] = [Cut::Whole, Cut::TornErased, Cut::TornZero, Cut::Reordered];
    let writes = cut_while_creating(&fat16(4100), &MODES, 1);
    println!("{} cuts while creating on FAT16", writes * MODES.len() as u64);
}

#[test]
fn cut_at_some_block_writes_of_a_new_file_on_fat32() {
    let writes = cut_while_creating(&fat32(), &[Cut::TornZero, Cut::Reordered], 29);
    println!("{} cuts while creating on FAT32", writes.div_ceil(29) * 2);
}
