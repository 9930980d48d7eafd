//! A real recording that effects are put into.

use super::csv::RecordedCsv;
use crate::error::TrialError;
use crate::sizing::{Column, beside, rms, term_columns, without_background};
use crate::world::effects::{self, Effect};
use crate::world::{Noise, Readings, World, magnitudes};

/// A recording that effects are put into, and the effects that may be.
pub struct RealRecording {
    name: String,
    text: String,
    csv: RecordedCsv,
    pub(super) world: World,
    pub(super) effects: Vec<&'static Effect>,
}

impl RealRecording {
    /// Read the text of a CSV file; messages call it `name`. `injectable` names the effects that need no other physics
    /// than what was recorded, in the order in which they come; those that the trial has no model of are left out.
    ///
    /// # Errors
    ///
    /// When it lacks a column, has less than 60 s of valid rows, or no effect is left.
    pub fn read(name: &str, text: String, injectable: &[String]) -> Result<Self, TrialError> {
        let csv = RecordedCsv::read(name, &text)?;
        let effects: Vec<&Effect> = injectable.iter().filter_map(|name| effects::named(name, &[])).collect();
        if effects.is_empty() {
            return Err(TrialError::NothingToPutIn { name: name.into() });
        }
        Ok(Self { name: name.into(), world: world(&csv), csv, text, effects })
    }

    /// What messages call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its text, untouched.
    pub fn csv(&self) -> &str {
        &self.text
    }

    /// What a hindsight fit of the 18 terms leaves of the scalar, and of the fluxgate's magnitude less the field that the
    /// scalar then gives, nT rms.
    pub(crate) fn residual_rms_nt(&self) -> [f64; 2] {
        [self.world.noise.band_rms_nt(), self.world.flux_noise_nt]
    }

    /// Its text with other readings.
    pub(super) fn with_readings(&self, readings: &Readings) -> String {
        self.csv.with_readings(readings)
    }
}

/// What was recorded, with what the 18 terms leave of it as its noise.
fn world(csv: &RecordedCsv) -> World {
    let mut readings_nt = vec![None; csv.grid_rows];
    csv.usable().iter().for_each(|row| readings_nt[row.place] = Some(row.readings_nt));
    let mut world = World::of_recording(csv.first_time_s, &readings_nt);
    let clean = world.clean();
    let columns: Vec<Column> = term_columns(&world).into_iter().map(|term| Column::unit(0, term)).collect();
    let rest = beside(&without_background(&clean.scalar_nt), &columns);
    let magnitude = without_background(&magnitudes(&clean.flux_nt));
    world.noise = Noise::white(rms(&rest));
    // What the scalar takes for the field, less the background, is that rest.
    world.flux_noise_nt = rms(&magnitude.iter().zip(&rest).map(|(f, s)| f - s).collect::<Vec<f64>>());
    world
}
