//! What to sail next, so that what is still confounded comes apart.

use super::diagnosis::{EffectFound, NextManoeuvre, Verdict};

/// Pairs of effects that look alike, what tells them apart, and for how many minutes at the least.
const SEPARATIONS: [(&[&str], &str, f64); 6] = [
    (
        &["scalar_lag", "scalar_lowpass", "averaging_window", "eddy_lag", "sample_slip", "clock_drift"],
        "Shake the body at about 1 Hz, a few degrees, on four headings at right angles: only above 0.5 Hz do a delay, a low-pass, a window and slow eddy currents differ.",
        2.0,
    ),
    (
        &["depth_gradient", "swell_induction"],
        "In flat water, let the body go up and down by a few metres on one heading: a gradient follows the depth, swell is not there.",
        5.0,
    ),
    (
        &[
            "fluxgate_scale",
            "fluxgate_nonorthogonality",
            "fluxgate_bias",
            "fluxgate_nonlinearity",
            "fluxgate_temperature_drift",
        ],
        "Sail eight headings and rock the body in roll and pitch by 10 degrees on each: on two reciprocal headings the fluxgate's errors look alike.",
        8.0,
    ),
    (
        &["permanent_step", "permanent_temperature", "load_current"],
        "Repeat the first heading with the same manoeuvres, once at once and once after the temperature has settled, and switch every load on and off by a schedule of your own.",
        6.0,
    ),
    (
        &["heading_error", "second_order", "dead_zone"],
        "Sail eight headings with large roll and pitch, then the same with the scalar sensor turned by 45 degrees in its clamp.",
        10.0,
    ),
    (&["mains_alias", "load_current"], "Stay on one heading without manoeuvres, far from the shore, loads off.", 4.0),
];

/// The manoeuvre for the first effect that has rivals, or for a gap without a name.
pub(super) fn next_manoeuvre(verdict: Verdict, effects: &[EffectFound]) -> Option<NextManoeuvre> {
    if let Some(effect) = effects.iter().find(|effect| !effect.indistinguishable_from.is_empty()) {
        let mut separates = vec![effect.name];
        separates.extend(effect.indistinguishable_from.iter().take(2));
        let pair = |group: &&(&[&str], &str, f64)| group.0.contains(&separates[0]) && group.0.contains(&separates[1]);
        let own = |group: &&(&[&str], &str, f64)| group.0.contains(&separates[0]);
        let (_, text, minutes) =
            SEPARATIONS.iter().find(pair).or_else(|| SEPARATIONS.iter().find(own)).unwrap_or(&SEPARATIONS[4]);
        return Some(NextManoeuvre { separates, text: (*text).into(), minutes: *minutes });
    }
    let text = "Repeat the recording with the same manoeuvres and one thing changed at a time: loads off, another speed, another place. What changes with it is the cause.";
    (verdict == Verdict::Unknown).then(|| NextManoeuvre {
        separates: vec!["unknown"],
        text: text.into(),
        minutes: 10.0,
    })
}
