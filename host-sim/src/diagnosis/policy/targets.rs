//! Targets: what is taken for one, and what is done with it.

/// Nearest distance of a dipole over the speed that is looked for, s: from what two rows show to what the background takes.
pub(crate) const TARGET_DISTANCES_S: [f64; 2] = [0.25, 12.0];
/// What a dipole must explain over the noise around it to be looked at, and to be a target. Three amplitudes, and some 1e5
/// independent moments and distances in an hour: 45 would be one by chance in 1e4 hours of normal noise. Set by hand.
pub(crate) const TARGET_COARSE_GLRT: f64 = 35.0;
pub(crate) const TARGET_GLRT: f64 = 50.0;
/// Standard deviations of the fluxgate's magnitude from which it tells whether it has an anomaly. Derived: a ratio of 1 and
/// one of 0 are four standard errors apart.
pub(crate) const TARGET_SEEN_STRENGTH: f64 = 4.0;
/// Size in the fluxgate over that in the scalar of what both have. Derived: half way between all and nothing, and as far
/// above.
pub(crate) const TARGET_RATIOS: [f64; 2] = [0.5, 1.6];
/// What a dipole may leave where it is, over the noise around it, if the fluxgate does not tell. Set by hand.
pub(crate) const TARGET_LEFT_MOST: f64 = 2.0;
/// What a dipole must explain over the noise around it for nothing but a target to look like it, what it may leave of the power where it
/// is, and over the noise around it, and how much likelier it is in advance, as a logarithm of the odds, which the fluxgate may speak
/// against. Set by hand on `host-sim trial --setting tuning --only none --seed 811`, where four of six alarms without noise of the
/// direction were targets of 0.6 to 1.6 nT that no fluxgate tells.
pub(crate) const TARGET_CLEAR_GLRT: f64 = 100.0;
pub(crate) const TARGET_CLEAR_MISFIT: f64 = 0.03;
pub(crate) const TARGET_CLEAR_LEFT: f64 = 1.3;
pub(crate) const TARGET_CLEAR_LOG_ODDS: f64 = 3.0;
/// Distances over the speed that it may have, s: what is nearer may be a knock, and of a wider one the background takes so much that two
/// of them, one against the other, look like much else, and geology like one: it is as much less likely, and the fluxgate must speak for
/// it. Set by hand: 4 s on the sample, where 6 s found two.
pub(crate) const TARGET_CLEAR_DISTANCES_S: [f64; 2] = [0.5, 4.0];
/// Mean square of what is left around it, over that of noise, at most: near a large target its flanks are left. Set by hand.
pub(crate) const TARGET_CLEAR_NOISE: f64 = 1.5;
/// Where more is left than so many times the noise, targets stand out of that instead, and one that the fluxgate does not tell is
/// this many standard deviations of it, at least. Set by hand: it may be large unknown targets, too.
pub(crate) const TARGET_MUCH_LEFT: f64 = 10.0;
pub(crate) const TARGET_CLEAR_SIGMAS: f64 = 5.0;
/// Targets that the fluxgate does not tell, per second, at most. Set by hand: two in three minutes.
pub(crate) const TARGETS_UNSEEN_PER_S: f64 = 2.0 / 180.0;
/// Share of a recording that targets may be in which only what was left unexplained shows: what is left all over is something else. Set by
/// hand between the 0.06 and 0.08 of two grids of lines past iron (seeds 22 and 3 of `grids::diagnosed`) and the 0.27 of eight minutes
/// with a gap that follows the depth, whose effects are withheld.
pub(crate) const TARGETS_OF_REST_MOST: f64 = 0.2;
/// Share of its power that the background must leave of a dipole at a distance, for the matched filter to know it. Set by
/// hand.
pub(crate) const TARGET_LEAST_SHARE: f64 = 0.1;
/// Standard deviations from which a row stands out of what the 18 terms leave, and the share of the rows that may, for the
/// terms to be fitted without them. Set by hand.
pub(crate) const TARGET_OUTLIER_SIGMAS: f64 = 4.0;
pub(crate) const TARGET_TRIMMED_MOST: f64 = 0.6;
/// Moments that are looked at more closely in a round, at most: the best. Bounds the work.
pub(crate) const TARGET_MOST_SPOTS: usize = 32;
/// Share of the windows of a spectrum that are quieter than the one that tells what is left beside targets. Set by hand: below the
/// middle, as a large wide target is in half of four minutes.
pub(crate) const QUIETER_THAN_TARGETS: f64 = 0.3;
/// Probability from which a target is listed; what is left out or fitted of a weaker one harms little. Set by hand.
pub(crate) const TARGET_LISTED: f64 = 0.9;
/// Width from which on one is not listed, s: a dipole that is as wide as may be is background as often as not. Seen on answers: of those listed
/// at seeds 616 and 619 three of 1103 large targets are lost, and of 226 that a stranger's recordings invent 17, none of its 591.
pub(crate) const TARGET_WIDEST_S: f64 = 19.0;
/// Rounds in which targets are looked for beside those found.
pub(crate) const TARGET_ROUNDS: usize = 6;
/// What is nearer to a larger one, in distances, waits until that is known. Set by hand.
pub(crate) const TARGET_SHADOW_DISTANCES: f64 = 5.0;
/// But no further than this, s.
pub(crate) const TARGET_SHADOW_MOST_S: f64 = 30.0;
/// Share of the power where it is that a dipole may leave. Set by hand: a hull is no dipole, but a dipole at the wrong place is
/// none either.
pub(crate) const TARGET_MISFIT_MOST: f64 = 0.2;
/// What is much smaller and nearer to a target than this, in distances, is a part of it: no hull is a dipole. Set by hand.
pub(crate) const TARGET_CLOSE_DISTANCES: f64 = 4.0;
pub(crate) const TARGET_PART_MOST: f64 = 0.3;
/// Two dipoles are one whose moments are no further apart than this, in the larger distance, and whose distances differ by no more than
/// this factor. Set by hand.
pub(crate) const TARGET_MET_DISTANCES: f64 = 0.7;
pub(crate) const TARGET_MET_RATIO: f64 = 2.0;
/// How much larger or smaller the dipole of a target may become from round to round. Set by hand, on real flights with targets put in, where
/// one of 129 nT became one of 1,618.
pub(crate) const TARGET_SIZE_RATIO: f64 = 2.0;
/// What a dipole has wrong of a target is told where that is so many standard deviations of the noise. Set by hand: an error of a tenth is
/// twice the noise there.
pub(crate) const TARGET_ERROR_SIGMAS: f64 = 20.0;
/// Rows where what its dipole has wrong of a target may be larger than this, in standard deviations of the noise, are left out: step by
/// step, the first of them where they leave enough rows, the others where a rest is left beside those. Set by hand; docs/tried.md has what
/// other steps did ("Targets that are no dipoles on a straight line").
pub(crate) const TARGET_ERRORS_TRUSTED: [f64; 5] = [10.0, 3.0, 1.0, 0.3, 0.1];
pub(crate) const TARGET_STEPS_AT_FIRST: usize = 3;
/// The least share of a target that is taken to be wrong. Seen on 100 recordings of tuning seed 845 that hide nothing, with one to three
/// targets of three dipoles each, 3 to 400 nT, passed at a speed and a distance that vary by 5 and 4 %: with rows left out from 10, 40
/// and 100 standard deviations on the same four false alarms, and with 10 a third of the steps was lost.
pub(crate) const TARGET_LEAST_ERROR: f64 = 0.01;
/// Share of the usable rows that targets must leave. Set by hand.
pub(crate) const TARGET_LEAST_LEFT: f64 = 0.6;
/// And what the further steps must. Set by hand, as those.
pub(crate) const TARGET_FURTHER_LEAST_LEFT: f64 = 0.2;
/// Periods that a load must have within the recording not to be held against targets in its place: a single target may be a pulse of
/// a few, the others at rows where it does not show. Set by hand on `host-sim trial --setting tuning --only single --targets yes
/// --seed 832`, where a load of three periods was one target.
pub(crate) const TARGET_PERIODS: f64 = 8.0;
/// Share of its size that a dipole may have wrong. Set by hand: a straight line at constant speed describes a target to a few per cent.
pub(crate) const TARGET_ERROR: f64 = 0.1;
/// Where it is smaller than this it is not fitted. Set by hand.
pub(crate) const TARGET_TAIL_SIGMAS: f64 = 0.02;
