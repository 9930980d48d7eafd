//! From the text of a file to an effect, each thing checked where it stands.

use std::collections::BTreeMap;

use toml::Spanned;

use crate::dependence::classify;
use crate::effect_file::EffectFile;
use crate::error::{EffectFileError, Wrong, quoted};
use crate::formula::{BoundFormula, Expression, Source, is_function};
use crate::limits::{
    LARGEST_BOUND, LARGEST_FILE, LONGEST_NAME, LONGEST_TIME_S, LONGEST_TITLE, MOST_INPUTS, MOST_PARAMETERS,
};
use crate::parts::{Channel, Filter, FilterTime, Input, Kind, Parameter};
use crate::resolve::Scope;
use crate::text::{ChannelText, FileText, FilterText, InputText, KindText, ParameterText};
use crate::variable::VARIABLES;

impl EffectFile {
    /// Read and check the text of a file; messages call it `file_name`.
    ///
    /// # Errors
    ///
    /// When it is no effect that can be evaluated: the line, and why.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, EffectFileError> {
        checked(text, file_name).map_err(|wrong| wrong.in_file(text, file_name))
    }
}

fn checked(text: &str, file: &str) -> Result<EffectFile, Wrong> {
    if text.len() > LARGEST_FILE {
        return Err(Wrong::new(0, format!("the file is larger than {LARGEST_FILE} bytes")));
    }
    let read: FileText =
        toml::from_str(text).map_err(|error| Wrong::new(error.span().map_or(0, |span| span.start), error.message()))?;
    let name = effect_name(&read.name)?;
    let title = match &read.title {
        Some(title) => words(title, "title")?,
        None => format!("the effect {name}"),
    };
    let mut parameters = in_order(read.parameters, MOST_PARAMETERS, "parameters", parameter)?;
    let inputs = inputs(read.inputs, &parameters)?;
    let scope = Scope { parameters: &parameters, inputs: &inputs };
    let channel = match read.channel {
        ChannelText::Scalar => Channel::Scalar,
        ChannelText::Fluxgate => Channel::Fluxgate,
    };
    let kind = match read.kind {
        KindText::Additive => Kind::Additive,
        KindText::Multiplicative => Kind::Multiplicative,
        KindText::Delay => Kind::Delay,
    };
    let formulas = formulas(&read.formula, channel, &scope)?;
    check_used(&parameters, &inputs, &formulas).map_err(|reason| Wrong::new(read.formula.span().start, reason))?;
    classify(&mut parameters, &inputs, &formulas, kind);
    Ok(EffectFile { file: file.into(), name, title, channel, kind, formulas, parameters, inputs })
}

fn effect_name(name: &Spanned<String>) -> Result<String, Wrong> {
    let text = name.get_ref();
    let is_name = text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.len() <= LONGEST_NAME
        && text.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_');
    match is_name {
        true => Ok(text.clone()),
        false => Err(Wrong::new(
            name.span().start,
            format!("the name {} is not made of a-z, 0-9 and _, a letter first, at most {LONGEST_NAME}", quoted(text)),
        )),
    }
}

/// What is printed as it is: short, and no order to a terminal.
fn words(text: &Spanned<String>, what: &str) -> Result<String, Wrong> {
    checked_words(text.get_ref(), what).map_err(|reason| Wrong::new(text.span().start, reason))
}

fn checked_words(text: &str, what: &str) -> Result<String, String> {
    match text.chars().any(char::is_control) || text.chars().count() > LONGEST_TITLE {
        true => Err(format!("the {what} {} is longer than {LONGEST_TITLE} characters, or not one line", quoted(text))),
        false => Ok(text.into()),
    }
}

/// Tables of a file in the order in which they stand there.
fn in_order<T, Checked>(
    tables: BTreeMap<String, Spanned<T>>,
    most: usize,
    what: &str,
    check: impl Fn(&str, &T) -> Result<Checked, String>,
) -> Result<Vec<Checked>, Wrong> {
    let mut tables: Vec<(String, Spanned<T>)> = tables.into_iter().collect();
    tables.sort_by_key(|(_, table)| table.span().start);
    if let Some((_, one_too_many)) = tables.get(most) {
        return Err(Wrong::new(one_too_many.span().start, format!("there are more than {most} {what}")));
    }
    let one = |(name, table): &(String, Spanned<T>)| {
        check(name, table.get_ref()).map_err(|reason| Wrong::new(table.span().start, reason))
    };
    tables.iter().map(one).collect()
}

/// A name that a formula can have, and that is not taken.
fn own_name(name: &str) -> Result<(), String> {
    let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    if !is_name || name.len() > LONGEST_NAME {
        return Err(format!("the name {} is not made of letters, digits and _, at most {LONGEST_NAME}", quoted(name)));
    }
    if name == "pi" || is_function(name) || VARIABLES.iter().any(|(known, _)| *known == name) {
        return Err(format!("the name {name} has a meaning of its own in a formula: take another one"));
    }
    Ok(())
}

fn parameter(name: &str, text: &ParameterText) -> Result<Parameter, String> {
    own_name(name)?;
    let unit = checked_words(&text.unit, "unit")?;
    let ParameterText { low, high, default, .. } = *text;
    if !(low < high && low.abs() <= LARGEST_BOUND && high.abs() <= LARGEST_BOUND) {
        return Err(format!("{name}: low must be below high, both numbers"));
    }
    if !(low..=high).contains(&default) {
        return Err(format!("{name}: default must be between low and high"));
    }
    Ok(Parameter { name: name.into(), unit, low, high, default, is_linear: false, is_stepped: false })
}

fn inputs(tables: BTreeMap<String, Spanned<InputText>>, parameters: &[Parameter]) -> Result<Vec<Input>, Wrong> {
    let mut texts: Vec<(String, Spanned<InputText>)> = tables.into_iter().collect();
    texts.sort_by_key(|(_, text)| text.span().start);
    let mut inputs: Vec<Input> = Vec::new();
    for (name, text) in &texts {
        let scope = Scope { parameters, inputs: &inputs };
        let input = input(name, text.get_ref(), &scope, &texts);
        inputs.push(input.map_err(|reason| Wrong::new(text.span().start, reason))?);
    }
    Ok(inputs)
}

fn input(
    name: &str,
    text: &InputText,
    scope: &Scope<'_>,
    all: &[(String, Spanned<InputText>)],
) -> Result<Input, String> {
    own_name(name)?;
    if scope.inputs.len() >= MOST_INPUTS {
        return Err(format!("there are more than {MOST_INPUTS} inputs"));
    }
    if scope.parameters.iter().any(|parameter| parameter.name == name) {
        return Err(format!("{name} is a parameter already: take another name"));
    }
    let of = match (&text.of, &text.formula) {
        (Some(of), None) => named(name, of, scope)?,
        (None, Some(formula)) => bound(formula, scope).map_err(|reason| format!("{name}: {reason}"))?,
        _ => return Err(format!("{name}: it is made either `of` a variable or of a `formula`")),
    };
    for source in &of.sources {
        match source {
            Source::Parameter(index) => {
                let parameter = &scope.parameters[*index].name;
                return Err(format!("{name} is made of the parameter {parameter}, which does not change"));
            }
            Source::Column(column) if all.iter().any(|(input, _)| input == column) => {
                return Err(format!("{name} is made of {column}, which must stand above it"));
            }
            _ => {}
        }
    }
    Ok(Input { name: name.into(), of, filter: filter(name, text, scope.parameters)? })
}

/// A variable, a column by whatever name it has, or an input above.
fn named(name: &str, of: &str, scope: &Scope<'_>) -> Result<BoundFormula, String> {
    if of.is_empty() || of.chars().any(char::is_control) || of.chars().count() > LONGEST_TITLE {
        return Err(format!("{name}: {} is no column's name", quoted(of)));
    }
    Ok(BoundFormula::named(of, scope.source(of)?))
}

fn filter(name: &str, text: &InputText, parameters: &[Parameter]) -> Result<Filter, String> {
    let time = |may_be_early: bool| {
        let time = filter_time(text.time_s.as_ref(), parameters).map_err(|reason| format!("{name}: {reason}"))?;
        let least_s = match time {
            FilterTime::Fixed(time_s) => time_s,
            FilterTime::Parameter(index) => parameters[index].low,
        };
        match may_be_early || least_s >= 0.0 {
            true => Ok(time),
            false => Err(format!("{name}: time_s must not be below 0")),
        }
    };
    let none = |filter: Filter| match text.time_s {
        None => Ok(filter),
        Some(_) => Err(format!("{name}: this filter has no time_s")),
    };
    if text.width.is_some() && !matches!(text.filter, FilterText::Play | FilterText::Hold) {
        return Err(format!("{name}: this filter has no width"));
    }
    match text.filter {
        FilterText::Lowpass => time(false).map(Filter::LowPass),
        FilterText::Delay => time(true).map(Filter::Delay),
        FilterText::Mean => time(false).map(Filter::Mean),
        FilterText::Rate => none(Filter::Rate),
        FilterText::Hilbert => none(Filter::Hilbert),
        FilterText::Play => none(Filter::Play(width(name, text.width)?)),
        FilterText::Hold => none(Filter::Hold(width(name, text.width)?)),
    }
}

fn width(name: &str, width: Option<f64>) -> Result<f64, String> {
    match width {
        Some(width) if width.is_finite() && width >= 0.0 => Ok(width),
        Some(_) => Err(format!("{name}: width must be a finite number, not below 0")),
        None => Err(format!("{name}: width is missing: a number, in the unit of what the filter is of")),
    }
}

fn filter_time(value: Option<&toml::Value>, parameters: &[Parameter]) -> Result<FilterTime, String> {
    let number = |time_s: f64| match time_s.abs() <= LONGEST_TIME_S {
        true => Ok(FilterTime::Fixed(time_s)),
        false => Err(format!("time_s must be at most {LONGEST_TIME_S:e} s")),
    };
    match value {
        Some(toml::Value::Float(time_s)) => number(*time_s),
        Some(toml::Value::Integer(time_s)) => number(*time_s as f64),
        Some(toml::Value::String(name)) => {
            let index = parameters.iter().position(|parameter| parameter.name == *name);
            index.map(FilterTime::Parameter).ok_or_else(|| format!("time_s: there is no parameter {}", quoted(name)))
        }
        Some(_) => Err("time_s must be a number, or the name of a parameter".into()),
        None => Err("time_s is missing: a number, or the name of a parameter".into()),
    }
}

/// One of a scalar sensor, three of a fluxgate.
fn formulas(value: &Spanned<toml::Value>, channel: Channel, scope: &Scope<'_>) -> Result<Vec<BoundFormula>, Wrong> {
    let wrong = |reason: String| Wrong::new(value.span().start, reason);
    let texts: Vec<&str> = match (value.get_ref(), channel) {
        (toml::Value::String(text), Channel::Scalar) => vec![text],
        (toml::Value::Array(texts), Channel::Fluxgate) if texts.len() == 3 => {
            let texts: Option<Vec<&str>> = texts.iter().map(toml::Value::as_str).collect();
            texts.ok_or_else(|| wrong("formula: the three must be strings".into()))?
        }
        (_, Channel::Scalar) => return Err(wrong("formula: of the scalar it is one string".into())),
        (_, Channel::Fluxgate) => {
            return Err(wrong("formula: of the fluxgate it is three strings, [\"of x\", \"of y\", \"of z\"]".into()));
        }
    };
    texts.into_iter().map(|text| bound(text, scope).map_err(wrong)).collect()
}

fn bound(text: &str, scope: &Scope<'_>) -> Result<BoundFormula, String> {
    let place = |wrong: Wrong| {
        let character = text.get(..wrong.at).map_or(0, |before| before.chars().count()) + 1;
        format!("formula: {}, at character {character} of {}", wrong.reason, quoted(text))
    };
    let expression = Expression::parse(text).map_err(place)?;
    let source = |name: &String| scope.source(name).map_err(|reason| format!("formula: {reason}"));
    let sources = expression.names.iter().map(source).collect::<Result<_, _>>()?;
    Ok(BoundFormula { text: text.into(), sources, expression })
}

/// A parameter that nothing depends on would be searched in vain.
fn check_used(parameters: &[Parameter], inputs: &[Input], formulas: &[BoundFormula]) -> Result<(), String> {
    let in_formula = |index: usize| formulas.iter().any(|formula| formula.sources.contains(&Source::Parameter(index)));
    let in_filter = |index: usize| inputs.iter().any(|input| input.filter.time() == Some(FilterTime::Parameter(index)));
    let unused = (0..parameters.len()).find(|&index| !in_formula(index) && !in_filter(index));
    unused.map_or(Ok(()), |index| Err(format!("the parameter {} is in no formula", parameters[index].name)))
}
