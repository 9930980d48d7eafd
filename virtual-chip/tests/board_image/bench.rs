//! The image on its chip, and what a test does with it: let it live, talk to it from the ship, cut its power.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex};
use towmag_virtual_body::body::Received;
use towmag_virtual_body::disk::Disk;
use towmag_virtual_body::sd::{Capacity, SdCard};
use towmag_virtual_chip::board::Board;
use towmag_virtual_chip::chip::{Chip, End};
use towmag_virtual_chip::image::Image;
use towmag_virtual_chip::peripherals::flash::Cells;
use towmag_virtual_chip::time::fs;
use towmag_virtual_chip::wires::converter::Converter;

/// The image.
pub static IMAGE: LazyLock<Image> = LazyLock::new(Image::load);

/// First address and size of every block of code that any test has run.
pub static SEEN: Mutex<BTreeMap<u32, u32>> = Mutex::new(BTreeMap::new());

/// The flash of a body whose log files are for an hour, as small cards have room for.
pub static SMALL_FILES: LazyLock<Cells> = LazyLock::new(|| {
    let mut body = Body::start(Board::default(), Cells::default());
    body.live(1.0);
    assert_eq!(body.answer("set log_file_h 1"), ["log_file_h = 1"]);
    assert_eq!(body.answer("save"), ["saved: holds from the next start, log at once"]);
    println!("{} ops, t {}", body.chip.bus().flash.operations, body.chip.machine().now_fs as f64*1e-15);
    body.cells()
});

/// What the scalar sensor reads at first, picotesla, and by how much more each time.
pub const FIRST_PT: i32 = 49_800_000;
pub const STEP_PT: i32 = 1_000;

/// What the converter's channels read.
const COUNTS: [i32; 4] = [1_000_000, -500_000, 3_000_000, 20_000];

/// Something in each second, from the ship's end: UART and its place among the lines.
const SCALAR: usize = 0;
const SHIP: usize = 1;

/// How long an answer is waited for, and a pause that ends it.
const ANSWER_STEPS: usize = 12;
const ANSWER_STEP_S: f64 = 0.5;

/// The tow cable's rate.
const CABLE_BAUD: f64 = 115_200.0;

/// A board with everything on it but a card.
pub fn sensors() -> Board {
    let mut board = Board { converter: Some(Converter::new(|_| COUNTS)), ..Board::default() };
    board.lines[SCALAR].talk(fs(0.02), fs(0.1), |count| {
        let pt = FIRST_PT + count as i32 * STEP_PT;
        format!("$ {}.{:03},1249\r\n", pt / 1_000, pt % 1_000).into_bytes()
    });
    board
}

/// The same with this card.
pub fn sensors_and(disk: Disk) -> Board {
    Board { card: Some(SdCard::new(disk, Capacity::High)), ..sensors() }
}

/// A body that runs.
pub struct Body {
    pub chip: Chip,
    heard: usize,
}

impl Body {
    /// Power comes.
    pub fn start(board: Board, cells: Cells) -> Self {
        Self { chip: Chip::power_on(&IMAGE, board, cells), heard: 0 }
    }

    /// Let it live for so many seconds.
    pub fn live(&mut self, seconds: f64) -> End {
        self.chip.run(seconds)
    }

    /// What has come up the cable since the last call; what was sent with a wrong rate is not understood.
    pub fn received(&mut self) -> Received {
        let sent = &self.chip.bus().usarts[SHIP].sent;
        let new = sent[self.heard..].iter().filter(|sent| (sent.baud / CABLE_BAUD - 1.0).abs() < 0.04);
        let received = Received::of(new.map(|sent| sent.byte));
        self.heard = sent.len();
        received
    }

    /// By how much the rate of the latest byte up the cable is off, parts of one.
    pub fn baud_error(&self) -> f64 {
        let sent = self.chip.bus().usarts[SHIP].sent.last().expect("something was sent");
        sent.baud / CABLE_BAUD - 1.0
    }

    /// The ship sends something.
    pub fn send(&mut self, text: &str) {
        let now_fs = self.chip.machine().now_fs;
        self.chip.bus_mut().line(SHIP).send(now_fs, text.as_bytes());
        self.chip.replan();
    }

    /// A line to the console, and what it answers: it may erase a sector of the flash before it does.
    pub fn answer(&mut self, line: &str) -> Vec<String> {
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

    /// What stays in the flash without power.
    pub fn cells(&self) -> Cells {
        self.chip.bus().flash.cells.clone()
    }

    /// The power goes.
    pub fn off(mut self) -> (Board, Cells) {
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
fn note(chip: &Chip) {
    let mut seen = SEEN.lock().expect("no test has panicked in here");
    for (address, size) in chip.machine().blocks.seen() {
        let known = seen.entry(address).or_default();
        *known = size.max(*known);
    }
}
