//! The next file, made while the present one is being filled.

use super::pauses::Pauses;

use crate::log::{Card, FileMap, Maker, NewFile, Ready, VolumeError};

/// How far the next file is.
#[derive(Default)]
enum Stage {
    #[default]
    None,
    Making(Maker),
    Made(Ready),
}

/// A file that is needed now, or soon.
#[derive(Default)]
pub(super) struct NextFile {
    stage: Stage,
    pauses: Pauses,
}

impl NextFile {
    /// Make the file good that was `found` on the card, or begin a new one.
    pub(super) fn begin<C: Card>(
        &mut self,
        card: &C,
        found: Option<FileMap>,
        new: NewFile,
    ) -> Result<(), VolumeError<C::Error>> {
        self.stage = Stage::Making(match found {
            Some(map) => Maker::of(card, new.partition, map)?,
            None => Maker::new(card, new)?,
        });
        Ok(())
    }

    /// Whether it is time to begin to make one: there is none, and the last attempt was a while ago.
    pub(super) fn is_to_begin(&self, now_us: u32) -> bool {
        matches!(self.stage, Stage::None) && self.pauses.are_over(now_us)
    }

    pub(super) fn is_making(&self) -> bool {
        matches!(self.stage, Stage::Making(_))
    }

    /// Go on making it.
    pub(super) fn step<C: Card>(&mut self, card: &C) -> Result<(), VolumeError<C::Error>> {
        if let Stage::Making(maker) = &mut self.stage
            && let Some(ready) = maker.step(card)?
        {
            self.stage = Stage::Made(ready);
            self.pauses.end();
        }
        Ok(())
    }

    /// It could not be made: forget it, and wait before the next attempt.
    pub(super) fn fail(&mut self, now_us: u32) {
        self.forget();
        self.pauses.grow(now_us);
    }

    /// The card is another one, perhaps.
    pub(super) fn forget(&mut self) {
        self.stage = Stage::None;
    }

    /// The file, if it is made; it is in use from now on.
    pub(super) fn take(&mut self) -> Option<Ready> {
        let Stage::Made(ready) = self.stage else { return None };
        self.stage = Stage::None;
        Some(ready)
    }
}
