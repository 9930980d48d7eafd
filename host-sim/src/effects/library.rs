//! All effects by name, and what `--effect` says.

use std::sync::Arc;

use towmag_effect_file::EffectFile;

use crate::effects::{self, Domain, Effect, FileEffect, Kind, Parameter, Spec};
use crate::message::{number, quoted, shortened};
use crate::simulator::signals::Signals;

/// A set of effects, each under a name of its own. Cloning shares the effects.
#[derive(Clone, Debug)]
pub struct Library {
    effects: Vec<Arc<dyn Effect>>,
}

impl Default for Library {
    /// Every effect of this program that has a forward model, in the order of the documentation.
    fn default() -> Self {
        let effects: Vec<Arc<dyn Effect>> = vec![
            Arc::new(effects::ScalarLag),
            Arc::new(effects::ClockDrift),
            Arc::new(effects::SampleSlip),
            Arc::new(effects::SampleJitter),
            Arc::new(effects::StaleSample),
            Arc::new(effects::AveragingWindow),
            Arc::new(effects::ScalarLowpass),
            Arc::new(effects::HeadingError),
            Arc::new(effects::DeadZone),
            Arc::new(effects::MainsAlias),
            Arc::new(effects::FluxgateBias),
            Arc::new(effects::FluxgateScale),
            Arc::new(effects::FluxgateNonorthogonality),
            Arc::new(effects::FluxgateTemperatureDrift),
            Arc::new(effects::FluxgateNonlinearity),
            Arc::new(effects::FluxgateQuantisation),
            Arc::new(effects::PermanentStep),
            Arc::new(effects::PermanentTemperature),
            Arc::new(effects::SecondOrder),
            Arc::new(effects::EddyLag),
            Arc::new(effects::LoadCurrent::default()),
            Arc::new(effects::DepthGradient),
            Arc::new(effects::SwellInduction),
        ];
        Self { effects }
    }
}

impl std::ops::Deref for Library {
    type Target = [Arc<dyn Effect>];

    fn deref(&self) -> &Self::Target {
        &self.effects
    }
}

impl Library {
    /// With one effect more.
    pub fn with(mut self, effect: impl Effect + 'static) -> Self {
        self.effects.push(Arc::new(effect));
        self
    }

    /// With an effect that a user wrote, under a name of its own.
    ///
    /// # Errors
    ///
    /// When its name is taken.
    pub fn with_file(self, file: EffectFile) -> Result<Self, RequestError> {
        let name = file.name.as_str();
        let is_taken = self.spec(name).is_some() || NOT_EFFECTS.contains(&name);
        match is_taken {
            true => Err(RequestError(format!("{}: the name {name} is taken: give the effect another one", file.file))),
            false => Ok(self.with(FileEffect::new(file))),
        }
    }

    /// Those that make sense on a recording, and once more each that a recorded current can drive.
    pub fn applicable_to(&self, signals: &Signals) -> Self {
        let loads = || signals.trajectory().currents_a.iter().map(|(load, _)| load);
        let plain = self.iter().filter(|effect| effect.applies_to(signals)).cloned();
        let driven = self.iter().flat_map(|effect| loads().filter_map(|load| effect.driven_by(load)));
        Self { effects: plain.chain(driven).collect() }
    }

    /// Columns of a recording that they need, by their names, beside those that every effect may ask for.
    pub fn columns(&self) -> Vec<String> {
        let mut columns: Vec<String> = self.iter().flat_map(|effect| effect.columns()).map(String::from).collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    }

    /// What is written about each effect.
    pub fn specs(&self) -> impl Iterator<Item = &'static Spec> {
        self.iter().map(|effect| effect.spec())
    }

    /// What is written about one effect.
    pub fn spec(&self, name: &str) -> Option<&'static Spec> {
        self.specs().find(|spec| spec.name == name)
    }

    /// An effect with its parameters, from `name:param=value,...`. Linear and cyclic parameters that are left out are 0,
    /// if another is given.
    ///
    /// # Errors
    ///
    /// When there is no such effect or parameter, or a value is missing, no number or out of its range.
    pub fn request(&self, text: &str) -> Result<Request, RequestError> {
        let (name, list) = text.split_once(':').unwrap_or((text, ""));
        let mut given = pairs(name, list)?;
        let effect = self.requested(name.trim(), &mut given)?;
        let spec = effect.spec();
        if let Some((unknown, _)) = given.iter().find(|(key, _)| spec.parameters.iter().all(|p| p.name != *key)) {
            let message =
                format!("{name} has no parameter {}; it has: {}", quoted(unknown.as_bytes()), described(spec));
            return Err(RequestError(message));
        }
        let defaults = effect.defaults();
        if given.is_empty() && defaults.is_none() {
            return Err(RequestError(format!("{name} needs parameters, {name}:param=value,...: {}", described(spec))));
        }
        let default = |index: usize| defaults.as_ref().map(|defaults| defaults[index]);
        let value = |(index, p): (usize, &Parameter)| p.value_in(name, &given, default(index));
        let parameters = spec.parameters.iter().enumerate().map(value).collect::<Result<_, _>>()?;
        Ok(Request { effect, parameters })
    }

    /// The effect of a name; takes the one parameter that is not a number, the load, out of the others.
    fn requested(&self, name: &str, given: &mut Vec<(&str, &str)>) -> Result<Arc<dyn Effect>, RequestError> {
        if name == FIRMWARE_MISMATCH {
            return Err(RequestError(format!(
                "{FIRMWARE_MISMATCH} cannot be simulated: it is a difference between a device's log and its replay"
            )));
        }
        let Some(effect) = self.iter().find(|effect| effect.spec().name == name) else {
            return Err(RequestError(unknown(name, self)));
        };
        let load = given.iter().position(|(key, _)| *key == "load");
        match load.and_then(|index| Some((index, effect.driven_by(given[index].1)?))) {
            Some((index, driven)) => {
                given.remove(index);
                Ok(driven)
            }
            None => Ok(Arc::clone(effect)),
        }
    }
}

/// Names of results that are no effects with a forward model.
const NOT_EFFECTS: [&str; 3] = [FIRMWARE_MISMATCH, "none", "unknown"];

/// Found by comparing the device's outputs with a replay; it has no forward model.
pub const FIRMWARE_MISMATCH: &str = "firmware_mismatch";

/// An effect with its parameters: what `--effect name:param=value,...` says.
#[derive(Debug)]
pub struct Request {
    /// The effect.
    pub effect: Arc<dyn Effect>,
    /// Its parameters, in the order of its [`Spec`].
    pub parameters: Vec<f64>,
}

/// What is wrong with a request, in a sentence that says what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RequestError(String);

impl std::str::FromStr for Request {
    type Err = RequestError;

    /// Of an effect of this program: see [`Library::request`].
    fn from_str(text: &str) -> Result<Self, RequestError> {
        Library::default().request(text)
    }
}

impl Parameter {
    fn value_in(&self, effect: &str, given: &[(&str, &str)], default: Option<f64>) -> Result<f64, RequestError> {
        let may_be_absent = self.kind == Kind::Linear || matches!(self.domain, Domain::Cyclic { .. });
        match given.iter().find(|(key, _)| *key == self.name) {
            Some((_, text)) => self.parse(effect, text),
            None if default.is_some() => Ok(default.unwrap_or_default()),
            None if may_be_absent => Ok(0.0),
            None => Err(RequestError(format!("{effect} needs {}", self.described()))),
        }
    }

    fn parse(&self, effect: &str, text: &str) -> Result<f64, RequestError> {
        let wrong =
            |what: &str| RequestError(format!("{effect}: {}={} {what}", self.name, shortened(text.as_bytes(), 32)));
        let value: f64 = text.trim().parse().map_err(|_| wrong("is not a number"))?;
        if self.domain == Domain::Whole && value.fract() != 0.0 {
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

fn unknown(name: &str, all: &Library) -> String {
    let names: Vec<&str> = all.specs().map(|spec| spec.name).collect();
    let nearest = names.iter().max_by(|a, b| strsim::jaro_winkler(a, name).total_cmp(&strsim::jaro_winkler(b, name)));
    let hint = nearest.filter(|near| strsim::jaro_winkler(near, name) > 0.8);
    let hint = hint.map_or(String::new(), |near| format!("; did you mean {near}?"));
    let list = names.join(", ");
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
        let mut titles: Vec<&str> = Library::default().specs().map(|spec| spec.title).collect();
        let count = titles.len();
        titles.sort_unstable();
        titles.dedup();
        assert_eq!(titles.len(), count);
        assert!(titles.iter().all(|title| (10..=45).contains(&title.len())));
    }

    #[test]
    fn the_documentation_has_every_effect_with_its_parameters() {
        let text = include_str!("../../../docs/scenarios.md");
        for spec in Library::default().specs() {
            let names: Vec<_> = spec.parameters.iter().map(|p| format!("`{}`", p.name)).collect();
            let row = format!("| `{}` | {} | {} |", spec.name, names.join(", "), spec.model);
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
