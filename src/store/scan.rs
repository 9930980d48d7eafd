//! What the two sectors hold.

use super::body_settings::Stored;
use super::error::StoreError;
use super::image::{BLANK, Content, SLOT_LEN, SlotBytes, decode};
use embedded_storage::nor_flash::ReadNorFlash;

/// Two sectors of a flash, each of which can be erased without the other, and nothing else in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashSectors {
    /// Offset of each sector in the flash, bytes.
    pub sectors: [u32; 2],
    /// Length of either, bytes: a multiple of [`SLOT_LEN`].
    pub sector_len: u32,
}

/// How the flash was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Blank: nothing was ever stored.
    Fresh,
    /// The latest image is intact.
    Intact,
    /// The storing of a later image was cut short: the one before it holds.
    FellBack,
    /// The latest image is of another firmware: the latest one of this firmware holds, if there is any.
    OtherVersion,
    /// There is something, but no intact image: the defaults hold.
    Lost,
}

impl core::fmt::Display for Condition {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Fresh => "settings: none stored yet, defaults hold",
            Self::Intact => "settings: intact",
            Self::FellBack => "settings: the last change was cut short by a power cut, those before it hold",
            Self::OtherVersion => "settings: the latest are of another firmware, older ones or defaults hold",
            Self::Lost => "settings: no intact copy in the flash, defaults hold and the calibration is gone",
        })
    }
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opened {
    /// The image that holds; `None` where there is none.
    pub stored: Option<Stored>,
    /// How the flash was found; to be told to the operator unless it is [`Condition::Intact`].
    pub condition: Condition,
}

/// A slot of the region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// 0 or 1.
    pub(super) sector: usize,
    /// From 0.
    pub(super) slot: u32,
}

impl FlashSectors {
    /// Slots in a sector.
    pub(super) fn slots(&self) -> u32 {
        self.sector_len / SLOT_LEN as u32
    }

    /// Offset of a slot in the flash.
    pub(super) fn offset(&self, place: Place) -> u32 {
        self.sectors[place.sector & 1] + place.slot * SLOT_LEN as u32
    }

    /// Whether the sectors are whole slots, lie in the flash, and do not touch each other.
    pub(super) fn fits(&self, capacity: usize) -> bool {
        let [a, b] = self.sectors;
        let end = u64::from(a.max(b)) + u64::from(self.sector_len);
        self.sector_len >= SLOT_LEN as u32
            && self.sector_len.is_multiple_of(SLOT_LEN as u32)
            && a.abs_diff(b) >= self.sector_len
            && end <= capacity as u64
            && u32::try_from(end).is_ok()
    }
}

/// What there is in one sector.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SectorSurvey {
    /// Slot after the last that is not blank: the first that can be written.
    pub(super) end: u32,
    /// Slot and sequence number of the latest image of this firmware.
    pub(super) image: Option<(u32, u32)>,
    /// Highest sequence number of any whole image.
    pub(super) highest: Option<u32>,
    /// The last slot that is not blank is junk.
    ends_in_junk: bool,
    /// The first slot is not as a whole image leaves it, and others hold something: an erasure or a first write was cut.
    begins_broken: bool,
}

impl SectorSurvey {
    fn note(&mut self, slot: u32, content: &Content) {
        match *content {
            Content::Blank => return,
            Content::Image { sequence, .. } => {
                self.highest = self.highest.max(Some(sequence));
                if self.image.is_none_or(|(_, latest)| latest <= sequence) {
                    self.image = Some((slot, sequence));
                }
            }
            Content::Foreign { sequence } => self.highest = self.highest.max(Some(sequence)),
            Content::Junk => {}
        }
        let junk = *content == Content::Junk;
        self.begins_broken |= self.end == 0 && (junk || slot > 0);
        self.ends_in_junk = junk;
        self.end = slot + 1;
    }
}

/// Look at every slot of a sector.
pub(super) fn survey<F: ReadNorFlash>(
    flash: &mut F,
    region: &FlashSectors,
    sector: usize,
) -> Result<SectorSurvey, StoreError<F::Error>> {
    let mut survey = SectorSurvey::default();
    for slot in 0..region.slots() {
        let bytes = read(flash, region, Place { sector, slot })?;
        survey.note(slot, &decode(&bytes));
    }
    Ok(survey)
}

/// The bytes of a slot.
pub(super) fn read<F: ReadNorFlash>(
    flash: &mut F,
    region: &FlashSectors,
    place: Place,
) -> Result<SlotBytes, StoreError<F::Error>> {
    let mut bytes = [BLANK; SLOT_LEN];
    flash.read(region.offset(place), &mut bytes).map_err(StoreError::Flash)?;
    Ok(bytes)
}

/// The latest image of this firmware in either sector.
pub(super) fn newest(surveys: &[SectorSurvey; 2]) -> Option<Place> {
    let [a, b] = surveys.map(|survey| survey.image);
    let in_second = match (a, b) {
        (Some((_, a)), Some((_, b))) => b > a,
        (a, _) => a.is_none(),
    };
    let (sector, image) = if in_second { (1, b) } else { (0, a) };
    image.map(|(slot, _)| Place { sector, slot })
}

/// How the flash was found.
pub(super) fn condition(region: &FlashSectors, surveys: &[SectorSurvey; 2], newest: Option<Place>) -> Condition {
    let [first, second] = surveys;
    let highest = first.highest.max(second.highest);
    let Some(newest) = newest else {
        return match highest {
            Some(_) => Condition::OtherVersion,
            None if first.end == 0 && second.end == 0 => Condition::Fresh,
            None => Condition::Lost,
        };
    };
    let (own, other) = if newest.sector == 0 { (first, second) } else { (second, first) };
    // The other sector is only written to when this one is full; until then its state is that of long ago.
    let cut = own.ends_in_junk || (own.end == region.slots() && other.begins_broken);
    if cut {
        Condition::FellBack
    } else if own.image.map(|(_, sequence)| sequence) != highest {
        Condition::OtherVersion
    } else {
        Condition::Intact
    }
}
