//! The verdict in at most two lines: the answer first, then how much of the gap it is.

use super::diagnosis::{
    capital, is_firmware_mismatch, is_likely, is_rather_unknown, main_cause, parameter, percent, sensor, spec, title,
    verdict,
};
use super::number::three_digits;
use super::wrap::wrapped;
use crate::diagnosis::{ChannelGap, Diagnosis, EffectFound, Verdict};
use crate::effects::Spec;

/// Characters of a line.
const LINE: usize = 100;
/// Lines at most.
const LINES: usize = 2;
/// Effects that are named at most.
const MOST_NAMED: usize = 2;
/// An excess below this share of the noise is called small rather than given in nT.
const SMALL: f64 = 0.1;
/// Shares of a gap that add up to more than this are not told side by side.
const WHOLE: f64 = 1.005;

/// How much is told of an effect beside its name: what is left out first where the lines are full comes first.
#[derive(Clone, Copy)]
enum Detail {
    Interval,
    Value,
    Name,
}

/// The gap of a sensor.
struct Excess {
    /// `scalar` or `fluxgate`.
    channel: &'static str,
    excess_nt: f64,
    noise_nt: f64,
}

/// The verdict in a sentence or two of at most 200 characters.
pub fn sentence(diagnosis: &Diagnosis) -> String {
    if is_firmware_mismatch(diagnosis) {
        return "What the body logged as its output differs from a replay of what it logged as its input: \
                the firmware or its settings are not those of this program."
            .into();
    }
    match diagnosis.verdict {
        Verdict::NoGap => no_gap(diagnosis),
        Verdict::Unknown => unknown(diagnosis),
        Verdict::Explained | Verdict::PartlyExplained => explained(diagnosis),
    }
}

/// The sentence in the lines of a terminal.
pub(super) fn lines(diagnosis: &Diagnosis) -> Vec<String> {
    wrapped(&sentence(diagnosis), LINE)
}

fn no_gap(diagnosis: &Diagnosis) -> String {
    let noise = three_digits(excess(diagnosis, "scalar").noise_nt);
    let targets = match diagnosis.targets.len() {
        0 => String::new(),
        1 => " Its target is listed below.".into(),
        count => format!(" Its {count} targets are listed below."),
    };
    format!("No gap: the recording looks like the simulation, down to a scalar noise of {noise} nT rms.{targets}")
}

fn unknown(diagnosis: &Diagnosis) -> String {
    let gap = excess(diagnosis, diagnosis.gap.channel);
    let (sensor, noise) = (sensor(gap.channel), three_digits(gap.noise_nt));
    let what = match gap.excess_nt {
        _ if gap.is_small() => format!("has something that is no noise, though far below that of {noise} nT rms,"),
        nt if gap.is_below_noise() => {
            format!("differs from the simulation by {} nT rms, less than its noise of {noise},", three_digits(nt))
        }
        nt => format!("differs from the simulation by {} nT rms,", three_digits(nt)),
    };
    let targets = match diagnosis.targets.len() {
        0 => "",
        1 => " Its target is no part of it.",
        _ => " Its targets are no part of it.",
    };
    let known = diagnosis.specs.len();
    let word = capital(verdict(diagnosis.verdict));
    format!("{word}: the {sensor} {what} and none of the {known} known effects causes it.{targets}")
}

/// What is named, in the fullest wording that the lines hold.
fn explained(diagnosis: &Diagnosis) -> String {
    let causes = causes(diagnosis);
    if causes.is_empty() {
        return not_settled(diagnosis);
    }
    let most = causes.len().min(MOST_NAMED);
    let most =
        if most > 1 && is_told(diagnosis, &causes[..1]) && !is_told(diagnosis, &causes[1..2]) { 1 } else { most };
    let details = [Detail::Interval, Detail::Value, Detail::Name];
    let mut wordings = (1..=most).rev().flat_map(|named| {
        let causes = &causes;
        details.into_iter().map(move |detail| by(diagnosis, causes, named, detail))
    });
    let fits = |text: &String| text.chars().count() <= LINE * LINES && wrapped(text, LINE).len() <= LINES;
    let shortest = by(diagnosis, &causes, 1, Detail::Name);
    wordings.find(fits).unwrap_or(shortest)
}

/// The effects that are likely, the most probable main cause first.
fn causes(diagnosis: &Diagnosis) -> Vec<&EffectFound> {
    let mut causes: Vec<&EffectFound> = diagnosis.effects.iter().filter(|effect| is_likely(effect)).collect();
    let rank = |effect: &EffectFound| (main_cause(diagnosis, effect.name), effect.gap_closed.fraction);
    causes.sort_by(|a, b| rank(b).partial_cmp(&rank(a)).unwrap_or(std::cmp::Ordering::Equal));
    causes
}

/// Effects were named, and each more likely is not at work.
fn not_settled(diagnosis: &Diagnosis) -> String {
    let gap = excess(diagnosis, diagnosis.gap.channel);
    let word = capital(verdict(diagnosis.verdict));
    let (gap, unknown) = (gap.told(), unknown_cause(diagnosis));
    format!("{word}, but by what is not settled: nothing named below is likelier than not. {gap}{unknown}")
}

/// "Explained by a delay of 51 ms (48 to 54): 94 % of the scalar's gap of 0.400 nT rms."
fn by(diagnosis: &Diagnosis, causes: &[&EffectFound], named: usize, detail: Detail) -> String {
    let (main, others) = causes.split_at(named);
    let mut names: Vec<String> = main.iter().map(|effect| with_size(&diagnosis.specs, effect, detail)).collect();
    names.dedup();
    let names = names.join(" and ");
    let more = if others.is_empty() { String::new() } else { format!("; {} more below", others.len()) };
    let told = if is_told(diagnosis, main) {
        format!(": {}{more}.", shares(diagnosis, main))
    } else {
        let gap = excess(diagnosis, main[0].channel).told();
        format!(", {}{more}. {gap}", probabilities(main))
    };
    format!("{} by {names}{told}{}", capital(verdict(diagnosis.verdict)), unknown_cause(diagnosis))
}

/// Said where what was named is more likely a part of something that is not known.
fn unknown_cause(diagnosis: &Diagnosis) -> String {
    let probability = percent(main_cause(diagnosis, "unknown"));
    if is_rather_unknown(diagnosis) { format!(" Main cause likely unknown ({probability}).") } else { String::new() }
}

/// Whether the shares that effects close can be told: they surely close one, of a gap above the noise, and do not add
/// up to more than the whole, as shares do that were measured each beside the others.
fn is_told(diagnosis: &Diagnosis, effects: &[&EffectFound]) -> bool {
    let is_sure = |effect: &&EffectFound| {
        effect.gap_closed.held_out
            && effect.gap_closed.fraction.min(effect.gap_closed.ci95[0]) > 0.0
            && !excess(diagnosis, effect.channel).is_below_noise()
    };
    let is_possible = |channel: &str| {
        let shares = effects.iter().filter(|effect| effect.channel == channel).map(|effect| effect.gap_closed.fraction);
        shares.sum::<f64>() <= WHOLE
    };
    effects.iter().all(is_sure) && effects.iter().all(|effect| is_possible(effect.channel))
}

/// "60 % and 30 % of the scalar's gap of 0.400 nT rms".
fn shares(diagnosis: &Diagnosis, effects: &[&EffectFound]) -> String {
    let share = |effect: &&EffectFound| percent(effect.gap_closed.fraction);
    let gap = |effect: &&EffectFound| excess(diagnosis, effect.channel);
    match effects {
        [first, second] if first.channel != second.channel => {
            let (of_first, of_second) = (gap(first), gap(second));
            let (excess, channel) = (three_digits(of_second.excess_nt), of_second.channel);
            format!("{} of {}, {} of the {channel}'s of {excess}", share(first), of_first.size(), share(second))
        }
        _ => {
            let shares: Vec<String> = effects.iter().map(share).collect();
            format!("{} of {}", shares.join(" and "), gap(&effects[0]).size())
        }
    }
}

/// "probability 99 % and 97 %".
fn probabilities(effects: &[&EffectFound]) -> String {
    let mut probabilities: Vec<String> = effects.iter().map(|effect| percent(effect.probability)).collect();
    let count = probabilities.len();
    probabilities.dedup();
    let each = if probabilities.len() < count { " each" } else { "" };
    format!("probability {}{each}", probabilities.join(" and "))
}

/// What a channel shows beyond its noise, and its noise.
fn excess(diagnosis: &Diagnosis, channel: &str) -> Excess {
    let of = |gap: &ChannelGap| Excess {
        channel: gap.channel,
        excess_nt: gap.excess_rms_nt(),
        noise_nt: gap.noise_floor_rms_nT,
    };
    let gap = &diagnosis.gap;
    let of_both = Excess { channel: gap.channel, excess_nt: gap.excess_rms_nT, noise_nt: gap.noise_floor_rms_nT };
    diagnosis.channels.iter().find(|gap| gap.channel == channel).map_or(of_both, of)
}

impl Excess {
    fn is_small(&self) -> bool {
        self.excess_nt < SMALL * self.noise_nt || self.excess_nt == 0.0
    }

    fn is_below_noise(&self) -> bool {
        self.excess_nt < self.noise_nt || self.excess_nt == 0.0
    }

    /// "the scalar's gap of 0.400 nT rms".
    fn size(&self) -> String {
        format!("the {}'s gap of {} nT rms", self.channel, three_digits(self.excess_nt))
    }

    /// The size in a sentence, against the noise where it is smaller.
    fn told(&self) -> String {
        let (channel, noise) = (self.channel, three_digits(self.noise_nt));
        if self.is_small() {
            return format!("The {channel}'s gap is far below its noise of {noise} nT rms.");
        }
        let gap = format!("The {channel}'s gap is {} nT rms", three_digits(self.excess_nt));
        if self.is_below_noise() { format!("{gap}, below its noise of {noise}.") } else { format!("{gap}.") }
    }
}

/// An effect with its size where one number says it, or with its moment.
fn with_size(specs: &[&Spec], effect: &EffectFound, detail: Detail) -> String {
    let title = match (&effect.load, detail) {
        (Some(load), Detail::Interval | Detail::Value) => format!("the current of the load {load}"),
        _ => title(specs, effect.name).into(),
    };
    let moment = spec(specs, effect.name).and_then(Spec::moment).and_then(|index| effect.parameters.get(index));
    let (estimate, joint) = match (effect.parameters.as_slice(), moment) {
        ([only], _) => (only, "of"),
        (_, Some(moment)) => (moment, "at"),
        _ => return title,
    };
    let size = parameter(specs, effect, estimate).1;
    match (estimate.value, detail) {
        (None, _) | (_, Detail::Name) => title,
        (_, Detail::Interval) => format!("{title} {joint} {size}"),
        (_, Detail::Value) => format!("{title} {joint} {}", size.split(" (").next().unwrap_or_default()),
    }
}
