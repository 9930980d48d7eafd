//! Why a card cannot be prepared or tried. Each message says what, and what to do.

use std::io;
use std::path::{Path, PathBuf};

use towmag::log::VolumeError;

/// Why a card cannot be prepared or tried.
#[derive(Debug, thiserror::Error)]
pub enum CardError {
    /// It cannot be opened.
    #[error("{}: cannot be opened: {source}", .path.display())]
    Open {
        /// As the user gave it.
        path: PathBuf,
        /// The system's own words.
        source: io::Error,
    },
    /// Reading or writing failed on the way.
    #[error("the card failed: {0}: try another reader, then another card")]
    Failed(#[from] io::Error),
    /// It may not be written to.
    #[error("{}: is read-only: push the lock on the card's side, or make the image writable", .0.display())]
    ReadOnly(PathBuf),
    /// The operating system chooses where in a folder the blocks of a file lie.
    #[error(
        "{}: is a folder, and in a folder the operating system decides where a file lies, not necessarily in one piece: \
         unmount the card and name the card itself{}", .folder.display(), device_hint(.device.as_deref())
    )]
    Folder {
        /// As the user gave it.
        folder: PathBuf,
        /// The whole card behind it, where that is known.
        device: Option<String>,
    },
    /// One partition of a card.
    #[error("{}: is one partition of a card: name the whole card{}", .path.display(), device_hint(.device.as_deref()))]
    Partition {
        /// As the user gave it.
        path: PathBuf,
        /// The whole card, where that is known.
        device: Option<String>,
    },
    /// The system itself lives on it.
    #[error("{}: is a disk of this computer's own system ({at}): never touched", .path.display())]
    System {
        /// As the user gave it.
        path: PathBuf,
        /// What it is used for.
        at: String,
    },
    /// Written below a file system that is mounted, both would be spoilt.
    #[error("{}: is in use ({at}): unmount it first", .path.display())]
    InUse {
        /// As the user gave it.
        path: PathBuf,
        /// What it is used for.
        at: String,
    },
    /// Not what the body can read.
    #[error("{0}: format the card FAT32 with a partition table, as the SD Association's formatter does up to 32 GB")]
    Format(String),
    /// There is no room for what was asked.
    #[error("{0}")]
    Full(String),
    /// A file that the body would not make.
    #[error("{0}")]
    Usage(String),
    /// It holds more than logs, or nothing tells what it holds.
    #[error("{}: to write to it all the same, name it twice (--really {}): {why}", .path.display(), .path.display())]
    NameItTwice {
        /// As the user gave it.
        path: PathBuf,
        /// What is dangerous about it.
        why: String,
    },
    /// Nobody said yes.
    #[error("{}: nothing was written: answer yes, or give --yes where nobody can be asked", .0.display())]
    NoConsent(PathBuf),
    /// What was written is not what can be read: the card is broken or lies about its size.
    #[error(
        "what was written cannot be read back: do not use this card; `host-sim card test` says what is wrong with it"
    )]
    NotKept,
}

impl CardError {
    /// Whether the user should have named or prepared something else (exit code 2); else the work failed (exit code 1).
    pub fn is_bad_usage(&self) -> bool {
        !matches!(self, Self::Failed(_) | Self::NotKept)
    }

    pub(crate) fn opening(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        |source| match source.kind() {
            io::ErrorKind::ReadOnlyFilesystem => Self::ReadOnly(path),
            io::ErrorKind::ResourceBusy => Self::InUse { path, at: "by a file system, or by another program".into() },
            _ => Self::Open { path, source },
        }
    }
}

impl From<VolumeError<io::Error>> for CardError {
    fn from(error: VolumeError<io::Error>) -> Self {
        match error {
            // A number in the file system leads out of the card.
            VolumeError::Card(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                Self::Format("the card's file system makes no sense, or the image is cut short".into())
            }
            VolumeError::Card(error) => Self::Failed(error),
            VolumeError::NoVolume => Self::Format("there is no FAT16 or FAT32 in the first partition".into()),
            VolumeError::Size(_) => Self::Usage(error.to_string()),
            VolumeError::TooManyFiles | VolumeError::NoSpace | VolumeError::DirectoryFull => {
                Self::Full(error.to_string())
            }
        }
    }
}

fn device_hint(device: Option<&str>) -> String {
    device.map(|device| format!(", {device}")).unwrap_or_default()
}
