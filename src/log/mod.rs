//! The log on the card: records in sectors, sectors in a pre-allocated file, and the way back.
//!
//! ```text
//! Record -> RecordProducer -> queue -> RecordConsumer -> SectorWriter -> LogFile -> card
//! card or image -> Scan -> order -> Recovered -> Record
//! ```
//!
//! A sector is 512 bytes, carries its own identity and CRC, and is written to two places, once. The file is allocated
//! once, and its blocks are marked ahead of the log; from then on the file system is only read, so that a power cut can
//! harm the one sector that was being written, which nobody had been told is safe. Sectors are found again by their content
//! alone, with or without a file system.
//!
//! All numbers on the card are little-endian; floating-point numbers are stored as their IEEE 754 bits.

mod block;
mod queue;
mod record;
mod recover;
mod sector;
mod slice_source;
mod volume;
mod writer;

pub use block::{BLOCK_LEN, BlockBytes, BlockSink, BlockSource, Region, blank_block};
pub use queue::{QUEUE_SLOTS, RecordConsumer, RecordProducer, RecordQueue, SLOT_LEN, Slot};
pub use record::{
    DecodeError, EpochRecord, Event, EventKind, FluxgateAxes, Header, InformationPart, InformationParts, Loss, Record,
    ResetCause, TEXT_LEN, VERSION_LEN, truncated,
};
pub use recover::{Found, Records, Recovered, Scan, SectorKey, Survey, order};
pub use sector::{
    FORMAT_VERSION, PAYLOAD_LEN, Sector, SectorBuilder, SectorError, SectorFull, SectorId, SectorRecords,
};
pub use slice_source::{OutOfBounds, SliceSource};
pub use volume::{
    Card, Contents, FileMap, LAST_FILE, LogFile, LogFileError, Maker, NewFile, Ready, RootEntry, VolumeError,
};
pub use writer::{AppendError, Durable, SectorWriter, WINDOW};
