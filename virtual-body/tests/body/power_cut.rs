//! The power goes at every single block write of a body's life: while it makes its first file, marks and logs, makes the
//! next and changes to it, and again while it starts anew. Afterwards the body always logs, and nothing acknowledged is lost.

use std::collections::BTreeSet;
use std::ops::Range;
use towmag_virtual_body::deck::{Deck, Moment};
use towmag_virtual_body::disk::{CUTS, Cut, Disk, LYING_WINDOW};
use towmag_virtual_body::fat::{Layout, fat16_of, fat32_of, leave_runs};
use towmag_virtual_body::log::recover_image;

/// Free runs of the card, one a file, and their size.
const RUNS: usize = 12;
const RUN_BLOCKS: usize = 256;

/// Epochs of a session after a cut that are safe before the next one, and how long that may take: 9 s.
const EPOCHS_AFTER: usize = 15;
const MOST_STEPS: u32 = 90;

/// Writes of a session at which the power may go again.
const MOST_MOMENTS: usize = 1_200;

/// A lying card loses what it held: so many blocks, of ten epochs each at most.
const MOST_LIED: usize = 10 * LYING_WINDOW;

fn card(cluster_blocks: usize, layout: Layout) -> Disk {
    let disk = fat16_of(4_100, cluster_blocks, layout);
    leave_runs(&disk, RUNS, RUN_BLOCKS / cluster_blocks);
    disk
}

/// What a body does on a fresh card, until it has been in two files: the card at every write.
fn life(card: &Disk, mode: Cut) -> Vec<Moment> {
    let disk = card.clone();
    disk.set_mode(mode, 1);
    let mut deck = Deck::start(disk, 0, usize::MAX);
    while deck.files() < 2 {
        deck.step();
    }
    (0..30).for_each(|_| deck.step());
    deck.moments.take()
}

/// What has come of a card, and what it must hold.
#[derive(Clone)]
struct After {
    disk: Disk,
    safe: Vec<Range<u32>>,
}

/// The states that were tried, and the records that lying cards lost.
#[derive(Default)]
struct Tried {
    states: BTreeSet<u64>,
    cuts: u32,
    most_lied: usize,
}

impl Tried {
    /// The power goes at this moment.
    fn cut(&mut self, moment: &Moment, before: &[Range<u32>], mode: Cut, seed: u64) -> After {
        let disk = moment.disk.clone();
        disk.set_seed(seed);
        disk.cut_now(moment.index, &moment.new);
        self.states.insert(disk.hash());
        self.cuts += 1;
        let safe = before.iter().cloned().chain([moment.safe.clone()]).collect();
        self.check(After { disk, safe }, mode, seed)
    }

    /// Everything acknowledged is there, and is what was written; what a lying card has lost is forgotten.
    fn check(&mut self, mut after: After, mode: Cut, seed: u64) -> After {
        let context = format!("{mode:?}, cut {seed}");
        let log = recover_image(&after.disk);
        log.assert_true(&context);
        if mode == Cut::Lying {
            let is_there = |tick: &u32| log.epochs.contains_key(tick);
            let missing = after.safe.iter().cloned().flatten().filter(|tick| !is_there(tick)).count();
            self.most_lied = self.most_lied.max(missing);
            assert!(missing <= MOST_LIED, "{context}: {missing} lost");
            after.safe = after.safe.into_iter().flatten().filter(is_there).map(|tick| tick..tick + 1).collect();
        }
        log.assert_has(after.safe.iter().cloned().flatten(), &context);
        after
    }

    /// The body starts anew, and logs.
    fn live(&mut self, after: &After, first_tick: u32, mode: Cut, seed: u64) -> Vec<Moment> {
        let disk = after.disk.clone();
        disk.set_mode(mode, seed);
        let mut deck = Deck::start(disk, first_tick, MOST_MOMENTS);
        let mut steps = 0;
        while deck.safe().len() < EPOCHS_AFTER {
            deck.step();
            steps += 1;
            assert!(steps < MOST_STEPS, "{mode:?}, cut {seed}: the body does not log");
        }
        let safe = deck.safe();
        let safe = after.safe.iter().cloned().chain([safe]).collect();
        self.check(After { disk: (*deck.disk).clone(), safe }, Cut::Whole, seed);
        deck.moments.take()
    }

    /// A cut at every `step`th write of a life, and at every `again`th cut a second one at each `step`th write after it.
    fn every(&mut self, card: &Disk, mode: Cut, step: usize, again: Option<usize>) -> usize {
        let moments = life(card, mode);
        for (number, moment) in moments.iter().enumerate().step_by(step) {
            let after = self.cut(moment, &[], mode, number as u64);
            let moments = self.live(&after, 1_000_000, mode, number as u64);
            if again.is_none_or(|again| number % again != 0) {
                continue;
            }
            for (second, moment) in moments.iter().enumerate().step_by(step) {
                let seed = (number * 10_000 + second) as u64;
                let after = self.cut(moment, &after.safe, mode, seed);
                self.live(&after, 2_000_000, mode, seed);
            }
        }
        moments.len()
    }

    fn print(&self, what: &str) {
        let Self { states, cuts, most_lied } = self;
        println!(
            "{what}: {cuts} cuts, {} distinct states; a lying card lost {most_lied} records at most",
            states.len()
        );
    }
}

#[test]
fn one_cut_at_every_write_in_clusters_of_one_block() {
    let mut tried = Tried::default();
    let card = card(1, Layout::Aligned);
    let writes = CUTS.map(|mode| tried.every(&card, mode, 1, None));
    tried.print(&format!("{} writes of a life, clusters of 1 block", writes[0]));
}

#[test]
fn one_cut_at_every_third_write_in_clusters_of_64_blocks() {
    let mut tried = Tried::default();
    let card = card(64, Layout::Aligned);
    let writes = CUTS.map(|mode| tried.every(&card, mode, 3, None));
    tried.print(&format!("{} writes of a life, clusters of 64 blocks", writes[0]));
}

#[test]
fn two_cuts() {
    let mut tried = Tried::default();
    let card = card(1, Layout::Aligned);
    for mode in CUTS {
        tried.every(&card, mode, 7, Some(7 * 23));
    }
    tried.print("two cuts");
}

/// `cargo test --release -p towmag-virtual-body --test body power_cut -- --ignored --nocapture`
#[test]
#[ignore = "takes minutes: every pair of cuts of which the first is one of eleven"]
fn two_cuts_at_every_write() {
    for cluster_blocks in [1, 64] {
        let mut tried = Tried::default();
        let card = card(cluster_blocks, Layout::Aligned);
        for mode in CUTS {
            tried.every(&card, mode, 1, Some(11));
        }
        tried.print(&format!("two cuts, clusters of {cluster_blocks}"));
    }
}

#[test]
fn cuts_while_a_file_is_made_on_fat32() {
    let mut tried = Tried::default();
    let disk = fat32_of(Layout::Aligned);
    for mode in CUTS {
        // Tables, first block and directory; then the first markers.
        let disk = disk.clone();
        disk.set_mode(mode, 1);
        let mut deck = Deck::start(disk, 0, MOST_MOMENTS);
        while deck.safe().is_empty() {
            deck.step();
        }
        for (number, moment) in deck.moments.take().iter().enumerate().step_by(53) {
            let after = tried.cut(moment, &[], mode, number as u64);
            tried.live(&after, 1_000_000, mode, number as u64);
        }
    }
    tried.print("FAT32");
}
