//! Which effects are taken.

/// Effects in a channel at most: more of them are rather pieces of one that is not known.
pub(crate) const MOST_EFFECTS: usize = 4;
/// Times that all effects are looked for in a channel before the search ends with what it has. Three effects that are there
/// take eight. Set by hand: bounds the work.
pub(crate) const MOST_SCANS: usize = 10;
/// Second looks at what was found, at most. A third one changed nothing on any recording of the trial.
pub(crate) const REVIEWS: usize = 2;
/// Logarithm of the chance to name any one effect that is not there: with twenty of them, one clean recording in 3,000.
/// On estimated noise models it is several times that.
pub(crate) const LOG_FALSE_ALARM: f64 = -11.0;
/// The same of a moment, a period, a frequency or a cone that is looked for: somewhere in a recording such a shape meets what models of
/// noise and targets have wrong. Counted on 360 recordings of `host-sim trial --setting tuning`, seeds 504 to 506: of what was
/// between the two, two of three were not there.
pub(crate) const LOG_FALSE_ALARM_SEARCHED: f64 = -40.0;
/// The same of a cone, whose noise has to be louder from row to row. Counted on tuning seed 845 (as ever of that setting), 118 recordings
/// in which one was near: the 20 dead zones were at -47 and below. Of what is none, noise that grows with an angle came to -208 and -45, a
/// fluxgate's scale to -53, jitter to -48, a clock to -34, a load to -26, all others not beyond -24; but for the first no cone was named
/// there, as it goes once what is there is fitted.
pub(crate) const LOG_FALSE_ALARM_CONE: f64 = -25.0;
/// GLRT by ranks below which a cone is no finding, whatever it was looked for in: that of such a chance with one degree of freedom at least.
pub(crate) const CONE_LEAST_RANKS_GLRT: f64 = -2.0 * LOG_FALSE_ALARM_CONE;
/// The same from which on a cone comes before all else. Set by hand between the cones and what is none of the count above.
pub(crate) const LOG_CONE_FIRST: f64 = -100.0;
/// The same from which what looks like an effect is a gap, although no part of the recording that it was not fitted to bears it out.
/// Counted on 240 recordings that hide nothing, seeds 532 and 533: none was below -21.
pub(crate) const LOG_UNPROVED: f64 = -30.0;
/// What a smooth function of the direction may explain beside a cone, as a share of what the cone does. Of 24 dead zones (`host-sim trial
/// --withhold dead_zone --only single --setting tuning --seed 1846 --minutes 5`) it is at most 0.019, of two put into real flights 0.01 to
/// 0.03; of noise by angle named a dead zone otherwise 0.065 and 0.11.
pub(crate) const SMOOTH_MOST: f64 = 0.04;
/// Share of what was found already that one more effect must explain at least: less may be the imperfection of that.
/// Set by hand.
pub(crate) const SMALL: f64 = 0.003;
/// The same where the chance is below [`LOG_FALSE_ALARM_SEARCHED`] and nothing was looked for. Counted on `host-sim trial --setting
/// tuning`, seeds 521, 522 and 524: of those between the two, three of three were there.
pub(crate) const SMALL_BUT_CLEAR: f64 = 0.0005;
/// Logarithm of the chance below which that holds of what was looked for, too. Set by hand.
pub(crate) const LOG_CLEAR_SEARCHED: f64 = -60.0;
/// The same where one of the two is random. Set by hand.
pub(crate) const SMALL_RANDOM: f64 = 0.01;
/// The same where both are: one colour stands for the noise and a random effect, and what that misses looks like another
/// one. Set by hand.
pub(crate) const SMALL_BOTH_RANDOM: f64 = 0.2;
/// GLRT above which no held-out check is needed.
pub(crate) const BEYOND_DOUBT: f64 = 1000.0;
/// Share of its GLRT that an effect that can be bent to fit a few rows must explain on held-out blocks too. Set by hand.
pub(crate) const LEAST_HELD_OUT: f64 = 0.1;
/// Share of the excess that an effect must close on parts held out, with its interval above zero; and one whose column was
/// recorded, which has no shape that could be bent. Counted on `host-sim trial --setting tuning`, seeds 505 to 507: of what was
/// named below 0.4, half was not there.
pub(crate) const LEAST_CLOSED_SHARE: f64 = 0.3;
pub(crate) const LEAST_CLOSED_BY_COLUMN: f64 = 0.1;
/// Share of the excess that the model of a random effect must account for on parts held out. Set by hand.
pub(crate) const LEAST_ACCOUNTED: f64 = 0.5;
/// How near to the edge of an effect's band a periodic effect is the cut itself, Hz: twice the resolution of a minute.
pub(crate) const BAND_EDGE_HZ: f64 = 0.02;
/// Evidence within which candidates are fitted jointly before the best is chosen, and how many of them.
pub(crate) const REFINED_MARGIN: Margin = Margin { absolute: 25.0, share: 0.35 };
/// How many candidates are fitted jointly at most.
pub(crate) const MOST_REFINED: usize = 4;
/// Evidence within which another effect is fitted in the place of one.
pub(crate) const RIVAL_MARGIN: Margin = REFINED_MARGIN;
/// Evidence by which another effect must be better to take the place of one.
pub(crate) const BETTER: f64 = 0.5;
/// Correlation of what two effects add below which they cancel. Set by hand.
pub(crate) const OPPOSITE: f64 = -0.85;
/// Two effects whose evidence differs by less are not told apart: odds of 150 to 1.
pub(crate) const INDISTINGUISHABLE: f64 = 10.0;
/// A linear parameter beyond this many times what is plausible is no finding.
pub(crate) const BEYOND_PLAUSIBLE: f64 = 20.0;

/// A difference in evidence that counts as near: the larger of the two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    pub(crate) absolute: f64,
    /// Of the size of the evidence.
    pub(crate) share: f64,
}

impl Margin {
    /// About so much evidence.
    pub(crate) fn of(&self, evidence: f64) -> f64 {
        self.absolute.max(self.share * evidence.abs())
    }
}
