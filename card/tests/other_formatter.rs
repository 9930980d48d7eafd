//! Cards that another program has formatted and filled, read back by it after they were prepared.
#![cfg(not(target_os = "none"))]

mod common;

use std::io::{Cursor, Read, Write};

use common::Memory;
use fatfs::{FatType, FileSystem, FormatVolumeOptions, FsOptions};
use towmag_card::{Listing, Wanted, prepare};

/// Where partitions begin on cards, blocks.
const FIRST: usize = 8_192;

/// A card of so many blocks, with one partition and a photo in it.
fn card(blocks: usize, fat: FatType, partition_type: u8, photo: &[u8]) -> Vec<u8> {
    let mut volume = vec![0; (blocks - FIRST) * 512];
    let options = FormatVolumeOptions::new().fat_type(fat).volume_label(*b"CARD       ");
    fatfs::format_volume(Cursor::new(&mut volume[..]), options).unwrap();
    {
        let system = FileSystem::new(Cursor::new(&mut volume[..]), FsOptions::new()).unwrap();
        system.root_dir().create_dir("DCIM").unwrap();
        system.root_dir().create_file("DCIM/a long name of a photo.jpg").unwrap().write_all(photo).unwrap();
    }
    let mut card = vec![0; FIRST * 512];
    card[450] = partition_type;
    card[454..458].copy_from_slice(&(FIRST as u32).to_le_bytes());
    card[458..462].copy_from_slice(&((blocks - FIRST) as u32).to_le_bytes());
    card[510..512].copy_from_slice(&[0x55, 0xAA]);
    card.extend(volume);
    card
}

#[test]
fn what_was_on_a_card_is_untouched_and_the_logs_are_files() {
    let photo: Vec<u8> = (0..300_001_u32).map(|byte| (byte % 251) as u8).collect();
    for (fat, partition_type, blocks) in [(FatType::Fat16, 0x06, 120_000), (FatType::Fat32, 0x0C, 240_000)] {
        let store = Memory::from(card(blocks, fat, partition_type, &photo));
        let free_before = Listing::of(&store).unwrap().free_bytes();
        let files = prepare(&store, &Wanted { hours: 2, files: 3, nonce: 7 }, &()).unwrap();
        let mut bytes = store.bytes.into_inner();
        let system = FileSystem::new(Cursor::new(&mut bytes[FIRST * 512..]), FsOptions::new()).unwrap();
        let mut read = Vec::new();
        system.root_dir().open_file("DCIM/a long name of a photo.jpg").unwrap().read_to_end(&mut read).unwrap();
        assert!(read == photo, "{fat:?}: the photo");
        let names: Vec<String> = system.root_dir().iter().map(|entry| entry.unwrap().file_name()).collect();
        assert!(names.ends_with(&["TOWMAG01.BIN".into(), "TOWMAG02.BIN".into(), "TOWMAG03.BIN".into()]), "{names:?}");
        let mut used = 0;
        for file in &files {
            let mut log = Vec::new();
            let name = format!("TOWMAG{:02}.BIN", file.number);
            system.root_dir().open_file(&name).unwrap().read_to_end(&mut log).unwrap();
            assert_eq!(log.len() as u64, file.bytes, "{fat:?}: {name}");
            used += file.bytes.next_multiple_of(u64::from(system.cluster_size()));
        }
        drop(system);
        let left = Listing::of(&Memory::from(bytes)).unwrap().free_bytes();
        assert_eq!(free_before - left, used, "{fat:?}: clusters that belong to nobody");
    }
}
