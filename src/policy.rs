//! Every constant with which the core decides something, and where its value comes from.
//!
//! What an operator can set is not here: it stands in [`Settings`](crate::Settings), with the published values as
//! defaults. Limits of an algorithm that only has to converge stand with the algorithm.
//!
//! "The flights" are the eight combinations of two fluxgates and two scalar sensors on one real flight line. What the
//! adaptive constants give on them (residual over the hindsight bound, share kept of injected anomalies) is printed by
//!
//! ```text
//! cargo test --release -p host-sim --test host adaptive_flight -- --nocapture
//! ```
//!
//! and tabulated for other values in `docs/adaptive.md`, "How the constants were chosen".

use core::ops::RangeInclusive;

// Front end

/// Total field that either sensor may read, nT. The Earth's own is 22,000 to 67,000 nT; what a large iron body adds to
/// it nearby lies well within the rest.
pub(crate) const FIELD_RANGE_NT: RangeInclusive<f64> = 1_000.0..=100_000.0;

/// The same in picotesla, the unit of the scalar reading.
pub(crate) const FIELD_RANGE_PT: RangeInclusive<i32> = 1_000_000..=100_000_000;

/// Share of its start to which the transient of the band-pass's slowest pole must have decayed before an estimator
/// learns. The slope of the background makes a transient in the scalar that the 18 columns do not share. 344 epochs at
/// the default band.
pub(crate) const SETTLED_FRACTION: f64 = 1e-3;

/// Longest dropout, s, through which the input of the band-pass is held. Scalar and columns hold the values of the same
/// epoch, so that eq. (6) goes on holding between them; the background moves little in that time.
pub(crate) const LONGEST_HOLD_S: f64 = 1.0;

// Square-root information

/// Least diagonal of the factor that forgetting may leave. Below it nothing is forgotten until something is learnt:
/// without excitation, the information in an unpenalised factor would decay until it underflows. Its square, 1e-24, is
/// far above the least normal `f32`, 1.2e-38.
pub(crate) const LEAST_DIAGONAL: f32 = 1e-12;

/// Updates between two moves of a recursion's centre to its latest coefficients. A move costs no more than an update,
/// so that this is at most a thousandth of the work; rounding errors gather over the 10,000 epochs of the default
/// memory. `cargo test -p host-sim-library --test core f64_reference -- --nocapture` prints what is left of them over a day.
pub(crate) const RECENTRE_EVERY: u32 = 1_000;

/// The same for a calibration, which starts at zero instead of at coefficients that are nearly right.
pub(crate) const CALIBRATION_RECENTRE_EVERY: u32 = 500;

// Calibration

/// Least length of the usable epochs of a calibration, s: fewer cannot carry four headings of manoeuvres.
pub(crate) const LEAST_CALIBRATION_S: f64 = 20.0;

/// Share of its bound by which a gradient may exceed it before its coefficient must leave zero: an `f32` gradient
/// summed over 18 columns whose condition is 5,000 is known no better (5,000 x 6e-8 x 18^0.5).
pub(crate) const GRADIENT_TOLERANCE: f32 = 1e-3;

// Calibration of the fluxgate

/// Fastest turn of an epoch that counts, rad/s. The mean of a turning field over an epoch of `T` is shorter than the field
/// by `F (w T)^2 / 24`: 1.9 nT at 50,000 nT. A scalar reading that stands for an instant 50 ms off, its default delay,
/// makes 0.9 nT where the body's own field there is 57 nT, which the simulated tows of `docs/measured.md` begin with.
pub(crate) const FASTEST_TURN_RAD_PER_S: f64 = 0.3;

/// What that leaves in an epoch, nT: both of them, on top of each other as noise would be.
pub(crate) const TURNING_ERROR_NT: f64 = 2.0;

/// Least length of the usable epochs, s: one circle never shows all axes, and two take this long at the fastest turn.
pub(crate) const LEAST_TURNING_S: f64 = 42.0;

/// How far an axis may be off, nT, if all that is left were an error that goes smoothly with the direction: a thousandth
/// of the field. It makes a direction cosine wrong by 0.001, and 100 nT of interference by 0.1 nT before the 18 terms
/// have taken up what of it goes with the direction.
pub(crate) const LARGEST_AXIS_ERROR_NT: f64 = 50.0;

/// Largest root mean square of what the axes leave, nT. Directions that are covered evenly multiply a smooth error by
/// 3.9 (an angle, `sqrt 15`), so that beyond 12.9 nT no turning would do; fluxgate B of the flights leaves 4.8 to 5.8 nT in the air.
pub(crate) const LARGEST_MISFIT_NT: f64 = 10.0;

/// Standard deviation with which the present settings are expected to be right, of the squares of the scales and of
/// the offsets in nT: ten times what a fluxgate on a board is off. Only what the body was not turned through heeds it.
pub(crate) const PRIOR_SHAPE: f64 = 0.3;
/// See [`PRIOR_SHAPE`].
pub(crate) const PRIOR_CENTRE_NT: f64 = 20_000.0;

// Output steering: `docs/adaptive.md`, "What is written: steering", has the table of the prices

/// Price of moving the offset by 1 nT within an epoch, in nT^2 of what is left within the band. Free moves would undo
/// the band-pass, and fill the output with what lies beyond it: at 0.0001 its differences grow three to eleven times.
pub(crate) const MOVE_PRICE: f32 = 0.01;

/// Price of an offset of 1 nT for an epoch, likewise. Below the band an offset is invisible, and would wander for ever:
/// 1,000 nT on one flight without a price, at most 169 nT with this one.
pub(crate) const OFFSET_PRICE: f32 = 1e-4;

// Level: see `docs/adaptive.md`, "The level"; the table there is printed by `cargo test -p host-sim --test host level -- --nocapture`

/// Corner of each of the two high-passes that whiten the background, Hz. Geology of 10 nT at 60 s is 0.07 nT above it.
pub(crate) const LEVEL_CORNER_HZ: f64 = 0.2;

/// Time over which the level's information is forgotten, s: ten times that of the bank. What a heading has told must last
/// until the body comes back to it.
pub(crate) const LEVEL_MEMORY_S: f64 = 10_000.0;

/// Standard deviation of a coefficient of which nothing is known, nT: permanent, induced, eddy. A steel-framed body's are
/// about as large; where a row tells anything, it is soon worth more than this. Until the body has turned for the first time it
/// decides what the other headings are taken for: twice as much leaves 1.18 nT at sea instead of 0.84.
pub(crate) const LEVEL_STD_NT: [f32; 3] = [50.0, 200.0, 150.0];

/// Least variance of a row's noise for the level, nT^2: no scalar sensor with its fluxgate is better than 0.01 nT.
pub(crate) const LEVEL_LEAST_VARIANCE: f32 = 1e-4;

/// Time over which the level's failed predictions are counted, s. Three times that of the bank: its noise is so low that
/// the flanks of a target fail for 10 s and more.
pub(crate) const LEVEL_FAILURE_S: f64 = 30.0;

/// Time in which a surprise fades by a factor of e, s: the gate is open again 5 s after an innovation of ten times its width.
pub(crate) const LEVEL_HOLD_S: f64 = 2.0;

/// Longest time over which the mean of the field's vertical part is taken, s.
pub(crate) const LEVEL_GAUGE_S: f32 = 3_600.0;

/// Time in which the output goes to a level that new coefficients say, s: slower than anything in the band. At 10 s what is let
/// go is as large in the band as the noise, and tows at sea without a calibration leave 1.37 nT instead of 0.84.
pub(crate) const LEVEL_ANCHOR_S: f64 = 20.0;

/// Corner of each of the low-passes below which the level is the level estimator's, Hz: a seventh of the band's lower edge.
pub(crate) const LEVEL_LOW_PASS_HZ: f64 = 0.015;

/// Time in which a standard deviation that is judged can change by a factor of e, s.
pub(crate) const LEVEL_JUDGE_S: f64 = 20.0;

/// Time in which the output goes from the one to the other, s.
pub(crate) const LEVEL_SWITCH_S: f64 = 10.0;

/// Standard deviation that the bank leaves over what the level estimator leaves, from which on the band becomes the level
/// estimator's. Forty tows at sea without a calibration lose nothing by up to 1.25; of the flights, whose fluxgates have errors of
/// their own, two came to 1.1 once, and would have been held there: B 5 -> 5 at 1.17 times the bound.
pub(crate) const LEVEL_TAKES_THE_BAND: f32 = 1.2;
/// The same below which the band is the bank's again. Coefficients that are let go, and targets, bring it to 0.7 now and then.
pub(crate) const LEVEL_LOSES_THE_BAND: f32 = 0.6;

// Adaptive bank: see `docs/adaptive.md` for the equations

/// Members of the bank: four that start at the calibration, one that starts at zero, and the plain one.
pub const MEMBERS: usize = 6;

/// The free members, which keep none of the calibration's values and are reinitialised in turn: one with the long
/// memory, one with the short.
pub(crate) const LONG_MEMORY: usize = 3;
/// See [`LONG_MEMORY`].
pub(crate) const SHORT_MEMORY: usize = 4;

/// The plain member learns as recursive least squares does, from rows that are not differenced and behind a wide gate:
/// where 18 terms are not enough, what they leave is no noise, and the plain fit leaves least of it in the band. The
/// residual of the sea tow is 1.14 times that of the best other method without it, 0.98 times with it.
pub(crate) const PLAIN: usize = 5;

/// Share of the calibration's information that each member keeps. Decades, so that one of them is near the right share
/// wherever the sensor sits.
pub(crate) const INFORMATION_SHARES: [f32; MEMBERS] = [1.0, 0.1, 0.01, FREE_SHARE, 0.0, FREE_SHARE];

/// Share of earlier information that a free member starts with: a millionth says nothing of the values, but which
/// combinations of coefficients are barely determined.
pub(crate) const FREE_SHARE: f32 = 1e-6;

/// What each member's log evidence is lowered by over one window, nats: its prior odds. Little for each step away from
/// the calibration; much for letting go of it, without which noise alone hands the lead to the member that learns
/// targets (flight C 5 -> 5: 3 instead of 8 keeps .959 of them instead of .968).
pub(crate) const PRIOR_COST_NATS: [f32; MEMBERS] = [0.0, 1.0, 2.0, 8.0, 10.0, 13.0];

/// How many times faster than the setting says each member forgets. The fifth remembers 200 s of the default 1,000 s:
/// without it, flight C 4 -> 5 leaves 1.176 of the bound instead of 1.080.
pub(crate) const FORGETTING_MULTIPLIERS: [f64; MEMBERS] = [1.0, 1.0, 1.0, 1.0, 5.0, 1.0];

/// Normalised innovation beyond which an epoch weighs less. Less of it keeps more of the targets and leaves more
/// residual: see the table.
pub(crate) const GATE: f32 = 1.45;

/// The same for the plain member: what a misfit of the model leaves at the crests of waves is to be learnt, not gated.
pub(crate) const PLAIN_GATE: f32 = 2.5;

/// Weight below which an epoch counts as gated: a normalised innovation of 1.8 times the gate.
pub(crate) const GATED_WEIGHT: f32 = 0.1;

/// Normalised innovation beyond which an epoch says no more about the noise, and counts as a failed prediction: one in
/// 80 of a normal distribution.
pub(crate) const INNOVATION_CLIP: f32 = 2.5;

/// Mean of `min(|r|, INNOVATION_CLIP)^2` for a standard normal `r`; the test below integrates it.
pub(crate) const CLIPPED_MEAN_SQUARE: f32 = 0.978;

/// Median of the size of a standard normal value.
pub(crate) const MEDIAN_OF_NORMAL: f32 = 0.6745;

/// Degrees of freedom of the Student distribution in which predictions are judged: so few that no spike decides.
pub(crate) const DEGREES_OF_FREEDOM: f32 = 4.0;

/// Log evidence that a member is reinitialised with, nats below the best: it must earn the lead.
pub(crate) const REINITIALISED_COST_NATS: f32 = 10.0;

/// No member's log evidence falls further below the best, nats: it can come back within two windows.
pub(crate) const LEAST_LOG_EVIDENCE: f32 = -30.0;

/// Weight of "this coefficient is zero" in a member that knows nothing, for residuals of one nT: one standard deviation
/// is 100,000 nT, and the coefficients of a real body are of the order of 10,000 nT.
pub(crate) const UNINFORMED_WEIGHT: f32 = 1e-10;

/// Least variance of the noise, nT^2: the square of 0.1 pT, a tenth of the step of a scalar reading.
pub(crate) const LEAST_NOISE_VARIANCE: f32 = 1e-8;

/// Its root, nT.
pub(crate) const LEAST_STD_NT: f32 = 1e-4;

/// Noise that is assumed where no calibration has told it, nT. It is found within half a minute.
pub(crate) const DEFAULT_NOISE_NT: f32 = 1.0;

/// Times the noise variance that a free member starts with: where the calibration no longer holds, its noise need not
/// either, and a gate that is shut learns slowly. What is too much of it is gone within a minute.
pub(crate) const FREE_NOISE_RATIO: f32 = 25.0;

/// Correlation time of what the model leaves within the band, s: 0.80 from epoch to epoch. 0.90 costs .04 of the bound
/// on B 5 -> 5.
pub(crate) const CORRELATION_S: f64 = 0.45;

/// Time over which the noise is tracked, s: longer than a target, shorter than a manoeuvre. 60 s costs .03 of the
/// targets on B 4 -> 5.
pub(crate) const NOISE_S: f64 = 30.0;

/// Window of the evidence, s. 30 to 100 s change the figures by less than 0.02.
pub(crate) const EVIDENCE_S: f64 = 60.0;

/// Least age of the coefficients whose predictions are judged, s: as long as a target's peak. 1 to 2.5 s change the
/// figures by less than 0.02.
pub(crate) const AGE_S: f64 = 1.5;

/// Time over which failed predictions are counted, s: a target fills less than half of it.
pub(crate) const FAILURE_WINDOW_S: f64 = 10.0;

/// Share of that time from which on the model is taken for wrong, and free members are reinitialised.
pub(crate) const FAILURE_SHARE: f32 = 0.5;

/// Least time between two reinitialisations, and time after a failure until the second one, s: the band-pass holds the
/// body as it was before for about as long (`SETTLED_FRACTION`).
pub(crate) const REINITIALISATION_S: f64 = 30.0;

/// The free member with the long memory is reinitialised when it has not taken the lead by then, s.
pub(crate) const TRIAL_S: f64 = 600.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipped_mean_square_is_that_of_a_normal_distribution() {
        const STEP: f64 = 1e-3;
        let density = |r: f64| libm::exp(-0.5 * r * r) / libm::sqrt(core::f64::consts::TAU);
        let clip = f64::from(INNOVATION_CLIP);
        let mean: f64 = (0..20_000)
            .map(|k| (f64::from(k) + 0.5) * STEP - 10.0)
            .map(|r| density(r) * libm::fabs(r).min(clip) * libm::fabs(r).min(clip) * STEP)
            .sum();
        assert!(libm::fabs(mean - f64::from(CLIPPED_MEAN_SQUARE)) < 5e-4, "{mean}");
    }

    #[test]
    fn both_ranges_of_the_field_are_one() {
        let pt = [FIELD_RANGE_PT.start(), FIELD_RANGE_PT.end()].map(|&pt| f64::from(pt) / 1_000.0);
        assert_eq!(pt, [*FIELD_RANGE_NT.start(), *FIELD_RANGE_NT.end()]);
    }
}
