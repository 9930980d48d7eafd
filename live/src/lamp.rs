//! Lamps: how the parts of the system are, each in a word or two.

use serde::Serialize;

/// How bad it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// Nothing is known of it.
    #[default]
    Unknown,
    /// As it should be.
    Good,
    /// To be looked at.
    Warn,
    /// Somebody has to do something.
    Bad,
}

/// One lamp. The word says all; the level only how it is coloured.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Lamp {
    /// How bad it is.
    pub level: Level,
    /// What a person reads.
    pub word: String,
}

impl Lamp {
    /// A lamp at this level.
    pub fn new(level: Level, word: impl Into<String>) -> Self {
        Self { level, word: word.into() }
    }
}

/// All lamps.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Lamps {
    /// The scalar sensor and the fluxgate.
    pub sensor: Lamp,
    /// What the compensation does with the readings.
    pub adaptation: Lamp,
    /// Whether the epochs are logged on the body.
    pub log: Lamp,
    /// Whether the body's card takes them.
    pub card: Lamp,
    /// How well the cable carries.
    pub cable: Lamp,
    /// The body's clock.
    pub time: Lamp,
    /// What is kept on the ship.
    pub ship: Lamp,
}
