//! The free space of a mounted folder, as files without a name: whatever ends the program, they are gone with it.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::store::forget_cache;
use crate::{BLOCK_BYTES, CardError, Store, guard};

/// Bytes of a file: FAT has none of 4 GiB.
const FILE_BYTES: u64 = 1 << 30;

/// Left to the file system for its own tables.
const LEFT_BYTES: u64 = 1 << 20;

/// Files that grow as they are written to, one behind the other.
#[derive(Debug)]
pub struct FolderStore {
    folder: PathBuf,
    files: RefCell<Vec<File>>,
}

impl FolderStore {
    /// On a folder of a card; refuses the disk of the system itself, which would be filled to the last byte.
    pub fn on_card(folder: &Path) -> Result<Self, CardError> {
        let mount = guard::behind(folder).map(|(_, mount)| mount);
        if let Some(mount) = mount.as_ref().filter(|mount| mount.is_of_system()) {
            let at = format!("mounted at {}", mount.at.display());
            return Err(CardError::System { path: folder.into(), at });
        }
        let is_known = |kind: &str| matches!(kind, "vfat" | "msdos" | "fuseblk");
        if let Some(mount) = mount.filter(|mount| !is_known(&mount.kind)) {
            return Err(CardError::Format(format!(
                "{}: is {}, which the body does not read",
                folder.display(),
                mount.kind
            )));
        }
        if shares_disk_with_system(folder) {
            return Err(CardError::System { path: folder.into(), at: "the disk of your own files".into() });
        }
        Ok(Self::new(folder))
    }

    /// On any folder.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.into(), files: RefCell::default() }
    }

    /// What can be filled; `None` where the system does not tell.
    pub(super) fn free_bytes(&self) -> Option<u64> {
        free_bytes(&self.folder).map(|bytes| bytes.saturating_sub(LEFT_BYTES))
    }

    /// The file that these bytes are in, at its place in it. No piece reaches over the end of a file.
    fn file(&self, at: u64) -> io::Result<File> {
        let mut files = self.files.borrow_mut();
        let number = (at / FILE_BYTES) as usize;
        while files.len() <= number {
            files.push(tempfile::tempfile_in(&self.folder)?);
        }
        let mut file = files[number].try_clone()?;
        file.seek(SeekFrom::Start(at % FILE_BYTES))?;
        Ok(file)
    }
}

impl Store for FolderStore {
    fn blocks(&self) -> u64 {
        let files = self.files.borrow();
        let bytes: u64 = files.iter().map(|file| file.metadata().map_or(0, |metadata| metadata.len())).sum();
        bytes / BLOCK_BYTES
    }

    fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.file(at)?.read_exact(bytes)
    }

    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.file(at)?.write_all(bytes)
    }

    fn sync(&self) -> io::Result<()> {
        self.files.borrow().iter().try_for_each(File::sync_data)
    }

    fn forget_cache(&self) -> bool {
        self.files.borrow().iter().all(forget_cache)
    }
}

#[cfg(unix)]
fn free_bytes(folder: &Path) -> Option<u64> {
    rustix::fs::statvfs(folder).ok().map(|stat| stat.f_bavail * stat.f_frsize)
}

#[cfg(not(unix))]
fn free_bytes(_: &Path) -> Option<u64> {
    None
}

#[cfg(unix)]
fn shares_disk_with_system(folder: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let device = |path: &Path| path.metadata().map(|metadata| metadata.dev()).ok();
    let own = std::env::home_dir().and_then(|home| device(&home));
    device(folder).is_some_and(|card| Some(card) == own || Some(card) == device(Path::new("/")))
}

#[cfg(not(unix))]
fn shares_disk_with_system(folder: &Path) -> bool {
    let drive = |path: &Path| path.canonicalize().ok()?.components().next().map(|drive| drive.as_os_str().to_owned());
    let own = std::env::home_dir().and_then(|home| drive(&home));
    own.is_some() && drive(folder) == own
}
