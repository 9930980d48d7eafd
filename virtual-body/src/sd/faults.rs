//! What a bad day does to a card.

/// A fault of the card, or of its socket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Somebody takes it out, or its contacts open.
    Removed,
    /// It is back.
    Inserted,
    /// Its supply sags for a moment: it loses its state, and the body keeps its own.
    PowerLost,
    /// It is busy with itself for so long, milliseconds, once it has been given a block.
    Stalls(u32),
    /// Its ECC gives up on the next block that is read.
    ReadError,
    /// It refuses the next block that is written.
    WriteError,
    /// It can be read only, for good.
    ReadOnly,
    /// One bit in so many, on the average, is wrong on the wire; 0: none.
    BitErrors(u32),
}
