//! What to sail beside a planned tow, so that the effects come apart that it would find and not tell apart.

use super::planned::Sown;
use super::told::{Alike, PLANNED_STRENGTH, PlannedEffect, Segment, Separated, strength};
use crate::diagnosis::manoeuvre::kind::ManoeuvreKind;
use crate::diagnosis::manoeuvre::{Confounded, Proposed, half_minutes, proposed};

/// Longest segment, minutes: as long as a calibration takes. Where that is not enough, it still tells stronger effects apart.
const LONGEST_MIN: f64 = 20.0;

/// A pair with the segment that is quickest for it.
struct Remedy {
    kind: ManoeuvreKind,
    minutes: f64,
    pair: Separated,
}

/// The segments that are quickest for the confounded pairs, those of a kind as one: the longest of them does for all.
pub(super) fn of(sown: &[Sown<'_>], effects: &[PlannedEffect]) -> Vec<Segment> {
    let mut segments: Vec<Segment> = Vec::new();
    for remedy in sown.iter().zip(effects).flat_map(|(sown, effect)| remedies(sown, effect)) {
        add(&mut segments, remedy);
    }
    segments.sort_by_key(|segment| std::cmp::Reverse(segment.separates.len()));
    segments
}

/// Of what is found at [`PLANNED_STRENGTH`] and not told apart there.
fn remedies(sown: &Sown<'_>, effect: &PlannedEffect) -> Vec<Remedy> {
    let is_found = strength(effect.found_from) <= PLANNED_STRENGTH;
    let confounded = effect.alike.iter().filter(|alike| is_found && strength(alike.apart_from) > PLANNED_STRENGTH);
    let remedy = |alike: &Alike| {
        let rivals: Vec<usize> = sown.others().filter(|&other| sown.name_of(other) == alike.name).collect();
        // Evidence adds: what the planned recording gives of it need not be sailed again.
        let known = rivals.iter().map(|&other| sown.known(other)).fold(f64::INFINITY, f64::min).min(1.0);
        let (recorded, library) = (sown.problem(), sown.problem().library);
        let pair = Confounded { library, term: &sown.term, rivals, recorded, variance: sown.variance };
        let Proposed { kind, needed_min, least_min } = proposed(&pair)?;
        let minutes = half_minutes(needed_min * (1.0 - known), least_min, LONGEST_MIN);
        let apart_from = PLANNED_STRENGTH / (known + minutes / needed_min).sqrt();
        let pair = Separated { names: [effect.name, alike.name], apart_from };
        apart_from.is_finite().then_some(Remedy { kind, minutes, pair })
    };
    confounded.filter_map(remedy).collect()
}

/// Both ways round are one pair.
fn add(segments: &mut Vec<Segment>, Remedy { kind, minutes, pair }: Remedy) {
    let [one, other] = pair.names;
    let is_it = |known: &Separated| known.names == [one, other] || known.names == [other, one];
    if segments.iter().any(|segment| segment.separates.iter().any(is_it)) {
        return;
    }
    match segments.iter_mut().find(|segment| segment.kind == kind) {
        Some(segment) => {
            segment.minutes = segment.minutes.max(minutes);
            segment.separates.push(pair);
        }
        None => segments.push(Segment { kind, minutes, separates: vec![pair] }),
    }
}
