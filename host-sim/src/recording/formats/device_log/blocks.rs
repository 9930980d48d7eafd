//! The sectors of a log in a file or card image.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use towmag::log::{BLOCK_LEN, BlockBytes, BlockSource, Scan, SectorKey, Survey, order};

/// A file or card image as blocks.
#[derive(Debug)]
pub struct FileBlocks {
    file: File,
    blocks: u32,
}

impl FileBlocks {
    /// Open a file. A last block that is cut off is padded with zeros, so that its CRC tells.
    pub fn open(path: &Path) -> std::io::Result<Self> {
        let mut file = File::open(path)?;
        let len = file.seek(SeekFrom::End(0))?;
        Ok(Self { file, blocks: u32::try_from(len.div_ceil(BLOCK_LEN as u64)).unwrap_or(u32::MAX) })
    }
}

impl BlockSource for FileBlocks {
    type Error = std::io::Error;

    fn blocks(&self) -> u32 {
        self.blocks
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> std::io::Result<()> {
        block.fill(0);
        self.file.seek(SeekFrom::Start(u64::from(position) * BLOCK_LEN as u64))?;
        let mut filled = 0;
        while filled < block.len() {
            match self.file.read(&mut block[filled..])? {
                0 => break,
                read => filled += read,
            }
        }
        Ok(())
    }
}

/// The intact sectors of a source in the order of writing, and what else there is.
pub fn survey(source: &mut impl BlockSource) -> (Vec<SectorKey>, Survey) {
    let mut survey = Survey::default();
    let mut keys: Vec<_> = Scan::new(source).filter_map(|found| survey.count(found)).collect();
    let sectors = order(&mut keys);
    survey.duplicates = keys.len() - sectors;
    keys.truncate(sectors);
    (keys, survey)
}
