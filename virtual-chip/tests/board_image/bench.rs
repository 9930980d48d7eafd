//! The image on its chip, and what a test does with it: let it live, talk to it from the ship, cut its power.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex};
use towmag::log::{EpochRecord, Event, EventKind, Record, Recovered, SliceSource};
use towmag_virtual_body::body::Received;
use towmag_virtual_body::disk::Disk;
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::log::{open, read_file, scan, writer};
use towmag_virtual_body::sd::{Capacity, SdCard};
use towmag_virtual_chip::board::Board;
use towmag_virtual_chip::chip::{Chip, End};
use towmag_virtual_chip::image::Image;
use towmag_virtual_chip::peripherals::flash::Cells;
use towmag_virtual_chip::time::fs;
use towmag_virtual_chip::wires::converter::Converter;

/// The image.
pub(crate) static IMAGE: LazyLock<Image> = LazyLock::new(Image::load);

/// First address and size of every block of code that any test has run.
pub(crate) static SEEN: Mutex<BTreeMap<u32, u32>> = Mutex::new(BTreeMap::new());

/// The flash of a body whose log files are for an hour, as small cards have room for.
pub(crate) static SMALL_FILES: LazyLock<Cells> = LazyLock::new(|| {
    let mut body = Body::start(Board::default(), Cells::default());
    body.live(1.0);
    assert_eq!(body.answer("set log_file_h 1"), ["log_file_h = 1"]);
    assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
    body.cells()
});

/// What the scalar sensor reads at first, picotesla, and by how much more each time.
pub(crate) const FIRST_PT: i32 = 49_800_000;
pub(crate) const STEP_PT: i32 = 1_000;

/// What the converter's channels read.
pub(crate) const COUNTS: [i32; 4] = [1_000_000, -500_000, 3_000_000, 20_000];

/// Something in each second, from the ship's end: UART and its place among the lines.
const SCALAR: usize = 0;
const SHIP: usize = 1;

/// How long an answer is waited for, and a pause that ends it.
const ANSWER_STEPS: usize = 12;
const ANSWER_STEP_S: f64 = 0.5;

/// Blocks of a log file for an hour: each second has a sector, twice.
const HOUR_BLOCKS: u32 = 7_200;

/// The tow cable's rate.
const CABLE_BAUD: f64 = 115_200.0;

/// A board with everything on it but a card.
pub(crate) fn sensors() -> Board {
    let mut board = Board { converter: Some(Converter::new(|_| COUNTS)), ..Board::default() };
    board.lines[SCALAR].talk(fs(0.02), fs(0.1), |count| {
        let pt = FIRST_PT + count as i32 * STEP_PT;
        format!("$ {}.{:03},1249\r\n", pt / 1_000, pt % 1_000).into_bytes()
    });
    board
}

/// The same with this card.
pub(crate) fn sensors_and(disk: Disk) -> Board {
    Board { card: Some(SdCard::new(disk, Capacity::High)), ..sensors() }
}

/// A card with an empty file for an hour of log on it.
pub(crate) fn prepared() -> Disk {
    let disk = fat16(8_000);
    let map = open(&disk, HOUR_BLOCKS, 7).expect("the card has room");
    _ = writer(&disk, map, 0);
    disk
}

/// What was logged, in its order.
pub(crate) fn logged(disk: &Disk) -> Vec<Recovered> {
    let bytes = read_file(disk, "TOWMAG01.BIN").expect("a file of the log");
    let (survey, _, items) = scan(&mut SliceSource(&bytes));
    assert_eq!(survey.damaged, 0);
    items
}

/// The epochs of the log, of all sessions.
pub(crate) fn epochs(disk: &Disk) -> Vec<EpochRecord> {
    let epoch = |item| match item {
        Recovered::Record(Record::Epoch(epoch)) => Some(epoch),
        _ => None,
    };
    logged(disk).into_iter().filter_map(epoch).collect()
}

/// What the log tells besides.
pub(crate) fn events(disk: &Disk) -> Vec<EventKind> {
    let kind = |item| match item {
        Recovered::Record(Record::Event(Event { kind, .. })) => Some(kind),
        _ => None,
    };
    logged(disk).into_iter().filter_map(kind).collect()
}

/// A counter of the answer to `status`.
pub(crate) fn fault(status: &[String], name: &str) -> u32 {
    let count = |line: &String| line.strip_prefix("fault: ")?.strip_prefix(name)?.trim().parse().ok();
    status.iter().find_map(count).unwrap_or(0)
}

/// A body that runs.
pub(crate) struct Body {
    pub(crate) chip: Chip<'static>,
    heard: usize,
}

impl Body {
    /// Power comes.
    pub(crate) fn start(board: Board, cells: Cells) -> Self {
        Self { chip: Chip::power_on(&IMAGE, board, cells), heard: 0 }
    }

    /// Let it live for so many seconds.
    pub(crate) fn live(&mut self, seconds: f64) -> End {
        self.chip.run(seconds)
    }

    /// What has come up the cable since the last call; what was sent with a wrong rate is not understood.
    pub(crate) fn received(&mut self) -> Received {
        let sent = &self.chip.bus().usarts[SHIP].sent;
        let new = sent[self.heard..].iter().filter(|sent| (sent.baud / CABLE_BAUD - 1.0).abs() < 0.04);
        let received = Received::of(new.map(|sent| sent.byte));
        self.heard = sent.len();
        received
    }

    /// By how much the rate of the latest byte up the cable is off, parts of one.
    pub(crate) fn baud_error(&self) -> f64 {
        let sent = self.chip.bus().usarts[SHIP].sent.last().expect("something was sent");
        sent.baud / CABLE_BAUD - 1.0
    }

    /// The ship sends something.
    pub(crate) fn send(&mut self, text: &str) {
        let now_fs = self.chip.machine().now_fs;
        self.chip.bus_mut().line(SHIP).send(now_fs, text.as_bytes());
        self.chip.replan();
    }

    /// A line to the console, and what it answers: it may erase a sector of the flash before it does.
    pub(crate) fn answer(&mut self, line: &str) -> Vec<String> {
        self.received();
        self.send(&format!("{line}\r"));
        let mut texts = Vec::new();
        for _ in 0..ANSWER_STEPS {
            self.live(ANSWER_STEP_S);
            let new = self.received().texts;
            let is_over = new.is_empty() && !texts.is_empty();
            texts.extend(new);
            if is_over {
                break;
            }
        }
        texts
    }

    /// The card's content.
    pub(crate) fn disk(&self) -> &Disk {
        &self.chip.bus().card.as_ref().expect("a card is in the socket").disk
    }

    /// The converter.
    pub(crate) fn converter(&mut self) -> &mut Converter {
        self.chip.bus_mut().converter.as_mut().expect("there is a converter")
    }

    /// The crystal stops swinging.
    pub(crate) fn stop_crystal(&mut self) {
        let now_fs = self.chip.machine().now_fs;
        self.chip.bus_mut().stop_crystal(now_fs);
        self.chip.replan();
    }

    /// What stays in the flash without power.
    pub(crate) fn cells(&self) -> Cells {
        self.chip.bus().flash.cells.clone()
    }

    /// The power goes.
    pub(crate) fn off(mut self) -> (Board, Cells) {
        let chip = &mut self.chip;
        note(chip);
        chip.power_off()
    }
}

impl Drop for Body {
    fn drop(&mut self) {
        note(&self.chip);
    }
}

/// Remember what has run.
fn note(chip: &Chip<'_>) {
    let mut seen = SEEN.lock().expect("no test has panicked in here");
    for (address, size) in chip.machine().blocks.seen() {
        let known = seen.entry(address).or_default();
        *known = size.max(*known);
    }
}
