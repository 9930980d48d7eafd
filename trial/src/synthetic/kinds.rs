//! What a recording hides: how much, which effects, how strong.

use rand::RngExt;

use crate::answer::Kind;
use crate::random::Random;
use crate::strength::STRENGTHS;
use crate::world::effects::{self, Effect};

/// How far about a strength, either way.
const ABOUT: f64 = 0.2;
/// Effects that a recording need not tell apart: they are not hidden together.
const ALIKE: [&[&str]; 5] = [
    &["scalar_lag", "scalar_lowpass", "averaging_window", "eddy_lag"],
    &["scalar_lag", "sample_slip"],
    &["depth_gradient", "swell_induction"],
    &["fluxgate_scale", "fluxgate_nonorthogonality"],
    &["load_current", "permanent_step"],
];

/// Any kind.
pub(super) fn kind(draw: &mut Random) -> Kind {
    match draw.random::<f64>() {
        p if p < 0.25 => Kind::None,
        p if p < 0.60 => Kind::Single,
        p if p < 0.70 => Kind::Pair,
        p if p < 0.78 => Kind::UnequalPair,
        p if p < 0.85 => Kind::Triple,
        _ => Kind::Foreign,
    }
}

/// The effects to hide: all are equally likely, but none beside one that is alike. With effects of a user, every single one is
/// one of them; with one withheld, that one.
pub(super) fn effects(
    kind: Kind,
    withheld: Option<&str>,
    own: &[&'static Effect],
    draw: &mut Random,
) -> Vec<&'static Effect> {
    if let (Kind::Single, Some(withheld)) = (kind, withheld.and_then(|name| effects::named(name, own))) {
        return vec![withheld];
    }
    if kind == Kind::Single && !own.is_empty() {
        return vec![own[draw.random_range(0..own.len())]];
    }
    let all: Vec<&'static Effect> = effects::all().chain(own.iter().copied()).collect();
    let mut chosen: Vec<&'static Effect> = Vec::new();
    while chosen.len() < kind.effects() {
        let next = all[draw.random_range(0..all.len())];
        if !chosen.iter().any(|other| other.name == next.name || are_alike(other.name, next.name)) {
            chosen.push(next);
        }
    }
    chosen
}

/// About how strong each of what is hidden is.
pub(super) fn aims(kind: Kind, draw: &mut Random) -> Vec<f64> {
    let one = match kind {
        Kind::Pair => STRENGTHS[draw.random_range(0..2)],
        Kind::Triple => STRENGTHS[1],
        _ => STRENGTHS[draw.random_range(0..STRENGTHS.len())],
    };
    let strengths = match kind {
        Kind::None => Vec::new(),
        Kind::UnequalPair if draw.random_bool(0.5) => vec![STRENGTHS[0], STRENGTHS[2]],
        Kind::UnequalPair => vec![STRENGTHS[2], STRENGTHS[0]],
        // A mechanism has the size that it is asked for.
        Kind::Foreign => return vec![one],
        _ => vec![one; kind.effects()],
    };
    strengths.into_iter().map(|strength| strength * about(draw)).collect()
}

fn are_alike(one: &str, other: &str) -> bool {
    ALIKE.iter().any(|alike| alike.contains(&one) && alike.contains(&other))
}

fn about(draw: &mut Random) -> f64 {
    (1.0 - ABOUT) * libm::pow((1.0 + ABOUT) / (1.0 - ABOUT), draw.random::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn kinds_come_in_their_shares_and_nothing_is_hidden_beside_its_like() {
        let draw = &mut Random::seed_from_u64(1);
        let kinds: Vec<Kind> = (0..10_000).map(|_| kind(draw)).collect();
        let share = |of: Kind| kinds.iter().filter(|kind| **kind == of).count() as f64 / 10_000.0;
        let asked = [
            (Kind::None, 0.25),
            (Kind::Single, 0.35),
            (Kind::Pair, 0.10),
            (Kind::UnequalPair, 0.08),
            (Kind::Triple, 0.07),
            (Kind::Foreign, 0.15),
        ];
        assert!(asked.iter().all(|(kind, asked)| (share(*kind) - asked).abs() < 0.015));
        for kind in kinds.into_iter().filter(|kind| kind.effects() > 0) {
            let names: Vec<&str> = effects(kind, None, &[], draw).iter().map(|effect| effect.name).collect();
            let aims = aims(kind, draw);
            assert!(names.len() == kind.effects() && aims.len() == names.len());
            for (k, name) in names.iter().enumerate() {
                assert!(names[..k].iter().all(|other| other != name && !are_alike(other, name)), "{names:?}");
            }
            let ratio = aims.iter().fold(0.0_f64, |a, b| a.max(*b)) / aims.iter().fold(f64::MAX, |a, b| a.min(*b));
            assert_eq!(ratio > 2.0, kind == Kind::UnequalPair);
        }
    }
}
