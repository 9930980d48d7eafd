//! `host-sim card` at the terminal.

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use clap::{Args, Subcommand};
use host_sim::command::{prepare_card, test_card};
use host_sim::error::HostError;
use towmag_card::Consent;
use towmag_card::fitness::Effort;

use super::say::say;

#[derive(Subcommand)]
pub(super) enum CardAction {
    /// Lay out log files on a card, so that the body logs on it at once instead of making one for five minutes.
    ///
    /// The card must be formatted FAT16 or FAT32. Needs the card itself, unmounted (/dev/sdX on Linux, /dev/diskN on
    /// macOS, \\.\PhysicalDriveN on Windows), or an image of it: in a mounted folder the operating system would decide
    /// where the files lie. Nothing that is on the card changes. Without the right for devices leave it to the body.
    Prepare {
        /// The card, or an image of it.
        #[arg(value_name = "DEVICE_OR_IMAGE")]
        card: PathBuf,
        /// Hours of log in a file, 1 to 240: the body's `log_file_h`. An hour takes 3.7 MB.
        #[arg(long, value_name = "H", default_value_t = 72)]
        hours: u32,
        /// Files, which the body fills one after the other.
        #[arg(long, value_name = "N", default_value_t = 1)]
        files: u32,
        #[command(flatten)]
        consent: ConsentArgs,
    },
    /// Try whether a card is fit: whether it has the room that it says, how long a write waits, how fast it is.
    ///
    /// Prints the verdict, fit or not fit and why, in one line, then the figures. In a folder of a mounted card it fills
    /// the free space with files that are gone afterwards; of the card itself, unmounted, or of an image it tries free
    /// blocks all over and puts them back, which takes less time and finds as much. Test a card that may be a fake while
    /// it is empty: filling such a folder destroys what is in it.
    Test {
        /// A folder of the mounted card, the card itself, or an image of it.
        #[arg(value_name = "DEVICE_OR_IMAGE_OR_FOLDER")]
        card: PathBuf,
        /// Take a minute: of a folder a part only, of anything else fewer blocks.
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        consent: ConsentArgs,
    },
}

#[derive(Args)]
pub(super) struct ConsentArgs {
    /// Write to the card without asking.
    #[arg(long)]
    yes: bool,
    /// The device a second time: where it holds anything but logs, or the system does not tell what it is used for.
    #[arg(long, value_name = "DEVICE")]
    really: Option<PathBuf>,
}

impl From<ConsentArgs> for Consent {
    fn from(ConsentArgs { yes, really }: ConsentArgs) -> Self {
        Self { yes, really }
    }
}

impl CardAction {
    pub(super) fn run(self) -> Result<(), HostError> {
        match self {
            Self::Prepare { card, hours, files, consent } => {
                for file in prepare_card(&card, hours, files, &consent.into(), ask)? {
                    say(format_args!("TOWMAG{:02}.BIN: {hours} h, {} MB", file.number, file.bytes / 1_000_000));
                }
            }
            Self::Test { card, quick, consent } => {
                let effort = if quick { Effort::QUICK } else { Effort::THOROUGH };
                print!("{}", test_card(&card, effort, &consent.into(), ask)?);
            }
        }
        Ok(())
    }
}

/// Nobody can be asked where there is no terminal.
fn ask(question: &str) -> Option<bool> {
    if !io::stdin().is_terminal() {
        return None;
    }
    eprint!("{question} [yes/no] ");
    io::stderr().flush().ok()?;
    let mut answer = String::new();
    io::stdin().read_line(&mut answer).ok()?;
    Some(answer.trim() == "yes")
}
