//! What drives a rest that has no name, and what is proposed of it.

/// Standard deviations by which a group must be likelier than it is with the residual turned round in time. Set by hand.
pub(crate) const DRIVER_BEYOND_CHANCE: f64 = 4.0;
/// How sharply the share that an input closes on parts held out says that it is the driver: odds are the share that is left, to this
/// power. Set by hand on `host-sim trial --setting tuning --minutes 4`: `--only foreign` with seeds 701 and 702, `--only single --withhold` of
/// five effects with seed 711. On the 83 recordings of `DRIVER_BEHIND` any value of 6 to 10 is as good.
pub(crate) const DRIVER_SHARPNESS: f64 = 8.0;
/// No share is counted as more than this: shapes are never exact.
pub(crate) const DRIVER_MOST_CLOSED: f64 = 0.95;
/// Gain in log likelihood that an input may have beyond what its shapes gain on parts held out. Of 171 described recordings of `host-sim trial
/// --setting tuning --only foreign --recordings 300 --minutes 4 --seed 747` and 110 of the 200 of `--only foreign --seed 9204`, which was spent:
/// mean log loss 0.90 and 0.80 without, 0.89 and 0.74 with it; any of 30 to 100 is as good. With `DRIVER_TIME_START` of 0.3 in place of 0.2 it is
/// 0.86 and 0.71.
pub(crate) const DRIVER_BEYOND_HELD_OUT: f64 = 60.0;
/// Weight of the share of loudness that an input explains beside the share of the excess. With `DRIVER_BEHIND`: a course that the shapes of its
/// input fit badly is louder at times, too, and at 1 `time_irregular` was said of it.
pub(crate) const DRIVER_TIME_LOUDNESS_WEIGHT: f64 = 0.5;
/// The same of an input that comes back to where it was: what follows it is as loud as its neighbours in time, so that time explains no less.
/// By log loss on described recordings of 14 mechanisms of `host-sim trial --only foreign --recordings 300 --minutes 4 --seed 9206`, which was
/// spent (83), and of six of `--setting tuning --recordings 600 --seed 751` (114), the latter first: 0.389 and 1.059 with 0.5,
/// 0.351 and 1.030 with 0.6, 0.336 and 1.046 with 0.8, which takes one of theirs from those that nothing recorded drives.
pub(crate) const DRIVER_LOUDNESS_WEIGHT: f64 = 0.6;
/// Gain in log likelihood, beyond that of turned squares, from which what an input explains of the loudness is not told of time as well.
/// Set by hand; counted on 254 described recordings of tuning seed 751 and of 9206, which was spent, of which inputs close less than half: that
/// gain of the attitude is above 60 in 26 of 42 whose noise it drives, and in 5 of 163 that nothing recorded drives.
pub(crate) const DRIVER_LOUDNESS_LEAST_GAIN: f64 = 60.0;
/// Share that an input must close to be as likely as something in time that nobody recorded, where the tests of the residual speak for time,
/// and else as nothing at all; and of that of the two for which they do not speak.
pub(crate) const DRIVER_TIME_START: f64 = 0.3;
pub(crate) const DRIVER_NONE_SHARE: f64 = 0.1;
/// Probability of a driver from which an effect is proposed. Set by hand: as likely as not.
pub(crate) const PROPOSAL_LEAST_PROBABILITY: f64 = 0.5;
/// Lower end of the interval of the share that a proposal closes, at least. Counted on `host-sim trial --only foreign --minutes 4`, seeds
/// 9206 (diagnosed again), 9207 and half of 9208, which were spent: of 13 proposals where nothing recorded drives the rest nine are below,
/// of 318 where something does 11.
pub(crate) const PROPOSAL_LEAST_CLOSED: f64 = 0.22;
/// Gain in log likelihood, beyond what the residual turned round in time gives, that a proposal needs beside the price of all that was
/// tried. Derived: a chance of 1 in 10^4.
pub(crate) const PROPOSAL_LEAST_GAIN: f64 = 9.2;
/// Groups and waves of shapes that are tried on a recording, about.
pub(crate) const PROPOSAL_TRIED: f64 = 200.0;
/// Share of a proposed course that a known effect's own shape makes, from which the proposal is that effect in disguise. Set by hand.
pub(crate) const DISGUISED: f64 = 0.9;
/// Share of what all shapes close that a closed form must close. Set by hand.
pub(crate) const PROPOSAL_SPARSE_AS_GOOD: f64 = 0.97;
/// Reduction of the sum of squares on parts held out, over the noise's variance, from which another shape belongs to a closed form. Derived:
/// the best of 100 shapes by chance, chi squared with one degree of freedom at 1 in 500.
pub(crate) const PROPOSAL_LEAST_TAKEN: f64 = 10.0;
/// Shapes that a file has at most.
pub(crate) const PROPOSAL_MOST_TERMS: usize = 64;
/// What an input loses in log odds for each root of the log likelihood by which another makes the residual likelier. This, the weight of
/// loudness and `DRIVER_NONE_SHARE` are of the least log loss, rounded, on 83 described recordings of strength 3 and more of `host-sim
/// trial --setting tuning --minutes 4`: `--only foreign --recordings 15` with seeds 811 to 818 and 831, `--only single --withhold` of 15
/// effects with seed 9391 and of two with 9392. Log loss 0.96 before, 0.85 with them; right 59 before, 63 with them,
/// all on the recordings that they were fitted to, when what chance gives of the whole residual was taken off, and not of the rest. `trial/baselines/driver_calibration.py` does not fit these yet.
pub(crate) const DRIVER_BEHIND: f64 = 0.3;
/// Reduction of the sum of squares, over the noise's variance, that each more relay of a history with edges must make. Derived: the
/// best of 2,000 relays of four columns each by chance, chi squared with 4 degrees of freedom at 1 in 2,000 is 20, and half as much again.
pub(crate) const EDGES_LEAST_GAIN: f64 = 30.0;
/// Standard deviations by which what is left must move more at events than at the best kind of them by chance. Counted on described
/// recordings of `host-sim trial --only foreign --recordings 300 --minutes 4`, seeds 9206 and 9207, and two of 9208, which were spent: of 19
/// bolts that turn 17 are above, of nine motors that nobody recorded none.
pub(crate) const STEPS_BEYOND_CHANCE: f64 = 1.5;
/// Probability that none of this tells the driver: shared by all inputs alike. Counted on `host-sim trial --setting tuning --only foreign
/// --minutes 4`, seeds 701 (40 recordings) and 731 (36): of 34 that were said with 0.91 in the mean 82 % were right. With this and
/// [`DRIVER_SHARPNESS`] the error of the probabilities is 0.033 on 548 described recordings of the unseen seed 9208, 0.024 on 893 of 9206 to
/// 9208 (`trial/baselines/driver_calibration.py`). A fit to the 345 of 9206 and 9207 alone, odds a quarter sharper and 0.1, had 0.050 on 9208.
pub(crate) const DRIVER_UNSURE: f64 = 0.12;
/// Share of the excess that inputs explain, from which the noise model has not taken much of it for noise. Set by hand: half.
pub(crate) const DRIVER_CLEAR_SHARE: f64 = 0.5;
/// Logarithm of how much likelier one input alone must make the whole gap than effects that are named beside a rest and the best shapes of
/// that, for these not to be named. Derived: a chance of 1 in 20.
pub(crate) const OUTDONE_LEAST_GAIN: f64 = 3.0;
/// Share of the squares of what is left that a map must close on stretches held out beyond its curve, to be drawn. Set by hand.
pub(crate) const MAP_LEAST_MORE: f64 = 0.1;
