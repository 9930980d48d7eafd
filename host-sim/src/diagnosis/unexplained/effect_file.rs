//! A proposal in the language of effect files.

use std::collections::BTreeMap;

use serde::Serialize;

use super::expression::Expr;
use super::filter::Filter;
use super::proposal::Proposal;
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
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    inputs: BTreeMap<String, Input>,
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

#[derive(Serialize)]
struct Input {
    of: String,
    filter: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_s: Option<f64>,
}

/// The text of the file.
pub(crate) fn effect_file(proposal: &Proposal) -> String {
    let file = File {
        name: name(&proposal.input),
        title: title(&proposal.input),
        channel: match proposal.channel {
            Channel::Scalar => "scalar",
            Channel::Fluxgate => "fluxgate",
        },
        kind: "additive",
        formula: formula(proposal),
        parameters: BTreeMap::from([("scale", Parameter { unit: "1", low: RANGE[0], high: RANGE[1], default: 1.0 })]),
        inputs: inputs(proposal),
    };
    toml::to_string(&file).unwrap_or_default()
}

/// What is added, nT, times its size; of the fluxgate along the field, as that is what its magnitude shows.
fn formula(proposal: &Proposal) -> Formula {
    let term = |(weight, shape): &(f64, Expr)| Expr::Product(vec![Expr::Number(*weight), shape.clone()]).to_string();
    let sum = proposal.terms.iter().map(term).collect::<Vec<_>>().join(" + ");
    match proposal.channel {
        Channel::Scalar => Formula::Scalar(format!("scale * ({sum})")),
        Channel::Fluxgate => Formula::Fluxgate(["cx", "cy", "cz"].map(|axis| format!("scale * {axis} * ({sum})"))),
    }
}

fn inputs(proposal: &Proposal) -> BTreeMap<String, Input> {
    let all = proposal.terms.iter().flat_map(|(_, shape)| shape.filtered());
    let input = |filtered: &Expr| match filtered {
        Expr::Filtered(of, filter) => Some((filtered.name(), input_of(of, filter)?)),
        _ => None,
    };
    all.filter_map(input).collect()
}

fn input_of(of: &Expr, filter: &Filter) -> Option<Input> {
    Some(Input { of: of.name(), filter: filter.word()?, time_s: filter.time_s() })
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
