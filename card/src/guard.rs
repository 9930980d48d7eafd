//! Whether a device is a card that may be written to, as far as the operating system tells.

use std::path::Path;

use crate::CardError;

/// What the operating system says of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seen {
    /// Nothing uses it.
    Unused,
    /// It does not tell this program who uses it.
    Unknown,
}

/// Refuse a device that is in use, or is not a whole card.
#[cfg(target_os = "linux")]
pub(crate) fn inspect(path: &Path) -> Result<Seen, CardError> {
    let device = path.canonicalize().map_err(CardError::opening(path))?;
    let Some(disk) = linux::Disk::of(&device) else { return Ok(Seen::Unknown) };
    if let Some(whole) = disk.whole_of_partition() {
        return Err(CardError::Partition { path: path.into(), device: Some(whole) });
    }
    if disk.is_read_only() {
        return Err(CardError::ReadOnly(path.into()));
    }
    match disk.used_for() {
        Some((at, true)) => Err(CardError::System { path: path.into(), at }),
        Some((at, false)) => Err(CardError::InUse { path: path.into(), at }),
        None => Ok(Seen::Unused),
    }
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn inspect(_: &Path) -> Result<Seen, CardError> {
    Ok(Seen::Unknown)
}

/// The whole card that a folder lies on, and its file system, where the operating system tells.
#[cfg(target_os = "linux")]
pub(crate) fn behind(folder: &Path) -> Option<(String, crate::mounts::Mount)> {
    let mounts = linux::mounts();
    let mount = crate::mounts::mount_of(&mounts, &folder.canonicalize().ok()?)?.clone();
    let source = Path::new(&mount.source).canonicalize().ok()?;
    let whole = linux::Disk::of(&source).and_then(|disk| disk.whole_of_partition());
    Some((whole.unwrap_or_else(|| source.display().to_string()), mount))
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn behind(_: &Path) -> Option<(String, crate::mounts::Mount)> {
    None
}

#[cfg(target_os = "linux")]
mod linux {
    use std::fs;
    use std::path::{Path, PathBuf};

    use crate::mounts::{self, Mount};

    pub(super) fn mounts() -> Vec<Mount> {
        mounts::mounts(&fs::read_to_string("/proc/self/mountinfo").unwrap_or_default())
    }

    /// A block device as the kernel shows it in `/sys`.
    pub(super) struct Disk(PathBuf);

    impl Disk {
        pub(super) fn of(device: &Path) -> Option<Self> {
            let shown = Path::new("/sys/class/block").join(device.file_name()?);
            shown.canonicalize().ok().map(Self)
        }

        /// Of a partition the device that it is one of.
        pub(super) fn whole_of_partition(&self) -> Option<String> {
            let parent = self.0.parent().filter(|_| self.0.join("partition").exists())?;
            Some(format!("/dev/{}", parent.file_name()?.to_string_lossy()))
        }

        pub(super) fn is_read_only(&self) -> bool {
            fs::read_to_string(self.0.join("ro")).is_ok_and(|text| text.trim() == "1")
        }

        /// What the disk or one of its partitions is used for, and whether that is the system's.
        pub(super) fn used_for(&self) -> Option<(String, bool)> {
            let parts = self.parts();
            let number = |part: &PathBuf| fs::read_to_string(part.join("dev")).unwrap_or_default().trim().to_string();
            let numbers: Vec<String> = parts.iter().map(number).collect();
            let name = |part: &PathBuf| part.file_name().map(|name| format!("/dev/{}", name.to_string_lossy()));
            let names: Vec<String> = parts.iter().filter_map(name).collect();
            let swaps = mounts::swaps(&fs::read_to_string("/proc/swaps").unwrap_or_default());
            if let Some(swap) = swaps.iter().find(|swap| names.contains(swap)) {
                return Some((format!("{swap} is swap"), true));
            }
            // Logical volumes, encrypted disks, RAID: the system may live on any of them.
            let holder = parts.iter().find_map(|part| fs::read_dir(part.join("holders")).ok()?.next()?.ok());
            if let Some(holder) = holder {
                return Some((format!("a part of {}", holder.file_name().to_string_lossy()), true));
            }
            let is_here = |mount: &&Mount| numbers.contains(&mount.number) || names.contains(&mount.source);
            let mut here: Vec<Mount> = mounts().iter().filter(is_here).cloned().collect();
            here.sort_by_key(|mount| !mount.is_of_system());
            here.first().map(|mount| (format!("mounted at {}", mount.at.display()), mount.is_of_system()))
        }

        /// The disk and its partitions.
        fn parts(&self) -> Vec<PathBuf> {
            let below = fs::read_dir(&self.0).into_iter().flatten().flatten().map(|entry| entry.path());
            below.filter(|path| path.join("partition").exists()).chain([self.0.clone()]).collect()
        }
    }
}
