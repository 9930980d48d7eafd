//! A proposal in the language of effect files.

use std::collections::BTreeMap;

use serde::Serialize;
use towmag_effect_file::{EffectFile, LONGEST_NAME};

use super::proposal::Proposal;
use crate::diagnosis::shapes::expression::Expr;
use crate::diagnosis::shapes::filter::Filter;
use crate::effects::Channel;

/// How much larger or smaller another recording may have it.
const RANGE: [f64; 2] = [-5.0, 5.0];

#[derive(Serialize)]
struct File {
    name: String,
    title: String,
    channel: &'static str,
    kind: &'static str,
    formula: Formula,
    parameters: BTreeMap<&'static str, Parameter>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Formula {
    Scalar(String),
    Fluxgate([String; 3]),
}

#[derive(Serialize)]
struct Parameter {
    unit: &'static str,
    low: f64,
    high: f64,
    default: f64,
}

#[derive(PartialEq, Serialize)]
struct Input {
    #[serde(skip_serializing_if = "Option::is_none")]
    of: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    formula: Option<String>,
    filter: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
}

impl Input {
    /// What a filter makes of a name, or of a formula.
    fn of(of: &Expr, filter: Filter) -> Self {
        let (of, formula) = match of {
            Expr::Variable(name) => (Some(name.clone()), None),
            other => (None, Some(other.to_string())),
        };
        Self { of, formula, filter: filter.word(), time_s: filter.time_s(), width: filter.width() }
    }
}

/// Inputs in the order in which they are made of each other, with their names.
#[derive(Default)]
struct Inputs(Vec<(String, Input)>);

impl Inputs {
    /// The name of what a filter makes of something: of a variable it says how, where that is short.
    fn name(&mut self, of: &Expr, filter: Filter) -> String {
        let input = Input::of(of, filter);
        if let Some((name, _)) = self.0.iter().find(|(_, other)| *other == input) {
            return name.clone();
        }
        let own = match of {
            Expr::Variable(name) if is_word(name) => format!("{name}_{}", filter.suffix()),
            _ => format!("mixed_{}_{}", self.0.len() + 1, filter.suffix()),
        };
        let name = if own.len() <= LONGEST_NAME { own } else { format!("input_{}", self.0.len() + 1) };
        self.0.push((name.clone(), input));
        name
    }

    /// As tables of the file.
    fn text(&self) -> String {
        let table = |(name, input): &(String, Input)| {
            format!("\n[inputs.{name}]\n{}", toml::to_string(input).unwrap_or_default())
        };
        self.0.iter().map(table).collect()
    }
}

/// Whether a formula can have it as a name.
fn is_word(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
}

/// How many of a proposal's terms, from the first on, a file may hold: with more of them it only gets longer.
pub(crate) fn terms_that_fit(proposal: &Proposal) -> usize {
    let fits = |count: &usize| {
        let some = Proposal { terms: proposal.terms[..*count].to_vec(), ..proposal.clone() };
        EffectFile::parse(&effect_file(&some), "proposal").is_ok()
    };
    let counts: Vec<usize> = (1..=proposal.terms.len()).collect();
    counts.partition_point(fits)
}

/// The text of the file.
pub(crate) fn effect_file(proposal: &Proposal) -> String {
    let mut inputs = Inputs::default();
    let formula = formula(proposal, &mut inputs);
    let file = File {
        name: name(&proposal.input),
        title: title(&proposal.input),
        channel: match proposal.channel {
            Channel::Scalar => "scalar",
            Channel::Fluxgate => "fluxgate",
        },
        kind: "additive",
        formula,
        parameters: BTreeMap::from([("scale", Parameter { unit: "", low: RANGE[0], high: RANGE[1], default: 1.0 })]),
    };
    toml::to_string(&file).unwrap_or_default() + &inputs.text()
}

/// What is added, nT, times its size; of the fluxgate along the field, as that is what its magnitude shows.
fn formula(proposal: &Proposal, inputs: &mut Inputs) -> Formula {
    let term = |(weight, shape): &(f64, Expr)| {
        // A column whose name no formula can have comes in by an input that changes nothing.
        let shape = shape.with_variables(&|name| (!is_word(name)).then_some(Filter::Delay(0.0)));
        weighted(*weight, &shape.with_inputs(&mut |of, filter| inputs.name(of, filter))).to_string()
    };
    let sum = proposal.terms.iter().map(term).collect::<Vec<_>>().join(" + ");
    match proposal.channel {
        Channel::Scalar => Formula::Scalar(format!("scale * ({sum})")),
        Channel::Fluxgate => Formula::Fluxgate(["cx", "cy", "cz"].map(|axis| format!("scale * {axis} * ({sum})"))),
    }
}

/// A shape times a number; its own numbers become one with that.
fn weighted(weight: f64, shape: &Expr) -> Expr {
    let mut factors = vec![Expr::Number(1.0)];
    factors[0] = Expr::Number(weight * gathered(shape, &mut factors));
    Expr::Product(factors)
}

/// The factors of a product that are no numbers, and the product of its numbers.
fn gathered(shape: &Expr, factors: &mut Vec<Expr>) -> f64 {
    match shape {
        Expr::Number(number) => *number,
        Expr::Product(parts) => parts.iter().map(|part| gathered(part, factors)).product(),
        other => {
            factors.push(other.clone());
            1.0
        }
    }
}

/// `proposed_` and what drives it, as a name may be.
fn name(input: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    format!("proposed_{}", input.chars().map(letter).collect::<String>()).chars().take(40).collect()
}

fn title(input: &str) -> String {
    match input {
        "attitude" => "a field that goes with the attitude of the body".into(),
        "attitude_rate" => "a field that goes with the rate at which the body turns".into(),
        "attitude_history" => "a field that remembers how the body lay before".into(),
        "depth_rate" => "a field that goes with the heave".into(),
        "reading" => "an error that goes with the reading itself".into(),
        other => format!("a field that goes with {other}"),
    }
}

#[cfg(test)]
mod tests {
    use exmex::{Express, FlatEx};

    use super::*;
    use crate::diagnosis::evidence::shrink::GapClosed;
    use crate::diagnosis::shapes::expression::{Function, scaled, times, var};
    use crate::diagnosis::shapes::scene::Scene;

    const ROWS: usize = 300;

    fn scene() -> Scene {
        let wave =
            |hz: f64, start: f64| (0..ROWS).map(|row| (0.628 * hz * row as f64 + start).sin()).collect::<Vec<f64>>();
        let reading: Vec<f64> = wave(0.11, 0.3).iter().map(|x| 52_000.0 + 80.0 * x).collect();
        Scene::with(
            [
                ("cx", wave(0.2, 0.0)),
                ("cz", wave(0.15, 1.0)),
                ("s", reading),
                ("current_pump_A", wave(0.07, 2.0)),
                ("pump current [A]", wave(0.04, 0.7)),
            ],
            vec![0..120, 120..ROWS],
        )
    }

    fn proposal(channel: Channel) -> Proposal {
        let bent = scaled(&var("current_pump_A"), -0.123_456_789, 0.7).apply(Function::Positive);
        let behind = scaled(&var("cx").through(Filter::Lowpass(1.5)), 0.01, -0.3).apply(Function::Tanh);
        let late = times(&var("s").through(Filter::Rate), &var("cz").through(Filter::Delay(0.4)));
        let turned = scaled(&var("s"), 52_000.0, 31.4).apply(Function::Sin);
        let slanted = Expr::Sum(vec![var("cx"), times(&Expr::Number(-1.0), &var("cz").through(Filter::Lowpass(1.5)))]);
        Proposal {
            channel,
            input: "current_pump_A".into(),
            terms: vec![
                (3.0, times(&bent, &var("cz"))),
                (-0.25, behind),
                (1.0e-3, late),
                (0.5, turned.apply(Function::Abs)),
                (0.75, scaled(&var("cx").through(Filter::Play(0.4)), 0.1, 1.0).apply(Function::Sign)),
                (0.3, scaled(&slanted.through(Filter::Play(0.6)), 0.2, 1.0).apply(Function::Sign)),
                (0.2, var("pump current [A]").through(Filter::Hold(0.5))),
            ],
            is_closed_form: true,
            closed: GapClosed { fraction: 0.5, ci95: [0.4, 0.6], held_out: true },
        }
    }

    #[test]
    fn as_many_terms_are_written_as_can_be_read_again() {
        let short = proposal(Channel::Scalar);
        let terms = short.terms.iter().cycle().take(400 * short.terms.len()).cloned().collect::<Vec<_>>();
        assert_eq!(terms_that_fit(&short), short.terms.len());
        let fit = terms_that_fit(&Proposal { terms: terms.clone(), ..short });
        assert!(fit > 0 && fit < terms.len(), "{fit} of {}", terms.len());
        let with = |count: usize| Proposal { terms: terms[..count].to_vec(), ..proposal(Channel::Scalar) };
        let is_read = |count| EffectFile::parse(&effect_file(&with(count)), "proposal").is_ok();
        assert!(is_read(fit) && !is_read(fit + 1));
    }

    /// The variables of a file: the recording's, and its own inputs by their words, as the language of effect files has them.
    fn variables(text: &str, scene: &Scene) -> BTreeMap<String, Vec<f64>> {
        let file: toml::Table = text.parse().unwrap();
        let mut all: BTreeMap<String, Vec<f64>> = BTreeMap::from([("scale".into(), vec![1.0; ROWS])]);
        for name in ["cx", "cz", "s", "current_pump_A", "pump current [A]"] {
            all.insert(name.into(), scene.variable(name).unwrap().to_vec());
        }
        // In the order of the file: each is made of those above it.
        for name in text.lines().filter_map(|line| line.strip_prefix("[inputs.")?.strip_suffix(']')) {
            let input = &file["inputs"][name];
            let of = match input.get("formula") {
                Some(formula) => evaluated(formula.as_str().unwrap(), &all),
                None => all[input["of"].as_str().unwrap()].clone(),
            };
            let time_s = input.get("time_s").map_or(0.0, |time_s| time_s.as_float().unwrap());
            let width = input.get("width").map_or(0.0, |width| width.as_float().unwrap());
            let word = input["filter"].as_str().unwrap();
            let value = |row: usize, start: usize, end: usize, last: f64| match word {
                "lowpass" => last + (1.0 - (-0.1 / time_s).exp()) * (of[row] - last),
                "delay" => of[row.saturating_sub((10.0 * time_s).round() as usize).max(start)],
                "play" => last.clamp(of[row] - width, of[row] + width),
                "hold" if (of[row] - last).abs() <= width => last,
                "hold" => of[row],
                "rate" => {
                    let (from, to) = (row.max(start + 1) - 1, (row + 1).min(end - 1));
                    (of[to] - of[from]) / (0.1 * (to - from) as f64)
                }
                other => panic!("{other}"),
            };
            let mut filtered = Vec::new();
            for segment in scene.segments() {
                let mut last = of[segment.start];
                for row in segment.clone() {
                    last = value(row, segment.start, segment.end, last);
                    filtered.push(last);
                }
            }
            all.insert(name.into(), filtered);
        }
        all
    }

    fn evaluated(formula: &str, variables: &BTreeMap<String, Vec<f64>>) -> Vec<f64> {
        let expression: FlatEx<f64> = exmex::parse(formula).unwrap();
        let names = expression.var_names().to_vec();
        let row =
            |row: usize| expression.eval(&names.iter().map(|name| variables[name][row]).collect::<Vec<f64>>()).unwrap();
        (0..ROWS).map(row).collect()
    }

    #[test]
    fn the_formula_of_a_file_is_the_fitted_course() {
        let scene = scene();
        let course = proposal(Channel::Scalar).course(&scene).unwrap();
        let text = effect_file(&proposal(Channel::Scalar));
        let file: toml::Table = text.parse().unwrap();
        assert_eq!(file["name"].as_str(), Some("proposed_current_pump_a"));
        assert!(EffectFile::parse(&text, "proposal").is_ok(), "{text}");
        let variables = variables(&text, &scene);
        let written = evaluated(file["formula"].as_str().unwrap(), &variables);
        assert!(written.iter().zip(&course).all(|(a, b)| (a - b).abs() < 1e-6), "{file}");
        let file: toml::Table = effect_file(&proposal(Channel::Fluxgate)).parse().unwrap();
        let along = evaluated(file["formula"][2].as_str().unwrap(), &variables);
        assert!(along.iter().zip(&course).zip(&variables["cz"]).all(|((a, b), cz)| (a - b * cz).abs() < 1e-6));
        assert!(course.iter().any(|nt| nt.abs() > 0.5));
    }
}
