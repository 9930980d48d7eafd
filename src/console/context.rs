//! What commands act on.

use crate::body::{TimeOfDay, after_reset};
use crate::hardware::{Stamp, System};
use crate::housekeeping::Housekeeping;
use crate::link::CalibrationSession;
use crate::sensors::fluxgate::FluxgateSettings;
use crate::sensors::grid::{FluxMark, ScalarMark};
use crate::telemetry::Outbox;

/// What commands act on, besides the settings.
pub struct ConsoleContext<'a> {
    /// The calibration.
    pub session: CalibrationSession,
    /// `None` until someone sets it.
    pub time_of_day: Option<TimeOfDay>,
    /// The way to the ship.
    pub outbox: Outbox<'a>,
    /// Tick of the latest epoch.
    pub tick: u32,
    /// How good its readings were.
    pub marks: (ScalarMark, FluxMark),
    /// Leak and battery as they were told last.
    pub housekeeping: Housekeeping,
}

impl<'a> ConsoleContext<'a> {
    /// A start, at the time that the last session has left, of epochs that are made with `fluxgate`.
    pub fn new(outbox: Outbox<'a>, fluxgate: FluxgateSettings, system: &impl System) -> Self {
        let kept = system.kept_time().and_then(|kept| after_reset(kept, system.reset_cause()));
        let time_of_day = kept.map(|time| TimeOfDay::set(time, system.stamp_us(Stamp::Other)));
        Self {
            session: CalibrationSession::new(fluxgate),
            time_of_day,
            outbox,
            tick: 0,
            marks: (ScalarMark::Missing, FluxMark::Missing),
            housekeeping: Housekeeping::default(),
        }
    }
}

impl ConsoleContext<'_> {
    /// A second began when the timer showed `stamp_us`.
    pub fn pulse(&mut self, stamp_us: u32) {
        if let Some(time_of_day) = &mut self.time_of_day {
            time_of_day.pulse(stamp_us);
        }
    }
}
