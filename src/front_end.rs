//! From an epoch to the row that the estimators see: checks, terms, band-pass, and what happens at gaps.

use crate::epoch::{Epoch, Rejection};
use crate::filter::{BandPass, BandPassDesign, BandPassError, BandPassState};
use crate::model::{Row, TERMS, TermVector, Terms, TermsState};
use crate::policy::{FIELD_RANGE_NT, FIELD_RANGE_PT, LONGEST_HOLD_S, SETTLED_FRACTION};

/// One channel per term, and the scalar last.
const CHANNELS: usize = TERMS + 1;

/// Checks, terms and band-pass: immutable configuration.
#[derive(Clone, Copy, Debug)]
pub struct FrontEnd {
    terms: Terms,
    band_pass: BandPass,
    settling_epochs: u32,
    longest_hold_epochs: u32,
}

/// What the front end remembers from epoch to epoch.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrontEndState {
    tick: Option<u32>,
    terms: TermsState,
    active: Option<ActiveFilter>,
}

impl FrontEndState {
    /// What the band-pass remembers of the 18 columns, and of the scalar; `None` before the first epoch.
    pub(crate) fn filter(&self) -> Option<&BandPassState<CHANNELS>> {
        self.active.as_ref().map(|active| &active.filter)
    }
}

/// The band-pass in motion.
#[derive(Clone, Copy, Debug)]
struct ActiveFilter {
    filter: BandPassState<CHANNELS>,
    input: [f32; CHANNELS],
    reference_pt: i32,
    epochs: u32,
    held: u32,
}

/// An accepted epoch.
#[derive(Clone, Copy, Debug)]
pub struct Observation {
    /// The columns as they are, for the interference itself.
    pub terms: TermVector,
    /// The same and the scalar, band-passed alike, for the estimators.
    pub band_passed: Row,
    /// Scalar reading, picotesla.
    pub scalar_pt: i32,
    /// Whether the transient of the filter's start is over.
    pub settled: bool,
    /// Whether the filter has begun anew with this epoch.
    pub is_first: bool,
}

impl FrontEnd {
    /// Front end with the given band-pass; its sample rate is that of the epochs.
    pub fn new(design: BandPassDesign) -> Result<Self, BandPassError> {
        let band_pass = design.build()?;
        Ok(Self {
            terms: Terms::new(design.sample_rate_hz as f32),
            band_pass,
            settling_epochs: band_pass.settling_samples(SETTLED_FRACTION),
            longest_hold_epochs: libm::round(LONGEST_HOLD_S * design.sample_rate_hz) as u32,
        })
    }

    /// One epoch. A rejected one leaves the estimators untouched; a short dropout is held, a longer one restarts the
    /// filter.
    pub fn step(&self, state: &mut FrontEndState, epoch: &Epoch) -> Result<Observation, Rejection> {
        let missed = state.tick.map_or(0, |tick| epoch.tick.wrapping_sub(tick).wrapping_sub(1));
        state.tick = Some(epoch.tick);
        if missed > 0 {
            state.terms.forget();
            self.hold(state, missed);
        }
        let columns = accept(epoch).and_then(|(scalar_pt, flux_nt, magnitude_nt)| {
            let terms = self.terms.step(&mut state.terms, flux_nt, magnitude_nt);
            terms.map(|terms| (scalar_pt, terms)).ok_or(Rejection::AfterGap)
        });
        match columns {
            Ok((scalar_pt, terms)) => Ok(self.filter(state, scalar_pt, terms)),
            Err(rejection) => {
                if rejection != Rejection::AfterGap {
                    state.terms.forget();
                }
                self.hold(state, 1);
                Err(rejection)
            }
        }
    }

    /// Let the filter stand on its last input for `epochs`, or stop it when the dropout gets too long.
    fn hold(&self, state: &mut FrontEndState, epochs: u32) {
        let Some(active) = &mut state.active else { return };
        active.held = active.held.saturating_add(epochs);
        if active.held > self.longest_hold_epochs {
            state.active = None;
            return;
        }
        for _ in 0..epochs {
            self.band_pass.step(&mut active.filter, &active.input);
        }
    }

    /// The band-pass.
    pub fn band_pass(&self) -> &BandPass {
        &self.band_pass
    }

    fn filter(&self, state: &mut FrontEndState, scalar_pt: i32, terms: TermVector) -> Observation {
        let active = state.active.get_or_insert_with(|| {
            let input = channels(&terms, 0.0);
            ActiveFilter { filter: BandPassState::steady(&input), input, reference_pt: scalar_pt, epochs: 0, held: 0 }
        });
        // Integers until the reference is subtracted: an f32 in between would cost 0.004 nT.
        let scalar_nt = (scalar_pt - active.reference_pt) as f32 / 1000.0;
        active.input = channels(&terms, scalar_nt);
        active.held = 0;
        active.epochs = active.epochs.saturating_add(1);
        let filtered = self.band_pass.step(&mut active.filter, &active.input);
        let band_passed = Row { terms: TermVector::from_fn(|i, _| filtered[i]), scalar_nt: filtered[TERMS] };
        Observation {
            terms,
            band_passed,
            scalar_pt,
            settled: active.epochs > self.settling_epochs,
            is_first: active.epochs == 1,
        }
    }
}

fn channels(terms: &TermVector, scalar_nt: f32) -> [f32; CHANNELS] {
    let mut channels = [scalar_nt; CHANNELS];
    channels[..TERMS].copy_from_slice(terms.as_slice());
    channels
}

/// The readings of an epoch and the fluxgate's magnitude, if both are there and in range.
#[inline(always)] // Else every epoch takes 290 instructions more.
pub(crate) fn accept(epoch: &Epoch) -> Result<(i32, [f32; 3], f64), Rejection> {
    let scalar_pt = epoch.scalar_pt.ok_or(Rejection::ScalarMissing)?;
    if !FIELD_RANGE_PT.contains(&scalar_pt) {
        return Err(Rejection::ScalarOutOfRange);
    }
    let flux_nt = epoch.flux_nt.ok_or(Rejection::FluxMissing)?;
    let [x, y, z] = flux_nt.map(f64::from);
    // f64: in f32 a step of the magnitude is 0.004 nT, and the sum of the induced terms multiplies it.
    let magnitude_nt = libm::sqrt(x * x + y * y + z * z);
    // A NaN or an infinite component makes the magnitude one, and no range contains it.
    if !FIELD_RANGE_NT.contains(&magnitude_nt) {
        return Err(Rejection::FluxOutOfRange);
    }
    Ok((scalar_pt, flux_nt, magnitude_nt))
}
