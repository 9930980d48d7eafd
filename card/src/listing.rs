//! What is on a card, and what keeps it from being the body's.

use std::fmt;
use std::io;
use std::ops::Range;

use towmag::log::{Contents, RootEntry};
use towmag::storage::PARTITION;

use crate::blocks::OnStore;
use crate::{BLOCK_BYTES, CardError, Store};

/// Folders that operating systems put on every card they see, by their short names.
const LITTER: [&str; 4] = ["SYSTEM~1", "FSEVEN~1", "SPOTLI~1", "TRASHE~1"];

/// Items that are shown to somebody who is asked.
const MOST_SHOWN: usize = 12;

/// A file or folder of the root directory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// Its short name.
    pub name: String,
    /// Whether it is a folder.
    pub is_folder: bool,
    /// Whether it is one of the body's logs.
    pub is_log: bool,
    /// In bytes.
    pub size: u32,
}

impl Item {
    fn is_litter(&self) -> bool {
        self.is_folder && LITTER.contains(&self.name.as_str())
    }
}

/// What is on a card.
#[derive(Clone, Debug)]
pub struct Listing {
    /// Of the whole card.
    pub bytes: u64,
    /// Else it is FAT16.
    pub is_fat32: bool,
    /// Of the volume.
    pub label: Option<String>,
    /// What the root directory holds.
    pub items: Vec<Item>,
    /// Blocks of no file, in runs.
    pub(crate) free: Vec<Range<u32>>,
}

impl Listing {
    /// Look at a card, and change nothing.
    pub fn of<S: Store>(store: &S) -> Result<Self, CardError> {
        refuse_other_formats(store)?;
        let card = OnStore(store);
        let contents = Contents::find(&card, PARTITION)?;
        if u64::from(contents.end()) > store.blocks() {
            return Err(CardError::Format("the file system is longer than the card or image: it is cut short".into()));
        }
        let (mut label, mut items, mut free) = (None, Vec::new(), Vec::new());
        let listed = contents.each_entry(&card, |entry| match entry {
            RootEntry::Label(text) => label = Some(String::from_utf8_lossy(&text).trim_end().into()),
            RootEntry::Item { name, is_folder, is_log, size } => {
                items.push(Item { name: dotted(&name), is_folder, is_log, size });
            }
        });
        listed.and_then(|()| contents.each_free_run(&card, |run| free.push(run))).map_err(CardError::Failed)?;
        let bytes = store.blocks() * BLOCK_BYTES;
        Ok(Self { bytes, is_fat32: contents.is_fat32(), label, items, free })
    }

    /// Whether nobody would miss what is on it, but for logs.
    pub fn holds_only_logs(&self) -> bool {
        self.items.iter().all(|item| item.is_log || item.is_litter())
    }

    /// Bytes that belong to no file.
    pub fn free_bytes(&self) -> u64 {
        self.free.iter().map(|run| u64::from(run.end - run.start) * BLOCK_BYTES).sum()
    }
}

impl fmt::Display for Listing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.is_fat32 { "FAT32" } else { "FAT16" };
        let label = self.label.as_deref().unwrap_or("without a label");
        let (all_mb, free_mb) = (self.bytes / 1_000_000, self.free_bytes() / 1_000_000);
        write!(f, "{all_mb} MB, {kind}, {label}, {free_mb} MB free, {} files and folders", self.items.len())?;
        for item in self.items.iter().take(MOST_SHOWN) {
            let Item { name, size, .. } = item;
            if item.is_folder { write!(f, "\n  {name}/")? } else { write!(f, "\n  {name}  {size} bytes")? }
        }
        let more = self.items.len().saturating_sub(MOST_SHOWN);
        if more > 0 { write!(f, "\n  and {more} more") } else { Ok(()) }
    }
}

/// `README  TXT` as `README.TXT`; what is no text shows as such.
fn dotted(name: &[u8; 11]) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim_end().replace(char::is_control, "?");
    let (stem, extension) = (text(&name[..8]), text(&name[8..]));
    if extension.is_empty() { stem } else { format!("{stem}.{extension}") }
}

/// Formats that are known by name, so that the message can be.
fn refuse_other_formats<S: Store>(store: &S) -> Result<(), CardError> {
    let refuse = |what: &str| Err(CardError::Format(format!("{what}, which the body does not read")));
    let Some(first) = block(store, 0)? else { return refuse("less than a block") };
    let word = |at: usize| first.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()).map_or(0, u32::from_le_bytes);
    let start = word(454);
    if first[450] == 0xEE && start == 1 {
        return refuse("a GUID partition table");
    }
    let boot = block(store, start.into())?.unwrap_or(first);
    match &boot[3..11] {
        b"EXFAT   " => refuse("exFAT"),
        b"NTFS    " => refuse("NTFS"),
        // A volume that counts from the beginning of a card lies in a partition, whose table is missing here.
        b"MSDOS5.0" | b"mkfs.fat" if start == 0 && word(28) != 0 => refuse("one partition without the card around it"),
        _ => Ok(()),
    }
}

fn block<S: Store>(store: &S, index: u64) -> Result<Option<[u8; 512]>, CardError> {
    let mut block = [0; 512];
    match store.read(index * BLOCK_BYTES, &mut block) {
        Ok(()) => Ok(Some(block)),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
        Err(error) => Err(error.into()),
    }
}
