//! Why a run cannot go on.

/// The program does what the chip does not bear, or what nothing here models.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint(pub String);
