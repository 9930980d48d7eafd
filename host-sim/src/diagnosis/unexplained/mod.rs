//! What is left when everything that has a name is named: which recorded input drives it, in what shape, and the effect that is proposed
//! for it. Where no input does, its course in time.

mod axes;
mod clean_reading;
mod course;
mod curve;
mod disguise;
mod drawn;
mod drivers;
mod edges;
mod effect_file;
mod judged;
mod late;
mod left;
mod loudness;
mod map;
mod outdone;
mod picture;
mod proposal;
mod steps;
mod time;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use self::drawn::Drawn;
use self::drivers::{drivers, is_beyond_chance};
use self::judged::Judged;
use self::left::Left;
use self::loudness::{Louder, is_recorded};
pub(super) use self::outdone::outdone;
use self::proposal::Proposal;
use super::evidence::localise::channel_name;
use super::findings::{ChannelFindings, Findings};
use super::policy::{DRIVER_CLEAR_SHARE, PROPOSAL_LEAST_PROBABILITY};
use super::reconstruct::prepared::Prepared;
use super::result::{ChannelGap, Description, Diagnosis, DriverForm, DriverShare, GapClosed, Verdict};
use super::shapes::group::Group;
use super::shapes::inputs;
use super::shapes::scene::Scene;

/// Findings of the tests that speak for something that comes and goes in time.
const SPEAK_FOR_TIME: [&str; 6] = ["bursts", "lines", "impulses", "rhythm", "levels", "variance"];

/// What is left of a diagnosis whose verdict says that something is; `there` are the findings of a second recording.
pub(super) fn describe(
    found: &Findings<'_>,
    diagnosis: &Diagnosis,
    there: Option<&Findings<'_>>,
    seed: u64,
) -> Option<Description> {
    if !matches!(diagnosis.verdict, Verdict::Unknown | Verdict::PartlyExplained) {
        return None;
    }
    let named: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.name).collect();
    let (channel, left) = loudest(found, &diagnosis.channels, &named);
    let (left, scene, weighed, is_floor) = clearest(channel, left, found.table);
    let there = there.map(|there| {
        let there_left = Left::of(there.channel(left.problem.channel), &[]).with(&left.portable());
        let left = if is_floor { there_left.on_the_floor() } else { there_left };
        let scene = clean_reading::scene(&left, there.table);
        (left, scene)
    });
    let draw = &mut ChaCha8Rng::seed_from_u64(seed);
    let proposed = weighed.proposed(&left, there.as_ref(), draw);
    weighed.told(&left, &scene, proposed, &named)
}

/// Against the model of the noise, or where inputs explain little of that and more of what is left above the quietest band, against
/// that; which of the two it is comes last.
fn clearest<'a>(channel: &ChannelFindings<'_>, left: Left<'a>, table: &Prepared) -> (Left<'a>, Scene, Weighed, bool) {
    let weighed = |left: &Left<'_>| {
        let scene = clean_reading::scene(left, table);
        let weighed = Weighed::of(channel, left, &scene);
        (scene, weighed)
    };
    let (scene, own) = weighed(&left);
    if own.share() >= DRIVER_CLEAR_SHARE {
        return (left, scene, own, false);
    }
    let floor = left.on_the_floor();
    let (floor_scene, other) = weighed(&floor);
    match other.share() > own.share() {
        true => (floor, floor_scene, other, true),
        false => (left, scene, own, false),
    }
}

/// An effect that is proposed, and what it closes on the second recording, if there is one.
type Proposed = (Proposal, Option<GapClosed>);

/// What may drive what is left.
struct Weighed {
    judged: Vec<Judged>,
    louder: Vec<Louder>,
    excess: f64,
    /// Most of the excess that any group takes beyond chance.
    most: f64,
    drivers: Vec<DriverShare>,
    /// By how much later than the first driver it is.
    delay_s: Option<f64>,
}

impl Weighed {
    fn of(channel: &ChannelFindings<'_>, left: &Left<'_>, scene: &Scene) -> Self {
        let drives = edges::drives(scene);
        let recorded =
            inputs::groups(scene, left.problem.channel).into_iter().chain(edges::groups(left, &drives, scene));
        let moved = [steps::groups(left, &drives, scene)];
        let sets: Vec<Vec<Group>> = recorded.chain(moved).chain(time::groups(left, scene)).collect();
        let judged: Vec<Judged> = sets.into_par_iter().filter_map(|set| best(set, left, scene)).collect();
        let louder = loudness::louder(left, scene);
        let is_in_time = channel.significant().any(|finding| SPEAK_FOR_TIME.contains(&finding.what));
        // No group can close more than all: noise that is estimated too large hides a part of the excess.
        let taken = judged.iter().filter(|judged| is_beyond_chance(judged)).map(|judged| judged.taken);
        let most = taken.fold(1.0, f64::max);
        let excess = left.excess.max(most);
        let drivers = drivers(&judged, &louder, excess, is_in_time);
        let mut weighed = Self { judged, louder, excess, most, drivers, delay_s: None };
        weighed.delay(left, scene);
        weighed
    }

    /// Sees whether a recorded driver acts late, and takes the group that says so beside the others.
    fn delay(&mut self, left: &Left<'_>, scene: &Scene) {
        let is_recorded = self.drivers.first().is_some_and(|first| is_recorded(&first.input));
        let Some(own) = self.own().filter(|_| is_recorded) else { return };
        if let Some(late) = late::late(own, inputs::quadratic(scene), left, scene) {
            self.delay_s = Some(late.delay_s);
            self.judged.push(late.judged);
        }
    }

    /// Most of the excess that a group of anything recorded closes beyond chance.
    fn share(&self) -> f64 {
        let recorded = self.judged.iter().filter(|judged| is_recorded(&judged.group.input) && is_beyond_chance(judged));
        recorded.map(|judged| judged.taken / self.excess).fold(0.0, f64::max)
    }

    /// The group of the first driver that takes most.
    fn own(&self) -> Option<&Judged> {
        let first = self.drivers.first()?;
        let own = self.judged.iter().filter(|judged| judged.group.input == first.input);
        own.max_by(|a, b| a.taken.total_cmp(&b.taken)).filter(|own| own.taken > 0.0)
    }

    /// How the first driver acts.
    fn form(&self) -> Option<DriverForm> {
        let first = self.drivers.first()?;
        let of_first = self.louder.iter().filter(|louder| louder.input == first.input);
        let by_loudness = of_first.map(|louder| louder.share).fold(0.0, f64::max) * (1.0 - self.most / self.excess);
        match self.own() {
            Some(own) if own.taken / self.excess >= by_loudness => Some(own.group.form),
            _ if by_loudness > 0.0 => Some(DriverForm::Variance),
            _ => None,
        }
    }

    /// An effect of the first driver, if it is one of something recorded and stands on parts held out, and on the second recording. The times
    /// at which a part moved were this recording's own, and make no effect: where they stand, another shape would be a piece of them.
    fn proposed(&self, left: &Left<'_>, there: Option<&(Left<'_>, Scene)>, draw: &mut ChaCha8Rng) -> Option<Proposed> {
        let own = self.own().filter(|own| own.group.is_portable() && is_proposable(&self.drivers[0], self.form()))?;
        let proposal =
            Proposal::of(own, left, effect_file::terms_that_fit, draw).filter(|proposal| proposal.is_accepted(own))?;
        let confirmed = match there {
            Some((left, scene)) => Some(proposal.frozen(left, scene, draw)?),
            None => None,
        };
        confirmed.is_none_or(|closed| closed.ci95[0] > 0.0).then_some((proposal, confirmed))
    }

    fn told(self, left: &Left<'_>, scene: &Scene, proposed: Option<Proposed>, named: &[&str]) -> Option<Description> {
        let first = self.drivers.first()?;
        let (proposal, confirmed) = proposed.map_or((None, None), |(proposal, confirmed)| (Some(proposal), confirmed));
        let of_proposal = proposal.as_ref().and_then(|proposal| proposal.course(scene));
        let (left_nt, course) = match &of_proposal {
            Some(course) => course::with_proposed(left, course),
            None => (left.robust_nt().to_vec(), course::recovered(left.robust_nt())),
        };
        let is_in_time = !is_recorded(&first.input);
        let matched = is_in_time.then(|| course::matched(&course, scene)).flatten();
        let fitted: &[Option<f64>] = if proposal.is_some() { &course } else { &[] };
        let drawn = |form| {
            let own = self.own().map(|own| &own.group);
            Drawn::new(&left_nt, fitted, form, scene).over(&first.input, own)
        };
        let (curve, map) = self.form().map_or((None, None), drawn);
        let disguised = of_proposal.and_then(|course| disguise::known_effect(&course, left, named));
        Some(Description {
            looks_like: disguised.map(|index| left.problem.library[index].spec().title),
            curve,
            map,
            form: self.form(),
            delay_s: self.delay_s,
            is_in_steps: self.own().is_some_and(|own| is_recorded(&own.group.input) && !own.group.is_portable()),
            gap_closed: proposal.as_ref().map(|proposal| proposal.closed),
            confirmed,
            is_closed_form: proposal.as_ref().is_some_and(|proposal| proposal.is_closed_form),
            effect_file: proposal.as_ref().map(effect_file::effect_file),
            matched,
            course,
            channel: channel_name(left.problem.channel),
            has_tilt: !inputs::tilts(scene).is_empty(),
            drivers: self.drivers,
        })
    }
}

/// The channel with more that has no name, and that; the scalar where both have as much.
fn loudest<'b, 'a>(
    found: &'b Findings<'a>,
    gaps: &[ChannelGap],
    named: &[&str],
) -> (&'b ChannelFindings<'a>, Left<'a>) {
    let [(scalar, of_scalar), (fluxgate, of_fluxgate)] =
        found.channels().map(|channel| (channel, Left::of(channel, named)));
    match strength(&of_fluxgate, &gaps[1]) > strength(&of_scalar, &gaps[0]) {
        true => (fluxgate, of_fluxgate),
        false => (scalar, of_scalar),
    }
}

fn strength(left: &Left<'_>, gap: &ChannelGap) -> f64 {
    strength_of(gap, left.strength(), left.z.len() as f64)
}

/// Standard deviations by which a channel has more than what is named, about: by its noise model, or, where that has taken the rest for
/// noise, by what its sensor has.
fn strength_of(gap: &ChannelGap, by_model: f64, samples: f64) -> f64 {
    match gap.verdict {
        Verdict::NoGap | Verdict::Explained => 0.0,
        Verdict::Unknown | Verdict::PartlyExplained => {
            let over_sensor = gap.excess_after_rms_nt() / gap.noise_floor_rms_nT.max(f64::MIN_POSITIVE);
            by_model.max(over_sensor * samples.sqrt())
        }
    }
}

/// The best of a set, of which the others were tried; by chance it gains as much as the best of them does.
fn best(set: Vec<Group>, left: &Left<'_>, scene: &Scene) -> Option<Judged> {
    let judged: Vec<Judged> = set.into_par_iter().filter_map(|group| Judged::of(group, left, scene)).collect();
    let by_chance = judged.iter().map(|judged| judged.by_chance).max_by(|a, b| (a.0 + a.1).total_cmp(&(b.0 + b.1)))?;
    let best = judged.into_iter().max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    Some(Judged { by_chance, ..best })
}

/// Whether an effect may be proposed: of something that was recorded, which is no randomness.
fn is_proposable(driver: &DriverShare, form: Option<DriverForm>) -> bool {
    is_recorded(&driver.input)
        && driver.probability >= PROPOSAL_LEAST_PROBABILITY
        && form.is_some_and(|form| form != DriverForm::Variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(verdict: Verdict, after_nt: f64, noise_nt: f64) -> ChannelGap {
        ChannelGap {
            channel: "scalar",
            verdict,
            residual_rms_nT: after_nt,
            residual_after_rms_nT: after_nt,
            noise_floor_rms_nT: noise_nt,
        }
    }

    #[test]
    fn a_rest_that_the_noise_model_took_for_noise_is_still_louder_than_a_small_one() {
        let taken = strength_of(&gap(Verdict::Unknown, 0.143, 0.070), 0.0, 2400.0);
        let small = strength_of(&gap(Verdict::Unknown, 0.929, 0.916), 12.0, 2400.0);
        assert!(taken > small, "{taken} {small}");
    }

    #[test]
    fn a_channel_that_is_explained_has_no_rest_to_describe() {
        assert_eq!(strength_of(&gap(Verdict::Explained, 0.5, 0.1), 9.0, 2400.0), 0.0);
        assert!(strength_of(&gap(Verdict::PartlyExplained, 0.1, 0.1), 9.0, 2400.0) > 0.0);
    }
}
