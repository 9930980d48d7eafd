//! What Linux says is mounted: `/proc/self/mountinfo` and `/proc/swaps`, as text, so that it can be tried anywhere.

use std::path::{Path, PathBuf};

/// Where the system itself lives; what is mounted below these as well.
const SYSTEM: [&str; 7] = ["/boot", "/home", "/usr", "/var", "/opt", "/srv", "/nix"];

/// A file system that is mounted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mount {
    /// Of its device, `major:minor`.
    pub(crate) number: String,
    /// Where.
    pub(crate) at: PathBuf,
    /// `vfat`, `ext4` and so on.
    pub(crate) kind: String,
    /// Usually its device.
    pub(crate) source: String,
}

impl Mount {
    /// Whether the computer needs it.
    pub(crate) fn is_of_system(&self) -> bool {
        self.at == Path::new("/") || SYSTEM.iter().any(|folder| self.at.starts_with(folder))
    }
}

/// All of them.
pub(crate) fn mounts(mountinfo: &str) -> Vec<Mount> {
    let parse = |line: &str| {
        let (place, device) = line.split_once(" - ")?;
        let (mut place, mut device) = (place.split(' ').skip(2), device.split(' '));
        let (number, at) = (place.next()?.to_string(), unescaped(place.nth(1)?).into());
        Some(Mount { number, at, kind: device.next()?.to_string(), source: unescaped(device.next()?) })
    };
    mountinfo.lines().filter_map(parse).collect()
}

/// The mount that a path lies in; both without symbolic links.
pub(crate) fn mount_of<'a>(mounts: &'a [Mount], path: &Path) -> Option<&'a Mount> {
    // Of several at one place the last hides the others.
    mounts.iter().filter(|mount| path.starts_with(&mount.at)).max_by_key(|mount| mount.at.as_os_str().len())
}

/// Devices that are swapped to.
pub(crate) fn swaps(swaps: &str) -> Vec<String> {
    swaps.lines().skip(1).filter_map(|line| line.split_whitespace().next()).map(unescaped).collect()
}

/// Blanks and the like stand in these files as three octal digits.
fn unescaped(text: &str) -> String {
    [("\\040", " "), ("\\011", "\t"), ("\\012", "\n"), ("\\134", "\\")]
        .iter()
        .fold(text.to_string(), |text, (escaped, plain)| text.replace(escaped, plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFO: &str = "\
22 1 254:0 / / rw,relatime - ext4 /dev/vda1 rw
23 22 0:21 / /proc rw - proc proc rw
40 22 8:17 / /media/my\\040card rw,nosuid shared:9 - vfat /dev/sdb1 rw,uid=1000
41 22 259:2 / /boot/efi rw - vfat /dev/nvme0n1p1 rw
";

    #[test]
    fn each_line_is_a_mount() {
        let mounts = mounts(INFO);
        assert_eq!(mounts.len(), 4);
        let card = &mounts[2];
        assert_eq!((card.number.as_str(), card.kind.as_str(), card.source.as_str()), ("8:17", "vfat", "/dev/sdb1"));
        assert_eq!(card.at, Path::new("/media/my card"));
        assert_eq!(mounts.iter().map(Mount::is_of_system).collect::<Vec<_>>(), [true, false, false, true]);
    }

    #[test]
    fn a_folder_lies_in_the_nearest_mount() {
        let mounts = mounts(INFO);
        let source = |path: &str| mount_of(&mounts, Path::new(path)).map(|mount| mount.source.as_str());
        assert_eq!(source("/media/my card/logs"), Some("/dev/sdb1"));
        assert_eq!(source("/media/my cards"), Some("/dev/vda1"));
    }

    #[test]
    fn the_first_line_of_the_swaps_is_a_heading() {
        let text = "Filename\t\t\tType\t\tSize\n/dev/sda3                               partition\t999\n";
        assert_eq!(swaps(text), ["/dev/sda3"]);
        assert_eq!(swaps(""), [""; 0]);
    }
}
