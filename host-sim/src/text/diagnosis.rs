//! Parts of a diagnosis in plain words, with their numbers: the same on the terminal and on the page.

pub use super::diagnosis_headline::sentence;
use super::number::{short, three_digits};
use super::quantity::quantity;
use crate::diagnosis::{
    ColumnForm, ColumnWay, Consequence, Diagnosis, EffectFound, GapClosed, ParameterEstimate, RoundingFound,
    SimulationUsed, Stage, Unexplained, Verdict,
};
use crate::effects::{FIRMWARE_MISMATCH, Spec};

/// Probability below which an effect is not told as a cause.
const LIKELY: f64 = 0.5;

/// A verdict in a word or two.
pub fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NoGap => "no gap",
        Verdict::Explained => "explained",
        Verdict::PartlyExplained => "partly explained",
        Verdict::Unknown => "cause unknown",
    }
}

/// What a diagnosis is doing.
pub fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Terms => "fitting the 18 terms",
        Stage::Fluxgate => "searching for effects of the fluxgate",
        Stage::Scalar => "searching for effects of the scalar sensor",
        Stage::Verdict => "weighing what was found",
        Stage::Rest => "looking for what drives the rest",
        Stage::Second => "trying it on the second recording",
    }
}

/// Whether the device's own outputs are in doubt, so that nothing else may be claimed.
pub fn is_firmware_mismatch(diagnosis: &Diagnosis) -> bool {
    diagnosis.effects.iter().any(|effect| effect.name == FIRMWARE_MISMATCH)
}

/// Whether what was named is more likely a part of something that the library does not have.
pub(super) fn is_rather_unknown(diagnosis: &Diagnosis) -> bool {
    main_cause(diagnosis, "unknown") > LIKELY
}

/// Whether an effect is likely enough to be told as a cause.
pub fn is_likely(effect: &EffectFound) -> bool {
    effect.probability >= LIKELY
}

/// That an effect, or what a diagnosis says where there is none, is the main cause.
pub fn main_cause(diagnosis: &Diagnosis, name: &str) -> f64 {
    let candidate = diagnosis.candidates.iter().find(|candidate| candidate.name == name);
    candidate.map_or(0.0, |candidate| candidate.probability)
}

/// That an effect is at work; said in words too where it more likely is not.
pub fn at_work(effect: &EffectFound) -> String {
    let probability = percent(effect.probability);
    if is_likely(effect) { probability } else { format!("{probability}: less likely than not") }
}

/// That an effect is the main cause, where that is another number than that of its being at work.
pub fn as_main_cause(diagnosis: &Diagnosis, effect: &EffectFound) -> Option<String> {
    let probability = percent(main_cause(diagnosis, effect.name));
    (probability != percent(effect.probability)).then_some(probability)
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

/// All parameters of an effect, and how the field follows a recorded column: what it is called, and the value.
pub fn parameters<'a>(specs: &'a [&Spec], effect: &'a EffectFound) -> impl Iterator<Item = (String, String)> + 'a {
    let way = effect.column.iter().map(|way| ("how".to_owned(), column_way(way)));
    effect.parameters.iter().map(|estimate| parameter(specs, effect, estimate)).chain(way)
}

fn column_way(way: &ColumnWay) -> String {
    let form = match way.form {
        ColumnForm::Additive => "added to the field whatever the attitude",
        ColumnForm::AlongField => "a moment in body axes",
    };
    let delay = match way.delay_s {
        s if s > 0.0 => format!(", {s:.1} s after the column"),
        s if s < 0.0 => format!(", {:.1} s before the column", -s),
        _ => String::new(),
    };
    let low_pass = (way.time_constant_s > 0.0).then(|| format!(", low-pass of {:.1} s", way.time_constant_s));
    format!("{form}{delay}{}", low_pass.unwrap_or_default())
}

/// A share or a probability in percent, never rounded to all or nothing. Far below nothing it is no more than that.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p < -100.0 => "below −100 %".into(),
        p if (99.5..100.0).contains(&p) => "over 99 %".into(),
        p if p < 0.5 && p > 0.0 => "under 1 %".into(),
        p => format!("{p:.0} %").replace('-', "−"),
    }
}

/// What the gap means for whoever looks for iron.
pub fn consequence(diagnosis: &Diagnosis, meaning: &Consequence) -> String {
    let [noise, with_gap, with_effects] = meaning.smallest_moment_Am2.map(three_digits);
    let [place_noise, place_gap, _] = meaning.place_m.map(three_digits);
    let Consequence { distance_m, speed_m_per_s, .. } = meaning;
    let is_named = diagnosis.effects.iter().any(|effect| effect.channel == "scalar");
    let taken_off =
        if is_named { format!(", with what is named taken off {with_effects} A m²") } else { String::new() };
    format!(
        "An object passed at {distance_m} m and {speed_m_per_s} m/s must have {with_gap} A m² to be found nine times in ten, \
         without the gap {noise} A m²{taken_off}. The place of one that is only just found is known to {place_gap} m along \
         the track, without the gap to {place_noise} m."
    )
}

/// The simulation of the user's own that a recording was held against.
pub fn simulation(used: &SimulationUsed) -> String {
    let terms = if used.holds_terms { "its 18 terms held" } else { "the 18 terms fitted to the recording" };
    let beyond = used.beyond_nt.map_or("it says no more than 18 terms and its noise".into(), |nt| {
        format!("beyond 18 terms it says {} nT rms", three_digits(nt))
    });
    let side = if used.offset_s < 0.0 { "behind" } else { "ahead of" };
    let SimulationUsed { file, rate_hz, .. } = used;
    let offset = format!("{:.4}", used.offset_s.abs());
    format!(
        "{file}, {} rows a second, its clock {offset} s {side} the recording's; {terms}; {beyond}",
        three_digits(*rate_hz)
    )
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
    listed(&names.iter().map(|name| title(specs, name)).collect::<Vec<&str>>())
}

/// Some things as a list in a sentence.
pub fn listed(things: &[&str]) -> String {
    match things.split_last() {
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
        "rhythm" => "noise that is louder in a rhythm, as in every third row",
        "loudness" => "noise that is louder the more the body moves, or where it points",
        "levels" => "a reading that hops between few levels",
        "attitude" => "something that goes with the attitude of the body",
        "memory" => "something that follows the attitude with a delay or by its history",
        "inputs" => "something that follows a recorded input",
        "motion" => "something that follows each moment's motion, in no fixed way",
        "unproved" => "the shape of a known effect, which other parts of the recording do not bear out",
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

/// That a search ended with what it had, if it did.
pub fn cut_short(diagnosis: &Diagnosis) -> Option<&'static str> {
    diagnosis.is_cut_short.then_some(
        "The search went on for so long that it ended with what it had: what is left may hold more than is named.",
    )
}

/// What to do where no manoeuvre is asked for.
pub fn advice(diagnosis: &Diagnosis) -> &'static str {
    if is_firmware_mismatch(diagnosis) {
        return "Compare the version and the settings in the body's log with those of this program and replay the log \
                with the same ones. Until the two agree, nothing else about this recording is judged.";
    }
    let is_any_likely = diagnosis.effects.iter().any(is_likely);
    match diagnosis.verdict {
        Verdict::NoGap => "Nothing: the compensation knows all that this recording shows. Survey as usual.",
        Verdict::Explained if is_any_likely => {
            "Remove what is named, record again and diagnose that: it should then show no gap. Nothing is left \
             to tell apart."
        }
        Verdict::PartlyExplained if !is_rather_unknown(diagnosis) && is_any_likely => {
            "Look into what is named, the most probable first. Once it is removed, record again and diagnose that: what \
             is left is easier to name when it is alone."
        }
        _ => "Repeat the recording with one thing changed at a time: what changes with it is the cause.",
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
            [0.997, 1.0, 0.004, 0.0, 0.94, -0.2, -43.7].map(percent),
            ["over 99 %", "100 %", "under 1 %", "0 %", "94 %", "−20 %", "below −100 %"]
        );
    }
}
