//! What the user has named, and his consent to write to it.

use std::path::{Path, PathBuf};

use crate::guard::{self, Seen};
use crate::{Access, CardError, DiskFile, Listing};

/// What the user said beforehand.
#[derive(Clone, Debug, Default)]
pub struct Consent {
    /// Yes to whatever will be asked.
    pub yes: bool,
    /// The name of the device, a second time.
    pub really: Option<PathBuf>,
}

/// What a path leads to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A folder of a card that is mounted.
    Folder(PathBuf),
    /// An image of a card.
    Image(PathBuf),
    /// The card itself.
    Device(PathBuf),
}

impl Place {
    /// Look what is there.
    pub fn of(path: &Path) -> Result<Self, CardError> {
        let metadata = path.metadata().map_err(CardError::opening(path))?;
        Ok(match metadata {
            metadata if metadata.is_dir() => Self::Folder(path.into()),
            metadata if metadata.is_file() => Self::Image(path.into()),
            _ => Self::Device(path.into()),
        })
    }

    /// Open an image or device to write to it, after `ask` was shown what is on a device and has said yes; `None` of `ask`
    /// when nobody can be asked.
    pub fn open(&self, consent: &Consent, ask: impl FnOnce(&str) -> Option<bool>) -> Result<DiskFile, CardError> {
        match self {
            Self::Folder(folder) => {
                let behind = guard::behind(folder).filter(|(_, mount)| !mount.is_of_system());
                let device = behind.map(|(device, _)| device).filter(|name| name.starts_with("/dev/"));
                Err(CardError::Folder { folder: folder.clone(), device })
            }
            Self::Image(path) => DiskFile::open(path, Access::Write),
            Self::Device(path) => {
                let seen = guard::inspect(path)?;
                let listing = Listing::of(&DiskFile::open(path, Access::Read)?)?;
                agreed(path, seen, &listing, consent, ask)?;
                DiskFile::open(path, Access::Write)
            }
        }
    }
}

/// Whether a device with this on it may be written to.
fn agreed(
    path: &Path,
    seen: Seen,
    listing: &Listing,
    consent: &Consent,
    ask: impl FnOnce(&str) -> Option<bool>,
) -> Result<(), CardError> {
    let danger = match seen {
        Seen::Unknown => Some("this system does not tell what the device is used for".to_string()),
        Seen::Unused if !listing.holds_only_logs() => Some(format!("holds more than logs: {listing}")),
        Seen::Unused => None,
    };
    if let Some(why) = danger.filter(|_| consent.really.as_deref() != Some(path)) {
        return Err(CardError::NameItTwice { path: path.into(), why });
    }
    let question = format!("{}: {listing}\nWrite to this card?", path.display());
    if consent.yes || ask(&question) == Some(true) { Ok(()) } else { Err(CardError::NoConsent(path.into())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Item;

    fn listing(names: &[&str]) -> Listing {
        let item = |name: &&str| {
            let (is_folder, is_log) = (!name.contains('.'), *name == "TOWMAG01.BIN");
            Item { name: name.to_string(), is_folder, is_log, size: 0 }
        };
        let items = names.iter().map(item).collect();
        Listing { bytes: 1_000_000_000, is_fat32: true, label: None, items, free: Vec::new() }
    }

    fn named(name: &str) -> Consent {
        Consent { yes: false, really: Some(name.into()) }
    }

    fn asked(seen: Seen, names: &[&str], consent: &Consent, answer: Option<bool>) -> Result<(), CardError> {
        agreed(Path::new("/dev/sdz"), seen, &listing(names), consent, |question| {
            assert!(question.contains("1000 MB, FAT32"), "{question}");
            answer
        })
    }

    #[test]
    fn a_card_of_logs_needs_a_yes() {
        let logs = ["TOWMAG01.BIN", "SYSTEM~1"];
        assert!(asked(Seen::Unused, &logs, &Consent::default(), Some(true)).is_ok());
        let yes = Consent { yes: true, really: None };
        assert!(agreed(Path::new("a"), Seen::Unused, &listing(&logs), &yes, |_| unreachable!()).is_ok());
        for answer in [Some(false), None] {
            let refused = asked(Seen::Unused, &logs, &Consent::default(), answer);
            assert!(matches!(refused, Err(CardError::NoConsent(_))));
        }
    }

    #[test]
    fn a_card_with_anything_else_must_be_named_twice_and_still_needs_a_yes() {
        for names in [["PHOTO.JPG"], ["TOWMAG1.BIN"], ["DCIM"], ["TOWMAG01"]] {
            for consent in [Consent { yes: true, really: None }, named("/dev/sdy")] {
                let refused = asked(Seen::Unused, &names, &consent, Some(true));
                assert!(matches!(refused, Err(CardError::NameItTwice { .. })), "{names:?}");
            }
            assert!(asked(Seen::Unused, &names, &named("/dev/sdz"), Some(true)).is_ok());
            assert!(asked(Seen::Unused, &names, &named("/dev/sdz"), None).is_err());
        }
    }

    #[test]
    fn a_device_whose_use_is_not_known_must_be_named_twice() {
        assert!(asked(Seen::Unknown, &[], &Consent { yes: true, really: None }, None).is_err());
        assert!(asked(Seen::Unknown, &[], &named("/dev/sdz"), Some(true)).is_ok());
    }
}
