//! The manoeuvres by name.

/// What may be sailed next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ManoeuvreKind {
    /// A shake at about 1 Hz on four headings.
    Shake,
    /// Rocking about each axis on four headings.
    FourHeadings,
    /// Rocking about each axis on eight headings.
    EightHeadings,
    /// Up and down in flat water.
    YoYo,
    /// One heading, the opposite one, and the first again, rocked.
    ThereAndBack,
    /// One heading, still, all loads off.
    Still,
    /// The same recording again with one thing changed at a time.
    OneThingChanged,
}
