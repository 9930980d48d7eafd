//! The card: an empty FAT16 volume for the body, and the log out of what it has become.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use towmag::log::{BLOCK_LEN, BlockBytes, BlockSource, EpochRecord, Event, Record, Records, Recovered};

use crate::recording::{FileBlocks, survey};

/// First block of the partition, as on cards from the shop.
const PARTITION: u32 = 2048;
const BLOCKS_PER_CLUSTER: u32 = 64;
const ROOT_BLOCKS: u32 = 32;
const BOOT_SIGNATURE: [u8; 2] = [0x55, 0xAA];

/// Make an empty card with room for a log of `log_blocks`.
pub(super) fn format(path: &Path, log_blocks: u32) -> io::Result<()> {
    // FAT16 is what has 4,085 to 65,524 clusters; two thirds more than the log takes, for whatever else.
    let clusters = (log_blocks / BLOCKS_PER_CLUSTER * 5 / 3 + 64).clamp(4_200, 65_000);
    let fat_blocks = ((clusters + 2) * 2).div_ceil(BLOCK_LEN as u32);
    let blocks = 1 + 2 * fat_blocks + ROOT_BLOCKS + clusters * BLOCKS_PER_CLUSTER;
    let mut file = File::create(path)?;
    file.set_len(u64::from(PARTITION + blocks) * BLOCK_LEN as u64)?;
    write_at(&mut file, 0, &partition_table(blocks))?;
    write_at(&mut file, PARTITION, &boot_block(blocks, fat_blocks))?;
    let mut fat = [0; BLOCK_LEN];
    fat[..4].copy_from_slice(&[0xF8, 0xFF, 0xFF, 0xFF]);
    write_at(&mut file, PARTITION + 1, &fat)?;
    write_at(&mut file, PARTITION + 1 + fat_blocks, &fat)
}

fn write_at(file: &mut File, block: u32, bytes: &BlockBytes) -> io::Result<()> {
    file.seek(SeekFrom::Start(u64::from(block) * BLOCK_LEN as u64))?;
    file.write_all(bytes)
}

fn partition_table(blocks: u32) -> BlockBytes {
    let mut block = [0; BLOCK_LEN];
    block[446 + 4] = 0x06; // FAT16
    block[446 + 8..446 + 12].copy_from_slice(&PARTITION.to_le_bytes());
    block[446 + 12..446 + 16].copy_from_slice(&blocks.to_le_bytes());
    block[510..].copy_from_slice(&BOOT_SIGNATURE);
    block
}

fn boot_block(blocks: u32, fat_blocks: u32) -> BlockBytes {
    let mut block = [0; BLOCK_LEN];
    block[..3].copy_from_slice(&[0xEB, 0x3C, 0x90]);
    block[3..11].copy_from_slice(b"MSWIN4.1");
    block[11..13].copy_from_slice(&(BLOCK_LEN as u16).to_le_bytes());
    block[13] = BLOCKS_PER_CLUSTER as u8;
    block[14] = 1; // reserved blocks: this one
    block[16] = 2; // FATs
    block[17..19].copy_from_slice(&(ROOT_BLOCKS as u16 * 16).to_le_bytes());
    block[21] = 0xF8; // fixed disk
    block[22..24].copy_from_slice(&(fat_blocks as u16).to_le_bytes());
    block[28..32].copy_from_slice(&PARTITION.to_le_bytes());
    block[32..36].copy_from_slice(&blocks.to_le_bytes());
    block[38] = 0x29;
    block[43..54].copy_from_slice(b"TOWMAG     ");
    block[54..62].copy_from_slice(b"FAT16   ");
    block[510..].copy_from_slice(&BOOT_SIGNATURE);
    block
}

/// What a session left in the log.
#[derive(Clone, Debug, Default)]
pub(super) struct Session {
    pub(super) epochs: Vec<EpochRecord>,
    pub(super) events: Vec<Event>,
    pub(super) lost_epochs: u64,
    pub(super) faults: u64,
}

/// The log of a card.
pub(super) struct Log {
    /// Its sectors in order.
    pub(super) bytes: Vec<u8>,
    pub(super) sessions: Vec<Session>,
}

/// Read the log off a card, by its sectors alone.
pub(super) fn read_log(path: &Path) -> io::Result<Log> {
    let mut image = FileBlocks::open(path)?;
    let (keys, _) = survey(&mut image);
    let mut bytes = Vec::with_capacity(keys.len() * BLOCK_LEN);
    let mut block = [0; BLOCK_LEN];
    for key in &keys {
        image.read(key.position, &mut block)?;
        bytes.extend_from_slice(&block);
    }
    let mut sessions: Vec<Session> = Vec::new();
    for recovered in Records::new(&mut image, &keys) {
        if matches!(recovered, Recovered::Session(_)) {
            sessions.push(Session::default());
        }
        let Some(session) = sessions.last_mut() else { continue };
        match recovered {
            Recovered::Record(Record::Epoch(record)) => session.epochs.push(record),
            Recovered::Record(Record::Event(event)) => session.events.push(event),
            Recovered::Record(Record::Loss(loss)) => session.lost_epochs += u64::from(loss.epochs),
            Recovered::Session(_) | Recovered::Record(Record::Header(_)) => {}
            _ => session.faults += 1,
        }
    }
    Ok(Log { bytes, sessions })
}
