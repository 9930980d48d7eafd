//! A freshly formatted card, from the FAT specification; small enough to copy thousands of times.

use super::disk::{Disk, ERASE_BLOCKS};

/// Blocks before the partition.
const PARTITION: usize = 8;
const ERASE: usize = ERASE_BLOCKS as usize;

/// A card with one FAT16 partition of one block per cluster.
pub fn fat16(clusters: usize) -> Disk {
    fat16_of(clusters, 1, Layout::Packed)
}

/// How a card is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Everything as close as it gets.
    Packed,
    /// As formatters for SD cards do it: boot block, tables, root directory and data each in erase blocks of their own.
    Aligned,
}

/// A card with one FAT16 partition.
pub fn fat16_of(clusters: usize, cluster_blocks: usize, layout: Layout) -> Disk {
    assert!((4085..65525).contains(&clusters));
    let fat_blocks = ((clusters + 2) * 2).div_ceil(512);
    let (reserved, fat_blocks, root_blocks) = match layout {
        Layout::Packed => (1, fat_blocks, 4),
        Layout::Aligned => (2 * ERASE - PARTITION, fat_blocks.next_multiple_of(ERASE), ERASE),
    };
    let total = reserved + 2 * fat_blocks + root_blocks + clusters * cluster_blocks;
    let mut blocks = vec![[0; 512]; PARTITION + total];
    partition_table(&mut blocks[0], 0x0E, total);
    let boot = &mut blocks[PARTITION];
    boot_block(boot, reserved, total);
    put(boot, 13, &[cluster_blocks as u8]);
    put(boot, 17, &(root_blocks as u16 * 16).to_le_bytes());
    put(boot, 22, &(fat_blocks as u16).to_le_bytes());
    put(boot, 38, &[0x29]);
    put(boot, 43, b"TOWMAG     FAT16   ");
    for fat in 0..2 {
        put(&mut blocks[PARTITION + reserved + fat * fat_blocks], 0, &[0xF8, 0xFF, 0xFF, 0xFF]);
    }
    Disk::from_blocks(blocks)
}

/// Leave only `runs` runs of free clusters, each of so many, with one in use between them.
pub fn leave_runs(disk: &Disk, runs: usize, clusters: usize) {
    let boot = disk.block(PARTITION as u32);
    let at = |at: usize| u32::from(u16::from_le_bytes([boot[at], boot[at + 1]]));
    let (first, table_blocks) = (PARTITION as u32 + at(14), at(22));
    for block in 0..table_blocks {
        let mut table = disk.block(first + block);
        for (i, entry) in table.chunks_exact_mut(2).enumerate() {
            let data = (block as usize * 256 + i).checked_sub(2);
            let is_free = data.is_some_and(|n| n < runs * (clusters + 1) && n % (clusters + 1) < clusters);
            if data.is_some() && !is_free {
                entry.copy_from_slice(&[0xFF, 0xFF]);
            }
        }
        disk.set_block(first + block, table);
        disk.set_block(first + table_blocks + block, table);
    }
}

/// A card with one FAT32 partition of one block per cluster, as close as it gets.
pub fn fat32() -> Disk {
    fat32_of(Layout::Packed)
}

/// A card with one FAT32 partition of one block per cluster. Aligned, the rest of the root directory's erase block is in use.
pub fn fat32_of(layout: Layout) -> Disk {
    let clusters: usize = 66_000;
    let fat_blocks = ((clusters + 2) * 4).div_ceil(512);
    let (reserved, fat_blocks, root_clusters) = match layout {
        Layout::Packed => (32, fat_blocks, 1),
        Layout::Aligned => (2 * ERASE - PARTITION, fat_blocks.next_multiple_of(ERASE), ERASE),
    };
    let total = reserved + 2 * fat_blocks + clusters;
    let mut blocks = vec![[0; 512]; PARTITION + total];
    partition_table(&mut blocks[0], 0x0C, total);
    let boot = &mut blocks[PARTITION];
    boot_block(boot, reserved, total);
    put(boot, 36, &(fat_blocks as u32).to_le_bytes());
    put(boot, 44, &2_u32.to_le_bytes()); // root directory
    put(boot, 48, &1_u16.to_le_bytes()); // info block
    put(boot, 66, &[0x29]);
    put(boot, 71, b"TOWMAG     FAT32   ");
    let info = &mut blocks[PARTITION + 1];
    put(info, 0, b"RRaA");
    put(info, 484, b"rrAa");
    put(info, 488, &((clusters - root_clusters) as u32).to_le_bytes());
    put(info, 492, &(2 + root_clusters as u32).to_le_bytes());
    put(info, 510, &[0x55, 0xAA]);
    for fat in 0..2 {
        let mut entries = vec![0x0FFF_FFFF_u32; 2 + root_clusters];
        entries[0] = 0x0FFF_FFF8;
        let bytes: Vec<u8> = entries.iter().flat_map(|entry| entry.to_le_bytes()).collect();
        put(&mut blocks[PARTITION + reserved + fat * fat_blocks], 0, &bytes);
    }
    Disk::from_blocks(blocks)
}

fn partition_table(block: &mut [u8; 512], kind: u8, total: usize) {
    put(block, 450, &[kind]);
    put(block, 454, &(PARTITION as u32).to_le_bytes());
    put(block, 458, &(total as u32).to_le_bytes());
    put(block, 510, &[0x55, 0xAA]);
}

fn boot_block(block: &mut [u8; 512], reserved: usize, total: usize) {
    put(block, 0, &[0xEB, 0x3C, 0x90]);
    put(block, 3, b"TEST    ");
    put(block, 11, &512_u16.to_le_bytes());
    put(block, 13, &[1]);
    put(block, 14, &(reserved as u16).to_le_bytes());
    put(block, 16, &[2]);
    put(block, 21, &[0xF8]);
    put(block, 24, &[32, 0, 2, 0]);
    put(block, 28, &(PARTITION as u32).to_le_bytes());
    put(block, 32, &(total as u32).to_le_bytes());
    put(block, 510, &[0x55, 0xAA]);
}

fn put(block: &mut [u8; 512], at: usize, bytes: &[u8]) {
    block[at..at + bytes.len()].copy_from_slice(bytes);
}
