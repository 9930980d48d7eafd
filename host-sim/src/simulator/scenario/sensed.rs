//! A made recording as the body's drivers have read it.

use towmag::Epoch;

use super::Recorded;

/// Readings that the sensors have sent and the body has not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lost {
    /// Of the scalar sensor.
    pub scalar: usize,
    /// Of the fluxgate.
    pub fluxgate: usize,
}

impl Recorded<'_> {
    /// Put what the body has in the place of what the sensors have sent: `epochs` is one a row.
    pub fn sensed(&mut self, epochs: &[Option<Epoch>]) -> Lost {
        let mut lost = Lost::default();
        let valid = self.simulation.valid();
        for (row, epoch) in epochs.iter().enumerate().take(valid.len()) {
            let scalar_nt = epoch.and_then(|epoch| epoch.scalar_pt).map(|pt| f64::from(pt) / 1e3);
            let flux_nt = epoch.and_then(|epoch| epoch.flux_nt).map(|flux_nt| flux_nt.map(f64::from));
            lost.scalar += usize::from(valid[row] && scalar_nt.is_none());
            lost.fluxgate += usize::from(flux_nt.is_none());
            self.readings.scalar_nt[row] = scalar_nt.unwrap_or(f64::NAN);
            self.readings.flux_nt[row] = flux_nt.unwrap_or([f64::NAN; 3]);
        }
        self.is_sensed = true;
        lost
    }
}
