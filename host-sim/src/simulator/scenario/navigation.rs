//! The columns that a survey needs: where the body was, how high above the bottom, how fast, when, and a second scalar.

use std::io::{self, Write};

use super::{Scenario, Simulation};

/// Which of them a scenario writes.
pub(super) struct Navigation<'a> {
    simulation: &'a Simulation,
    /// Seconds since 1970 of the first row.
    first_utc_s: Option<f64>,
    second_nt: Option<Vec<f64>>,
}

impl<'a> Navigation<'a> {
    pub(super) fn new(simulation: &'a Simulation) -> Self {
        let field = &simulation.scenario().field;
        let first_utc_s = simulation.scenario().columns.utc.then(|| field.first_utc_s().ok()).flatten();
        Self { simulation, first_utc_s, second_nt: simulation.second_nt() }
    }

    /// Names of the columns, each after a comma.
    pub(super) fn write_names(&self, out: &mut impl Write) -> io::Result<()> {
        let Scenario { columns, ship, .. } = self.simulation.scenario();
        let names = [
            (columns.position, ",latitude_deg,longitude_deg"),
            (columns.altitude, ",altitude_m"),
            (columns.speed, ",speed_m_per_s"),
            (self.first_utc_s.is_some(), ",utc_s"),
            (ship.is_some(), ",cable_out_m"),
            (self.second_nt.is_some(), ",scalar2_nT"),
        ];
        names.iter().filter(|(is_there, _)| *is_there).try_for_each(|(_, names)| write!(out, "{names}"))
    }

    /// The values of a row, each after a comma.
    pub(super) fn write_row(&self, out: &mut impl Write, row: usize) -> io::Result<()> {
        let scenario = self.simulation.scenario();
        let (track, columns) = (self.simulation.track(), &scenario.columns);
        let [north_m, east_m, depth_m] = track.place_m[row];
        if columns.position {
            let place_m = self.simulation.ship_m().map_or([north_m, east_m], |ship_m| ship_m[row]);
            // A millimetre, and no more.
            let [latitude_deg, longitude_deg] = track.degrees(place_m).unwrap_or([f64::NAN; 2]);
            write!(out, ",{latitude_deg:.8},{longitude_deg:.8}")?;
        }
        if let (true, Some(bottom)) = (columns.altitude, &scenario.bottom) {
            write!(out, ",{:.3}", bottom.depth_m - depth_m)?;
        }
        if let (true, Some(speed_m_per_s)) = (columns.speed, scenario.motion.speed_m_per_s()) {
            write!(out, ",{speed_m_per_s:.3}")?;
        }
        if let Some(first_utc_s) = self.first_utc_s {
            write!(out, ",{:.3}", first_utc_s + self.simulation.signals().epochs_s()[row])?;
        }
        scenario.ship.map_or(Ok(()), |ship| write!(out, ",{:.2}", ship.cable_out_m))?;
        // To a picotesla, as the body counts.
        self.second_nt.as_ref().map_or(Ok(()), |second_nt| write!(out, ",{:.3}", second_nt[row]))
    }
}
