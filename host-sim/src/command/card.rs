//! `host-sim card`: cards for the body, prepared and tried on the desk.

use std::hash::{BuildHasher, RandomState};
use std::path::Path;

use towmag_card::fitness::{Effort, FolderStore, RealClock, Report, Trial};
use towmag_card::{CardError, Consent, Place, Prepared, Wanted, prepare};

use crate::progress::CardBar;

/// Lay out log files on a card or an image of one. `ask` is shown what is on a card before anything is written to it.
pub fn prepare_card(
    path: &Path,
    hours: u32,
    files: u32,
    consent: &Consent,
    ask: impl FnOnce(&str) -> Option<bool>,
) -> Result<Vec<Prepared>, CardError> {
    let card = Place::of(path)?.open(consent, ask)?;
    prepare(&card, &Wanted { hours, files, nonce: drawn() as u32 }, &CardBar::new())
}

/// Try a card, an image of one, or the folder of a card that is mounted.
pub fn test_card(
    path: &Path,
    effort: Effort,
    consent: &Consent,
    ask: impl FnOnce(&str) -> Option<bool>,
) -> Result<Report, CardError> {
    let place = Place::of(path)?;
    let trial = Trial { effort, seed: drawn(), clock: &RealClock::default(), progress: &CardBar::new() };
    match place {
        Place::Folder(folder) => trial.of_folder(&FolderStore::on_card(&folder)?),
        place => trial.of_card(&place.open(consent, ask)?),
    }
}

/// A number that is seldom the same.
fn drawn() -> u64 {
    RandomState::new().hash_one(std::process::id())
}
