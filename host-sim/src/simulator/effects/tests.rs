//! What holds for all effects.
