//! The sectors of a log in a file or card image.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use towmag::log::{BLOCK_LEN, BlockBytes, BlockSource, Scan, SectorKey, Survey, order};

/// Read at once, bytes: nearly all is read in order, and a card has millions of blocks.
const READ_AHEAD: usize = 1 << 16;

/// A file or card image as blocks.
#[derive(Debug)]
pub struct FileBlocks {
    file: BufReader<File>,
    blocks: u32,
    /// Where in the file the next byte is read; none after an error.
    at: Option<u64>,
}

impl FileBlocks {
    /// Open a file. A last block that is cut off is padded with zeros, so that its CRC tells.
    pub fn open(path: &Path) -> std::io::Result<Self> {
        let mut file = File::open(path)?;
        let len = file.seek(SeekFrom::End(0))?;
        let blocks = u32::try_from(len.div_ceil(BLOCK_LEN as u64)).unwrap_or(u32::MAX);
        Ok(Self { file: BufReader::with_capacity(READ_AHEAD, file), blocks, at: Some(len) })
    }

    /// Go to a byte of the file, by way of what has been read already where it is there.
    fn seek(&mut self, to: u64) -> std::io::Result<()> {
        match self.at.take() {
            Some(at) => self.file.seek_relative(to.wrapping_sub(at).cast_signed())?,
            None => _ = self.file.seek(SeekFrom::Start(to))?,
        }
        self.at = Some(to);
        Ok(())
    }

    /// As much of a block as there is from here on.
    fn fill(&mut self, block: &mut BlockBytes) -> std::io::Result<usize> {
        let mut filled = 0;
        while filled < block.len() {
            match self.file.read(&mut block[filled..])? {
                0 => break,
                read => filled += read,
            }
        }
        Ok(filled)
    }
}

impl BlockSource for FileBlocks {
    type Error = std::io::Error;

    fn blocks(&self) -> u32 {
        self.blocks
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> std::io::Result<()> {
        block.fill(0);
        self.seek(u64::from(position) * BLOCK_LEN as u64)?;
        let filled = self.fill(block).inspect_err(|_| self.at = None)?;
        self.at = self.at.map(|at| at + filled as u64);
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
