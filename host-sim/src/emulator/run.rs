//! An emulation from its settings to what it gives.

use towmag::Settings;
use towmag::estimate::Prior;
use towmag::store::Stored;

use super::emulated::Emulated;
use super::error::EmulatorError;
use super::lockstep::Lockstep;
use super::machine::Machine;
use super::onlooker::Onlooker;
use super::settings::{EmulationSettings, body_settings};
use super::twin::Twin;
use crate::pace::Pace;
use crate::recording::Input;
use crate::wire::feed::Feed;

/// Run the firmware over a recording, and hold it against the replay of the same bytes. Somebody may look on: then it goes
/// no faster than they want.
pub fn emulate(
    recording: impl Into<Input>,
    settings: &Settings,
    prior: impl Into<Prior>,
    emulation: &EmulationSettings,
    onlooker: Option<Onlooker>,
) -> Result<Emulated, EmulatorError> {
    let input = recording.into().ready()?;
    let recording = input.open()?;
    let settings = body_settings(settings, emulation, &*recording);
    settings.validate()?;
    let Prior { coefficients, information, level } = prior.into();
    let stored = Stored { settings, coefficients, information, level };
    let per_epoch = usize::from(emulation.conversions_per_epoch);
    let feed = Feed::new(recording, settings.scalar.format.build()?, per_epoch, emulation.faults.clone());
    let twin = Twin::new(&stored)?;
    let starts = 1 + emulation.faults.iter().map(|fault| fault.rows.end - fault.rows.start).sum::<u64>();
    let card_blocks = settings.log_file_h * 7_200 + u32::try_from(starts).unwrap_or(u32::MAX).min(10_000);
    let pace = onlooker.as_ref().map(|onlooker| Pace::new(onlooker.speed));
    let machine = Machine::start(&emulation.image, &stored, card_blocks, onlooker)?;
    let mut lockstep = Lockstep::new(feed, twin, machine, emulation.typed.clone(), pace);
    lockstep.run()?;
    lockstep.finish()
}
