//! The figures that the diagnosis is held to, beside what was measured.

use serde::Serialize;

use super::on::OnScore;
use super::rate::Rate;
use super::targets::TargetScore;
use super::total::Score;

/// Right or in the set, by strength.
const IN_SET: [f64; 3] = [0.95, 0.98, 0.99];
/// All of several: pairs of strength 1 and 3, unequal pairs, triples.
const ALL: [f64; 4] = [0.9, 0.95, 0.7, 0.7];

/// One figure.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// What of.
    pub what: String,
    /// What it shall be, such as `at most 1 %`.
    pub asked: String,
    /// What it is, such as `0.8 %`; a dash where nothing was counted.
    pub measured: String,
    /// Of how many, and how sure: `1 of 120, 0.1 to 4.6 %`.
    pub counted: String,
    /// Whether it is.
    pub state: State,
}

/// Whether a figure is what it shall be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It is.
    Reached,
    /// It is not, but with so few recordings that may be chance.
    Open,
    /// It is not.
    Missed,
    /// Nothing of this was drawn.
    None,
}

impl State {
    /// As a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Open => "open",
            Self::Missed => "missed",
            Self::None => "none drawn",
        }
    }

    /// As the name of a style.
    pub fn class(self) -> &'static str {
        self.word().split(' ').next().unwrap_or_default()
    }
}

/// All of them, in the order in which they matter.
pub fn figures(score: &Score) -> Vec<Figure> {
    let mut all = vec![share("False alarms", score.false_alarms, [0.0, 0.01])];
    for (of, rates) in [("", &score.false_alarms_by_targets), ("recorder ", &score.false_alarms_by_recorder)] {
        all.extend(rates.iter().map(|(name, rate)| share(&format!("False alarms, {of}{name}"), *rate, [0.0, 0.01])));
    }
    for (bin, in_set) in score.singles.iter().zip(IN_SET) {
        let what = format!("One effect, strength {}: right, or in the stated set", bin.strength);
        all.push(share(&what, bin.right_or_in_set, [in_set, 1.0]));
    }
    all.push(share("One effect: wrong and claimed first", score.wrong_and_claimed, [0.0, 0.01]));
    all.push(share("All recordings: any false name", score.false_names, [0.0, 0.02]));
    all.push(share("Outside the library: explained away", score.foreign_explained, [0.0, 0.02]));
    all.push(share("Outside the library: any effect named", score.foreign_named, [0.0, 0.1]));
    all.push(share("Outside the library, strength 3 and 10: noticed", score.foreign_noticed_from_3, [0.97, 1.0]));
    for (several, asked) in score.several.iter().zip(ALL) {
        all.push(share(&format!("{}: all found", several.what), several.all, [asked, 1.0]));
    }
    all.push(share("Targets of 5 nT and more: listed", score.targets.large_listed, [0.95, 1.0]));
    all.push(invented(score.targets));
    all.push(calibration(score));
    all.push(share("95 % intervals of parameters: hold the truth", score.intervals_cover, [0.9, 0.98]));
    all.push(share("95 % intervals of the shrink: hold the realised", score.shrink.cover, [0.9, 0.98]));
    all.push(ratio(score));
    all
}

/// Of effects and targets that are put into a recording.
pub fn on_figures(score: &OnScore) -> Vec<Figure> {
    vec![
        share("Put in with strength 3 and 10: newly named", score.named_from_3, [0.9, 1.0]),
        share("Another effect newly named", score.others_named, [0.0, 0.1]),
        share("Targets put in: listed", score.targets_listed, [0.95, 1.0]),
    ]
}

/// Fewer than one an hour, with the 95 % interval of a count (a square root of a Poisson count has a spread of a half).
fn invented(targets: TargetScore) -> Figure {
    let low = ((targets.invented as f64).sqrt() - 0.98).max(0.0).powi(2) / targets.hours;
    let state = match targets.invented_per_hour() {
        None => State::None,
        Some(rate) if rate < 1.0 => State::Reached,
        Some(_) if low < 1.0 => State::Open,
        Some(_) => State::Missed,
    };
    Figure {
        what: "Targets that are invented, an hour".into(),
        asked: "below 1".into(),
        measured: targets.invented_per_hour().map_or("–".into(), |rate| format!("{rate:.2}")),
        counted: format!("{} in {:.1} h", targets.invented, targets.hours),
        state,
    }
}

/// A share that shall lie within limits.
fn share(what: &str, rate: Rate, [low, high]: [f64; 2]) -> Figure {
    let asked = match (low > 0.0, high < 1.0) {
        (true, true) => format!("{} to {} %", percent(low), percent(high)),
        (true, false) => format!("at least {} %", percent(low)),
        _ => format!("at most {} %", percent(high)),
    };
    let state = match rate.share() {
        None => State::None,
        Some(share) if (low..=high).contains(&share) => State::Reached,
        // What may be, and what shall be, overlap.
        Some(_) if rate.ci95[0] <= high && rate.ci95[1] >= low => State::Open,
        Some(_) => State::Missed,
    };
    let measured = rate.share().map_or("–".into(), |share| format!("{:.1} %", 100.0 * share));
    let [from, to] = rate.ci95.map(|end| 100.0 * end);
    let counted =
        if rate.of == 0 { String::new() } else { format!("{} of {}, {from:.1} to {to:.1} %", rate.hits, rate.of) };
    Figure { what: what.into(), asked, measured, counted, state }
}

fn calibration(score: &Score) -> Figure {
    let error = score.calibration.expected_error;
    let of: usize = score.calibration.bins.iter().map(|bin| bin.came.of).sum();
    // What chance alone makes of it, with so many in a bin.
    let chance = score.calibration.bins.iter().map(|bin| spread(bin.promised, bin.came.of)).sum::<f64>()
        / score.calibration.bins.len().max(1) as f64;
    let state = match error {
        _ if of == 0 => State::None,
        error if error <= 0.03 => State::Reached,
        error if error <= 0.03 + chance => State::Open,
        _ => State::Missed,
    };
    Figure {
        what: "Probabilities: expected calibration error".into(),
        asked: "at most 0.03".into(),
        measured: format!("{error:.3}"),
        counted: format!("{of} answers; chance alone makes about {chance:.3}"),
        state,
    }
}

/// Mean distance of a share of `of` from its probability.
fn spread(probability: f64, of: usize) -> f64 {
    (2.0 / std::f64::consts::PI * probability * (1.0 - probability) / of.max(1) as f64).sqrt()
}

fn ratio(score: &Score) -> Figure {
    let state = match score.shrink.median_ratio {
        None => State::None,
        Some(ratio) if (0.9..=1.1).contains(&ratio) => State::Reached,
        Some(_) if score.shrink.of < 10 => State::Open,
        Some(_) => State::Missed,
    };
    Figure {
        what: "Shrink predicted over realised, median".into(),
        asked: "0.9 to 1.1".into(),
        measured: score.shrink.median_ratio.map_or("–".into(), |ratio| format!("{ratio:.2}")),
        counted: format!("{} recordings", score.shrink.of),
        state,
    }
}

fn percent(share: f64) -> String {
    format!("{:.0}", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_missed_only_when_chance_does_not_explain_it() {
        let state = |hits, of, limits| share("", Rate::new(hits, of), limits).state;
        assert_eq!(state(0, 20, [0.0, 0.01]), State::Reached);
        assert_eq!(state(1, 20, [0.0, 0.01]), State::Open);
        assert_eq!(state(10, 100, [0.0, 0.01]), State::Missed);
        assert_eq!(state(19, 19, [0.9, 0.98]), State::Open);
        assert_eq!(state(0, 0, [0.9, 1.0]), State::None);
        assert_eq!(share("", Rate::new(0, 0), [0.9, 0.98]).asked, "90 to 98 %");
    }
}
