//! All effects by name, and what `--effect` says.

use crate::effects;
use crate::effects::{Effect, Kind, Parameter, Spec};
use crate::message::{number, quoted, shortened};
use crate::simulator::signals::Signals;

/// Every effect that has a forward model, in the order of the documentation.
pub fn library() -> Vec<Box<dyn Effect>> {
    vec![
        Box::new(effects::ScalarLag),
        Box::new(effects::ClockDrift),
        Box::new(effects::SampleSlip),
        Box::new(effects::SampleJitter),
        Box::new(effects::StaleSample),
        Box::new(effects::AveragingWindow),
        Box::new(effects::ScalarLowpass),
        Box::new(effects::HeadingError),
        Box::new(effects::DeadZone),
        Box::new(effects::MainsAlias),
        Box::new(effects::FluxgateBias),
        Box::new(effects::FluxgateScale),
        Box::new(effects::FluxgateNonorthogonality),
        Box::new(effects::FluxgateTemperatureDrift),
        Box::new(effects::FluxgateNonlinearity),
        Box::new(effects::FluxgateQuantisation),
        Box::new(effects::PermanentStep),
        Box::new(effects::PermanentTemperature),
        Box::new(effects::SecondOrder),
        Box::new(effects::EddyLag),
        Box::new(effects::LoadCurrent::default()),
        Box::new(effects::DepthGradient),
        Box::new(effects::SwellInduction),
    ]
}

/// Those that make sense on a recording; `load_current` once more for each recorded current.
pub fn library_for(signals: &Signals) -> Vec<Box<dyn Effect>> {
    let loads = signals.trajectory().currents_a.iter();
    let driven = loads.map(|(load, _)| Box::new(effects::LoadCurrent { load: Some(load.clone()) }) as Box<dyn Effect>);
    library().into_iter().filter(|effect| effect.applies_to(signals)).chain(driven).collect()
}

/// Found by comparing the device's outputs with a replay; it has no forward model.
pub const FIRMWARE_MISMATCH: &str = "firmware_mismatch";

/// A name in plain words: that of an effect, or what a diagnosis says where there is none.
pub fn title(name: &str) -> &'static str {
    match name {
        FIRMWARE_MISMATCH => "a firmware that differs from its replay",
        "none" => "nothing: noise alone",
        "unknown" => "something that is not in the library",
        _ => spec(name).map_or("an effect without a name", |spec| spec.title),
    }
}

/// What is written about an effect.
pub fn spec(name: &str) -> Option<&'static Spec> {
    library().iter().map(|effect| effect.spec()).find(|spec| spec.name == name)
}

/// An effect with its parameters: what `--effect name:param=value,...` says.
#[derive(Debug)]
pub struct Request {
    /// The effect.
    pub effect: Box<dyn Effect>,
    /// Its parameters, in the order of its [`Spec`].
    pub parameters: Vec<f64>,
}

/// What is wrong with a request, in a sentence that says what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RequestError(String);

impl std::str::FromStr for Request {
    type Err = RequestError;

    /// From `name:param=value,...`. Linear and cyclic parameters that are left out are 0, if another is given.
    fn from_str(text: &str) -> Result<Self, RequestError> {
        let (name, list) = text.split_once(':').unwrap_or((text, ""));
        let mut given = pairs(name, list)?;
        let effect = effect_for(name.trim(), &mut given)?;
        let spec = effect.spec();
        if let Some((unknown, _)) = given.iter().find(|(key, _)| spec.parameters.iter().all(|p| p.name != *key)) {
            let message =
                format!("{name} has no parameter {}; it has: {}", quoted(unknown.as_bytes()), described(spec));
            return Err(RequestError(message));
        }
        if given.is_empty() {
            return Err(RequestError(format!("{name} needs parameters, {name}:param=value,...: {}", described(spec))));
        }
        let value = |p: &Parameter| match given.iter().find(|(key, _)| *key == p.name) {
            Some((_, text)) => p.parse(name, text),
            None if matches!(p.kind, Kind::Linear | Kind::Cyclic) => Ok(0.0),
            None => Err(RequestError(format!("{name} needs {}", p.described()))),
        };
        let parameters = spec.parameters.iter().map(value).collect::<Result<_, _>>()?;
        Ok(Self { effect, parameters })
    }
}

impl Parameter {
    fn parse(&self, effect: &str, text: &str) -> Result<f64, RequestError> {
        let wrong =
            |what: &str| RequestError(format!("{effect}: {}={} {what}", self.name, shortened(text.as_bytes(), 32)));
        let value: f64 = text.trim().parse().map_err(|_| wrong("is not a number"))?;
        if self.kind == Kind::Whole && value.fract() != 0.0 {
            return Err(wrong("is not a whole number"));
        }
        if !(self.range[0]..=self.range[1]).contains(&value) {
            return Err(wrong(&format!("is outside {}", self.range_text())));
        }
        Ok(value)
    }

    fn described(&self) -> String {
        format!("{} ({})", self.name, self.range_text())
    }

    fn range_text(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        if self.range[0] == f64::MIN {
            return format!("the recording, in{unit}");
        }
        format!("{} to {}{unit}", number(self.range[0]), number(self.range[1]))
    }
}

/// The parameters of an effect for a message.
fn described(spec: &Spec) -> String {
    spec.parameters.iter().map(Parameter::described).collect::<Vec<_>>().join(", ")
}

/// `param=value,...`, each at most once.
fn pairs<'a>(name: &str, list: &'a str) -> Result<Vec<(&'a str, &'a str)>, RequestError> {
    let mut pairs: Vec<(&str, &str)> = Vec::new();
    for part in list.split(',').filter(|part| !part.trim().is_empty()) {
        let Some((key, value)) = part.split_once('=') else {
            return Err(RequestError(format!("{name}: {} is not param=value", quoted(part.as_bytes()))));
        };
        if pairs.iter().any(|(known, _)| *known == key.trim()) {
            return Err(RequestError(format!("{name}: {} is there twice", key.trim())));
        }
        pairs.push((key.trim(), value.trim()));
    }
    Ok(pairs)
}

/// The effect of a name; takes the one parameter that is not a number out of the others.
fn effect_for(name: &str, given: &mut Vec<(&str, &str)>) -> Result<Box<dyn Effect>, RequestError> {
    if name == FIRMWARE_MISMATCH {
        let message = "firmware_mismatch cannot be simulated: it is a difference between a device's log and its replay";
        return Err(RequestError(message.into()));
    }
    if name == "load_current"
        && let Some(index) = given.iter().position(|(key, _)| *key == "load")
    {
        let (_, load) = given.remove(index);
        return Ok(Box::new(effects::LoadCurrent { load: Some(load.into()) }));
    }
    let mut all = library();
    match all.iter().position(|effect| effect.spec().name == name) {
        Some(index) => Ok(all.swap_remove(index)),
        None => Err(RequestError(unknown(name, &all))),
    }
}

fn unknown(name: &str, all: &[Box<dyn Effect>]) -> String {
    let names = all.iter().map(|effect| effect.spec().name);
    let nearest = names.clone().max_by(|a, b| strsim::jaro_winkler(a, name).total_cmp(&strsim::jaro_winkler(b, name)));
    let hint = nearest.filter(|near| strsim::jaro_winkler(near, name) > 0.8);
    let hint = hint.map_or(String::new(), |near| format!("; did you mean {near}?"));
    let list = names.collect::<Vec<_>>().join(", ");
    format!("there is no effect {}{hint} Effects: {list}", quoted(name.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        text.parse::<Request>().unwrap_err().to_string()
    }

    #[test]
    fn every_effect_has_a_title_of_its_own() {
        let mut titles: Vec<&str> = library().iter().map(|effect| title(effect.spec().name)).collect();
        titles.extend([FIRMWARE_MISMATCH, "none", "unknown"].map(title));
        let count = titles.len();
        titles.sort_unstable();
        titles.dedup();
        assert_eq!(titles.len(), count);
        assert!(titles.iter().all(|title| (10..=45).contains(&title.len())));
    }

    #[test]
    fn the_documentation_has_every_effect_with_its_parameters() {
        let text = include_str!("../../../docs/scenarios.md");
        for effect in library() {
            let spec = effect.spec();
            let names: Vec<_> = spec.parameters.iter().map(|p| format!("`{}`", p.name)).collect();
            let row = format!("| `{}` | {} |", spec.name, names.join(", "));
            assert!(text.contains(&row), "docs/scenarios.md lacks: {row}");
        }
    }

    #[test]
    fn parameters_are_read_by_name() {
        let request: Request = "sample_slip: samples=-2 , time_s=130.5".parse().unwrap();
        assert_eq!((request.effect.spec().name, &request.parameters[..]), ("sample_slip", &[130.5, -2.0][..]));
        let bias: Request = "fluxgate_bias:y_nT=1e1".parse().unwrap();
        assert_eq!(bias.parameters, [0.0, 10.0, 0.0]);
        let load: Request = "load_current:load=strobe,x_nT=3".parse().unwrap();
        assert_eq!((load.effect.load(), &load.parameters[..]), (Some("strobe"), &[3.0, 0.0, 0.0][..]));
    }

    #[test]
    fn what_is_wrong_is_said_with_ranges_and_units() {
        assert!(error("scalar_lagg:lag_s=1").contains("did you mean scalar_lag?"));
        assert!(error("x:lag_s=1").contains("Effects: scalar_lag, clock_drift"));
        assert_eq!(error("scalar_lag"), "scalar_lag needs parameters, scalar_lag:param=value,...: lag_s (-2 to 2 s)");
        assert_eq!(error("scalar_lag:lag_s=5"), "scalar_lag: lag_s=5 is outside -2 to 2 s");
        assert_eq!(error("scalar_lag:lag_s=nan"), "scalar_lag: lag_s=nan is outside -2 to 2 s");
        assert_eq!(error("scalar_lag:lag_s=x"), "scalar_lag: lag_s=x is not a number");
        assert_eq!(error("scalar_lag:lag_s"), "scalar_lag: \"lag_s\" is not param=value");
        assert_eq!(error("scalar_lag:lag_s=1,lag_s=1"), "scalar_lag: lag_s is there twice");
        assert_eq!(error("scalar_lag:lag=1"), "scalar_lag has no parameter \"lag\"; it has: lag_s (-2 to 2 s)");
        assert_eq!(error("permanent_step:x_nT=1"), "permanent_step needs time_s (the recording, in s)");
        assert_eq!(error("sample_slip:time_s=1,samples=0.5"), "sample_slip: samples=0.5 is not a whole number");
        assert!(error("firmware_mismatch").contains("cannot be simulated"));
    }
}
