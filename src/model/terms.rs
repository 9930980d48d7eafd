//! The 18 terms of eq. (4), from the fluxgate.

use super::basis::DIAGONALS;
use super::{TERMS, TermVector};

/// Field magnitude that scales the induced and eddy columns, nT: a column value of one is 50,000 nT.
pub const UNIT_FIELD_NT: f32 = 50_000.0;

/// What each scaled column stands for in eq. (4): coefficient in the units of eq. (4) times this is the coefficient of
/// the scaled column. Penalties, bounds and steps move with it exactly.
pub const NT_PER_UNIT: [f64; TERMS] = {
    let mut scale = [UNIT_FIELD_NT as f64; TERMS];
    scale[0] = 1.0;
    scale[1] = 1.0;
    scale[2] = 1.0;
    scale
};

/// Names of the terms: `u` are the direction cosines, `B` the magnitude, `d` the derivative per second.
pub const TERM_NAMES: [&str; TERMS] = [
    "permanent x",
    "permanent y",
    "permanent z",
    "induced xx",
    "induced xy",
    "induced xz",
    "induced yy",
    "induced yz",
    "induced zz",
    "eddy x dx",
    "eddy x dy",
    "eddy x dz",
    "eddy y dx",
    "eddy y dy",
    "eddy y dz",
    "eddy z dx",
    "eddy z dy",
    "eddy z dz",
];

/// Units of the coefficients of eq. (4): permanent in nT, induced in nT per nT, eddy in seconds.
pub const TERM_UNITS: [&str; TERMS] = [
    "nT", "nT", "nT", "nT/nT", "nT/nT", "nT/nT", "nT/nT", "nT/nT", "nT/nT", "s", "s", "s", "s", "s", "s", "s", "s", "s",
];

/// Builder of the 18 columns. Immutable; what it remembers is in [`TermsState`].
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    sample_rate_hz: f32,
}

/// The direction cosines of the epoch before, if it was the epoch before.
#[derive(Clone, Copy, Debug, Default)]
pub struct TermsState {
    previous: Option<[f32; 3]>,
}

impl TermsState {
    /// Forget the direction: what comes next follows a gap.
    pub fn forget(&mut self) {
        self.previous = None;
    }
}

impl Terms {
    /// Terms at `sample_rate_hz`, which turns the backward difference into a derivative per second.
    pub const fn new(sample_rate_hz: f32) -> Self {
        Self { sample_rate_hz }
    }

    /// The columns for a fluxgate reading of magnitude `magnitude_nt` > 0, or `None` for the first epoch after a gap,
    /// which has no backward difference.
    ///
    /// Terms of eq. (4): `u_i` (3), `s u_i u_j` for i <= j (6), `s u_i du_j/dt` (9), with `s` the magnitude over
    /// [`UNIT_FIELD_NT`] and `du/dt` the first-order backward difference, per second. In the place of zz stand the
    /// sums over the diagonal: `s - 1` (the band-pass takes no notice of the constant, and f32 needs it gone) and, as
    /// `|u| = 1`, half the square of the difference.
    pub fn step(&self, state: &mut TermsState, flux_nt: [f32; 3], magnitude_nt: f64) -> Option<TermVector> {
        let u = flux_nt.map(|component| component / magnitude_nt as f32);
        let before = state.previous.replace(u)?;
        let above_one = (magnitude_nt / f64::from(UNIT_FIELD_NT) - 1.0) as f32;
        let s = 1.0 + above_one;
        let rate = s * self.sample_rate_hz;
        let change = [u[0] - before[0], u[1] - before[1], u[2] - before[2]];
        let mut terms = [0.0; TERMS];
        terms[..3].copy_from_slice(&u);
        let mut next = 3;
        for i in 0..3 {
            for j in i..3 {
                terms[next] = s * u[i] * u[j];
                next += 1;
            }
        }
        for cosine in u {
            for difference in change {
                terms[next] = cosine * (rate * difference);
                next += 1;
            }
        }
        let [[.., induced_sum], [.., eddy_sum]] = DIAGONALS;
        terms[induced_sum] = above_one;
        terms[eddy_sum] = 0.5 * rate * (change[0] * change[0] + change[1] * change[1] + change[2] * change[2]);
        Some(terms.into())
    }
}
