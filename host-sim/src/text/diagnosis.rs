//! A diagnosis in plain words: the answer first, with its numbers.

use super::number::{short, three_digits};
use super::quantity::quantity;
use crate::diagnosis::{
    ChannelGap, Diagnosis, EffectFound, GapClosed, ParameterEstimate, RoundingFound, Stage, Unexplained, Verdict,
};
use crate::effects::{FIRMWARE_MISMATCH, Spec};

/// An excess below this share of the noise is called small rather than given in nT.
const SMALL: f64 = 0.1;
/// Effects of a sensor that the sentence names.
const MOST_NAMED: usize = 2;
/// Share of the gap below which an effect is not in the sentence.
const LEAST_TOLD: f64 = 0.01;

/// The verdict in a sentence or two.
pub fn sentence(diagnosis: &Diagnosis) -> String {
    if is_firmware_mismatch(diagnosis) {
        return "What the body logged as its output differs from a replay of what it logged as its input: \
                the firmware or its settings are not those of this program."
            .into();
    }
    match diagnosis.verdict {
        Verdict::NoGap => no_gap(diagnosis),
        Verdict::Unknown => {
            let known = diagnosis.specs.len();
            format!("{}, and none of the {known} known effects causes it.", differs(diagnosis, diagnosis.gap.channel))
        }
        Verdict::Explained => explained(diagnosis),
        Verdict::PartlyExplained if is_rather_unknown(diagnosis) => {
            format!("{} More likely it is something that this program does not know.", explained(diagnosis))
        }
        Verdict::PartlyExplained => format!("{} Something else is left.", explained(diagnosis)),
    }
}

/// What a diagnosis is doing.
pub fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Terms => "fitting the 18 terms",
        Stage::Fluxgate => "searching for effects of the fluxgate",
        Stage::Scalar => "searching for effects of the scalar sensor",
        Stage::Verdict => "weighing what was found",
        Stage::Second => "trying it on the second recording",
    }
}

/// Whether the device's own outputs are in doubt, so that nothing else may be claimed.
pub fn is_firmware_mismatch(diagnosis: &Diagnosis) -> bool {
    diagnosis.effects.iter().any(|effect| effect.name == FIRMWARE_MISMATCH)
}

/// Whether what was named is more likely a part of something that the library does not have.
fn is_rather_unknown(diagnosis: &Diagnosis) -> bool {
    diagnosis.candidates.iter().any(|candidate| candidate.name == "unknown" && candidate.probability > 0.5)
}

/// The sensor of a channel.
pub fn sensor(channel: &str) -> &'static str {
    match channel {
        "scalar" => "scalar magnetometer",
        "fluxgate" => "fluxgate's magnitude",
        _ => "firmware's output",
    }
}

/// A parameter of an effect: what it is called, and its value with unit and interval.
pub fn parameter(specs: &[&Spec], effect: &EffectFound, estimate: &ParameterEstimate) -> (String, String) {
    let known =
        spec(specs, effect.name).and_then(|spec| spec.parameters.iter().find(|known| known.name == estimate.name));
    let unit = known.map_or("", |known| known.unit);
    let shown = if effect.load.is_some() && unit == "nT" { "nT/A" } else { unit };
    let text = match estimate.value {
        Some(value) => quantity(value, estimate.ci95, shown),
        None => "not identified on this recording".into(),
    };
    (bare(&estimate.name, unit), text)
}

/// A share in percent, never rounded to all or nothing.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        p if (99.5..100.0).contains(&p) => "over 99 %".into(),
        p if p < 0.5 && p > 0.0 => "under 1 %".into(),
        p => format!("{p:.0} %").replace('-', "−"),
    }
}

/// A share of the gap with its interval.
pub fn closed(closed: &GapClosed) -> String {
    let [low, high] = closed.ci95.map(percent);
    format!("{} ({low} to {high})", percent(closed.fraction))
}

/// The share that an effect closes on a second recording, and whether that is any.
pub fn confirmed(on_second: &GapClosed) -> String {
    let told = closed(on_second);
    if on_second.ci95[0] > 0.0 { told } else { format!("{told}: not confirmed") }
}

/// What is written about an effect.
pub fn spec<'a>(specs: &[&'a Spec], name: &str) -> Option<&'a Spec> {
    specs.iter().copied().find(|spec| spec.name == name)
}

/// A name in plain words: that of an effect, or what a diagnosis says where there is none.
pub fn title<'a>(specs: &[&'a Spec], name: &str) -> &'a str {
    match name {
        FIRMWARE_MISMATCH => "a firmware that differs from its replay",
        "none" => "nothing: noise alone",
        "unknown" => "something that is not in the library",
        _ => spec(specs, name).map_or("an effect without a name", |spec| spec.title),
    }
}

/// A name in plain words as a heading: without its article, with a capital.
pub fn label(specs: &[&Spec], name: &str) -> String {
    let title = title(specs, name);
    let bare = ["a ", "an ", "the "].iter().find_map(|article| title.strip_prefix(article)).unwrap_or(title);
    capital(bare)
}

/// `text` with a capital at the start.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Names of effects in plain words, as a list.
pub fn list(specs: &[&Spec], names: &[&str]) -> String {
    let titles: Vec<&str> = names.iter().map(|name| title(specs, name)).collect();
    match titles.split_last() {
        Some((last, [])) => (*last).into(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

/// What stands out in a test that knows no effect.
pub fn unexplained(rest: &Unexplained) -> String {
    let what = match rest.what {
        "bursts" => "bursts: for moments or stretches it is louder than noise",
        "lines" => "a tone or a band of frequencies that is louder than noise",
        "variance" => "noise that is louder or quieter in some minutes than in others",
        "impulses" => "jumps or spikes now and then that are too large and too many for noise",
        "attitude" => "something that goes with the attitude of the body",
        "memory" => "something that follows the attitude with a delay or by its history",
        other => other,
    };
    let chance = if rest.p_value < 1e-12 { "below 10⁻¹²".into() } else { three_digits(rest.p_value) };
    format!("{}: {what} (chance from noise {chance})", sensor(rest.channel))
}

/// What the recorder rounds to, and how much of the noise that is.
pub fn rounding(found: &RoundingFound) -> String {
    let told = |sensor: &str, step_nt: f64, share: f64| {
        format!("{sensor} in steps of {} nT, {} of its noise power", short(step_nt), percent(share))
    };
    let scalar = told("scalar", found.scalar_nT, found.scalar_noise_share);
    format!("{scalar}; {}", told("fluxgate", found.flux_nT, found.flux_noise_share))
}

/// What to do where no manoeuvre is asked for.
pub fn advice(diagnosis: &Diagnosis) -> &'static str {
    if is_firmware_mismatch(diagnosis) {
        return "Compare the version and the settings in the body's log with those of this program and replay the log \
                with the same ones. Until the two agree, nothing else about this recording is judged.";
    }
    match diagnosis.verdict {
        Verdict::NoGap => "Nothing: the compensation knows all that this recording shows. Survey as usual.",
        Verdict::Explained => {
            "Remove what is named, record again and diagnose that: it should then show no gap. Nothing is left \
             to tell apart."
        }
        Verdict::PartlyExplained if !is_rather_unknown(diagnosis) => {
            "Look into what is named, the most probable first. Once it is removed, record again and diagnose that: what \
             is left is easier to name when it is alone."
        }
        Verdict::PartlyExplained | Verdict::Unknown => {
            "Repeat the recording with one thing changed at a time: what changes with it is the cause."
        }
    }
}

fn no_gap(diagnosis: &Diagnosis) -> String {
    let floor = three_digits(diagnosis.gap.noise_floor_rms_nT);
    format!(
        "No gap: the {} looks like the simulation, down to its noise of {floor} nT rms.",
        sensor(diagnosis.gap.channel)
    )
}

/// Each sensor with an effect, the one with the larger gap first.
fn explained(diagnosis: &Diagnosis) -> String {
    let main = diagnosis.gap.channel;
    let mut channels: Vec<&ChannelGap> = diagnosis.channels.iter().collect();
    channels.sort_by_key(|channel| channel.channel != main);
    let mut is_first = true;
    let sentences = channels.iter().filter_map(|channel| {
        let mut effects: Vec<&EffectFound> =
            diagnosis.effects.iter().filter(|effect| effect.channel == channel.channel).collect();
        if effects.is_empty() {
            return None;
        }
        let differs = differs(diagnosis, channel.channel);
        // Said once is enough.
        let differs = if is_first { differs } else { differs.replace(" from the simulation", "") };
        is_first = false;
        Some(format!("{differs}; {}.", shares(&diagnosis.specs, &mut effects)))
    });
    sentences.collect::<Vec<_>>().join(" ")
}

/// "The scalar magnetometer differs from the simulation by 0.40 nT rms".
fn differs(diagnosis: &Diagnosis, channel: &str) -> String {
    let sensor = sensor(channel);
    let (excess_nt, floor_nt) = excess_nt(diagnosis, channel);
    if excess_nt < SMALL * floor_nt || excess_nt == 0.0 {
        let floor = three_digits(floor_nt);
        return format!("The {sensor} differs from the simulation by less than its noise of {floor} nT rms");
    }
    format!("The {sensor} differs from the simulation by {} nT rms", three_digits(excess_nt))
}

/// What a channel shows beyond its noise, and its noise.
fn excess_nt(diagnosis: &Diagnosis, channel: &str) -> (f64, f64) {
    if channel == diagnosis.gap.channel {
        return (diagnosis.gap.excess_rms_nT, diagnosis.gap.noise_floor_rms_nT);
    }
    let of = |gap: &ChannelGap| {
        ((gap.residual_rms_nT.powi(2) - gap.noise_floor_rms_nT.powi(2)).max(0.0).sqrt(), gap.noise_floor_rms_nT)
    };
    diagnosis.channels.iter().find(|gap| gap.channel == channel).map_or((0.0, 0.0), of)
}

/// "a delay of 51 ms (48 to 54) explains 94 % of it, slow eddy currents 3 %".
fn shares(specs: &[&Spec], effects: &mut [&EffectFound]) -> String {
    effects.sort_by(|a, b| b.gap_closed.fraction.total_cmp(&a.gap_closed.fraction));
    let share = |(index, effect): (usize, &&EffectFound)| {
        let (what, share) = (with_size(specs, effect), percent(effect.gap_closed.fraction));
        if index == 0 { format!("{what} explains {share} of it") } else { format!("{what} {share}") }
    };
    // What closes next to nothing is no answer, save where there is no other.
    let telling = effects.iter().filter(|effect| effect.gap_closed.fraction >= LEAST_TOLD).count().clamp(1, MOST_NAMED);
    let mut parts: Vec<String> = effects.iter().enumerate().take(telling).map(share).collect();
    match effects.len() - telling {
        0 => {}
        1 => parts.push("and one more is named below".into()),
        more => parts.push(format!("and {more} more are named below")),
    }
    parts.join(", ")
}

/// An effect with its size where one number says it, or with its moment.
fn with_size(specs: &[&Spec], effect: &EffectFound) -> String {
    let title = match &effect.load {
        Some(load) => format!("the current of the load {load}"),
        None => title(specs, effect.name).into(),
    };
    let moment = spec(specs, effect.name).and_then(Spec::moment).and_then(|index| effect.parameters.get(index));
    match (effect.parameters.as_slice(), moment) {
        ([only], _) if only.value.is_some() => format!("{title} of {}", parameter(specs, effect, only).1),
        (_, Some(moment)) if moment.value.is_some() => format!("{title} at {}", parameter(specs, effect, moment).1),
        _ => title,
    }
}

/// A name without its unit and underscores: `x_nT_per_K` is "x".
fn bare(name: &str, unit: &str) -> String {
    let suffix = format!("_{}", unit.replace('/', "_per_").to_lowercase());
    let cut = name.len().saturating_sub(suffix.len());
    let has_unit = !unit.is_empty() && name.to_lowercase().ends_with(&suffix);
    name[..if has_unit { cut } else { name.len() }].replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_lose_their_unit() {
        assert_eq!(bare("lag_s", "s"), "lag");
        assert_eq!(bare("x_nT_per_K", "nT/K"), "x");
        assert_eq!(bare("frequency_hz", "Hz"), "frequency");
        assert_eq!(bare("axis_azimuth_deg", "deg"), "axis azimuth");
        assert_eq!(bare("samples", "samples"), "samples");
    }

    #[test]
    fn shares_are_never_rounded_to_all_or_nothing() {
        assert_eq!(
            [0.997, 1.0, 0.004, 0.0, 0.94, -0.2].map(percent),
            ["over 99 %", "100 %", "under 1 %", "0 %", "94 %", "−20 %"]
        );
    }
}
