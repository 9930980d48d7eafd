//! Between the 10 Hz tick, which must not wait, and the card, which may take its time.
//!
//! A lock-free queue of encoded records. When it is full the producer counts what it drops, and puts a loss record
//! into the place of the gap as soon as there is room again.

use heapless::spsc;

use super::block::BlockSink;
use super::record::{Loss, Record};
use super::writer::{AppendError, SectorWriter};

/// Longest record that goes through the queue, bytes. Every epoch and loss record does; of the events, all but the
/// long ones (calibration, settings, panic), which the writing task appends itself.
pub const SLOT_LEN: usize = 64;

/// Slots of the queue. One stays empty: 191 records are 9.5 s of epochs at 10 Hz, each with its depth, or 19 s without.
pub const QUEUE_SLOTS: usize = 192;

/// An encoded record.
pub type Slot = heapless::Vec<u8, SLOT_LEN, u8>;

/// The queue, about 13 kB. Split it with `split()` into the ends for [`RecordProducer`] and [`RecordConsumer`].
pub type RecordQueue = spsc::Queue<Slot, QUEUE_SLOTS>;

/// The end of the queue at the tick.
pub struct RecordProducer<'a> {
    producer: spsc::Producer<'a, Slot>,
    /// What was dropped since the last loss record.
    pending: Option<Loss>,
    dropped: u32,
}

impl<'a> RecordProducer<'a> {
    /// The end for the task that records.
    pub fn new(producer: spsc::Producer<'a, Slot>) -> Self {
        Self { producer, pending: None, dropped: 0 }
    }

    /// Queue a record, behind a loss record if some were dropped before it. Never waits. False when the record was
    /// dropped and counted: no room, or longer than [`SLOT_LEN`].
    pub fn push(&mut self, record: &Record) -> bool {
        let queued = self.report_pending() && encode(record).is_some_and(|slot| self.producer.enqueue(slot).is_ok());
        if !queued {
            self.count(record);
        }
        queued
    }

    /// Records dropped so far, saturating.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Records that the queue has room for.
    pub fn room(&self) -> usize {
        self.producer.capacity() - self.producer.len()
    }

    /// Queue the loss record, if one is due and there is room for the record after it as well: else that would be
    /// lost at once, and the queue would fill up with loss records.
    fn report_pending(&mut self) -> bool {
        let Some(loss) = self.pending else { return true };
        let reported =
            self.room() >= 2 && encode(&Record::Loss(loss)).is_some_and(|slot| self.producer.enqueue(slot).is_ok());
        if reported {
            self.pending = None;
        }
        reported
    }

    fn count(&mut self, record: &Record) {
        self.dropped = self.dropped.saturating_add(1);
        let loss = self.pending.get_or_insert(Loss { first_tick: record.tick(), epochs: 0, others: 0 });
        let counter = if matches!(record, Record::Epoch(_)) { &mut loss.epochs } else { &mut loss.others };
        *counter = counter.saturating_add(1);
    }
}

fn encode(record: &Record) -> Option<Slot> {
    let mut bytes = [0; SLOT_LEN];
    let len = record.encode(&mut bytes)?;
    Slot::from_slice(bytes.get(..len)?).ok()
}

/// The end of the queue at the card.
pub struct RecordConsumer<'a> {
    consumer: spsc::Consumer<'a, Slot>,
}

impl<'a> RecordConsumer<'a> {
    /// The end for the task that writes.
    pub fn new(consumer: spsc::Consumer<'a, Slot>) -> Self {
        Self { consumer }
    }

    /// Move everything queued into the log; returns how many records. A record leaves the queue when the writer has
    /// taken it, so an error loses nothing: call again.
    pub fn drain<D: BlockSink>(&mut self, log: &mut SectorWriter<D>) -> Result<u32, AppendError<D::Error>> {
        let mut moved = 0;
        while let Some(slot) = self.consumer.peek() {
            log.append_encoded(slot)?;
            self.consumer.dequeue();
            moved += 1;
        }
        Ok(moved)
    }
}
