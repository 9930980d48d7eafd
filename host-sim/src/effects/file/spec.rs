//! What a diagnosis is to know of an effect that a user wrote.

use towmag_effect_file::{
    Channel as FileChannel, EffectFile, FilterTime, Kind as FileKind, Parameter as FileParameter, Variable,
};

use crate::effects::{Channel, CoefficientDependence, Domain, HeldOut, Kind, Parameter, Search, Spec, Step};

/// Half the width of a difference quotient, over the range of the parameter: formulas are smooth, and computed to 16 digits.
const DERIVATIVE_STEP: f64 = 1e-6;
/// The smallest useful step of what changes in jumps: a row where it is a time, else a part of the range.
const ROW_S: f64 = 0.1;
const STEPS_OF_RANGE: f64 = 1000.0;
/// Where secant steps begin, over the ends of the range.
const STARTS: [f64; 2] = [0.02, 0.2];

/// Made once for an effect file that the program is given, and kept until it ends: every result names effects by words that are
/// always there, as those of the program's own are.
pub(super) fn spec(file: &EffectFile) -> &'static Spec {
    let parameters: Vec<Parameter> = file.parameters.iter().map(parameter).collect();
    Box::leak(Box::new(Spec {
        name: kept(&file.name),
        title: kept(&file.title),
        what: kept(&file.title),
        origin: kept(&format!("an effect of the file {}", file.file)),
        source: "the bounds that the file gives",
        model: kept(&model(file)),
        parameters: Box::leak(parameters.into_boxed_slice()),
        channel: channel(file),
        portable: !file.asks_for(|variable| matches!(variable, Variable::Time | Variable::RecordingTime)),
        coefficients: coefficients(file),
        search: search(file),
        held_out: held_out(file),
        ..Spec::BASE
    }))
}

fn kept(text: &str) -> &'static str {
    String::leak(text.into())
}

/// The formula as a sentence about readings.
fn model(file: &EffectFile) -> String {
    let texts: Vec<&str> = file.formulas.iter().map(|formula| formula.text.as_str()).collect();
    let formula = texts.join("; ");
    let reading = if file.channel == FileChannel::Scalar { "s" } else { "f" };
    match file.kind {
        FileKind::Additive => format!("`{reading}' = {reading} + ({formula})`"),
        FileKind::Multiplicative => format!("`{reading}' = {reading} (1 + ({formula}))`"),
        FileKind::Delay => format!("`{reading}'(t) = {reading}(t - ({formula}))`"),
    }
}

fn channel(file: &EffectFile) -> Channel {
    match file.channel {
        FileChannel::Scalar => Channel::Scalar,
        FileChannel::Fluxgate => Channel::Fluxgate,
    }
}

fn parameter(of: &FileParameter) -> Parameter {
    let range = [of.low, of.high];
    let width = of.high - of.low;
    let kind = match (of.is_linear, of.is_stepped, of.unit == "s") {
        (true, ..) => Kind::Linear,
        (_, true, true) => Kind::Discrete(Step::fixed(ROW_S)),
        (_, true, false) => Kind::Discrete(Step::fixed(width / STEPS_OF_RANGE)),
        _ => Kind::Differentiable(Step::fixed(DERIVATIVE_STEP * width)),
    };
    Parameter { name: kept(&of.name), unit: kept(&of.unit), range, plausible: range, kind, domain: Domain::Real }
}

/// How the change depends on the coefficients, which are in the clean scalar reading alone.
fn coefficients(file: &EffectFile) -> CoefficientDependence {
    let asks_for_scalar = file.asks_for(|variable| variable == Variable::Scalar);
    match (file.channel, file.kind) {
        (FileChannel::Fluxgate, _) => CoefficientDependence::None,
        (_, FileKind::Additive) if !asks_for_scalar => CoefficientDependence::None,
        (_, FileKind::Additive) if file.is_affine_in_scalar() => CoefficientDependence::Proportional,
        (_, FileKind::Multiplicative | FileKind::Delay) if !asks_for_scalar => CoefficientDependence::Proportional,
        _ => CoefficientDependence::Nonlinear,
    }
}

fn search(file: &EffectFile) -> Search {
    let is_late_by_one = file.kind == FileKind::Delay
        && file.parameters.len() == 1
        && file.is_proportional_to(0)
        && !is_time_of_filter(file, 0);
    if file.parameters.iter().all(|parameter| parameter.is_linear) && !file.parameters.is_empty() {
        Search::Linear
    } else if is_late_by_one {
        Search::Secant { starts: starts(&file.parameters[0]) }
    } else {
        Search::Ranges
    }
}

fn is_time_of_filter(file: &EffectFile, index: usize) -> bool {
    file.inputs.iter().any(|input| input.filter.time() == Some(FilterTime::Parameter(index)))
}

/// Small and larger ones of both signs, as far as the range goes.
fn starts(parameter: &FileParameter) -> &'static [f64] {
    let ends = [parameter.high, parameter.low];
    let all = STARTS.iter().flat_map(|share| ends.map(|end| share * end));
    let within: Vec<f64> =
        all.filter(|&start| start != 0.0 && (parameter.low..=parameter.high).contains(&start)).collect();
    match within.is_empty() {
        true => Box::leak(Box::new([0.5 * (parameter.low + parameter.high)])),
        false => Vec::leak(within),
    }
}

/// What can be bent to fit a few rows must explain something elsewhere too.
fn held_out(file: &EffectFile) -> HeldOut {
    if file.parameters.iter().any(|parameter| parameter.is_stepped) {
        HeldOut::MustNotHarm
    } else if file.kind != FileKind::Delay && file.parameters.iter().any(|parameter| !parameter.is_linear) {
        HeldOut::MustExplain
    } else {
        HeldOut::NotAsked
    }
}
