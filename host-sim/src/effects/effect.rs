//! What an unmodelled effect is. Written once: `simulate` switches it on, `diagnose` fits it.

use rand_chacha::ChaCha8Rng;

use crate::simulator::signals::Signals;

/// The generator of everything random: the same stream for a seed on every platform and release.
pub type Draw = ChaCha8Rng;

/// An effect, as it is written about.
#[derive(Debug)]
pub struct Spec {
    /// Its name on the command line and in every result.
    pub name: &'static str,
    /// What it is, in a few words that can follow "explained by".
    pub title: &'static str,
    /// What it is, in a sentence.
    pub what: &'static str,
    /// Where it comes from.
    pub origin: &'static str,
    /// Where its plausible size comes from.
    pub source: &'static str,
    /// Its parameters, in the order of every slice of them.
    pub parameters: &'static [Parameter],
    /// The channel that it changes.
    pub channel: Channel,
    /// The optional column without which it has no meaning.
    pub needs: Option<Column>,
    /// Whether it is random from epoch to epoch, so that only its variance can be known.
    pub random: bool,
}

/// A parameter of an effect.
#[derive(Debug)]
pub struct Parameter {
    /// Its name, with its unit.
    pub name: &'static str,
    /// Its unit, for a reader; empty when it has none.
    pub unit: &'static str,
    /// Range that is accepted, both ends included.
    pub range: [f64; 2],
    /// Range that is plausible in the field, where a search should look.
    pub plausible: [f64; 2],
    /// How the change depends on it.
    pub kind: Kind,
}

/// How a change depends on a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// In proportion, the nonlinear ones held. 0 is no effect.
    Linear,
    /// In any other way. See [`Effect::regressors`] for those that are linear in other coordinates.
    Nonlinear,
    /// In any other way, and only whole numbers have a meaning.
    Whole,
    /// It turns over: the ends of its range are the same.
    Cyclic,
}

/// What an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// The scalar sensor's reading.
    Scalar,
    /// The fluxgate's reading.
    Fluxgate,
}

/// An optional column of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// `depth_m`.
    Depth,
    /// `temperature_degC`.
    Temperature,
}

/// What an effect adds to the readings, one value a row; empty where it adds nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// To the scalar, nT.
    pub scalar_nt: Vec<f64>,
    /// To the fluxgate, nT.
    pub flux_nt: Vec<[f64; 3]>,
}

/// Readings with noise, one a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    /// Scalar, nT.
    pub scalar_nt: Vec<f64>,
    /// Fluxgate in body axes, nT.
    pub flux_nt: Vec<[f64; 3]>,
}

/// An unmodelled effect.
pub trait Effect: std::fmt::Debug + Send + Sync {
    /// What it is.
    fn spec(&self) -> &'static Spec;

    /// What it adds before the sensor noise. `parameters` are in the order of the [`Spec`] and in its units.
    fn change(&self, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change;

    /// What it does to readings that have their noise already.
    fn after_noise(&self, _signals: &Signals, _parameters: &[f64], _readings: &mut Readings, _draw: &mut Draw) {}

    /// Variance that it adds to each reading, nT^2, of effects that are random from epoch to epoch.
    fn variance(&self, _signals: &Signals, _parameters: &[f64]) -> Option<Change> {
        None
    }

    /// Changes for a unit of each linear coordinate, the nonlinear parameters held: any change with them is a sum.
    ///
    /// The coordinates are the linear parameters unless an effect says otherwise.
    fn regressors(&self, signals: &Signals, parameters: &[f64]) -> Vec<Change> {
        let linear = linear_parameters(self.spec());
        let unit = |&of: &usize| {
            let mut at = parameters.to_vec();
            linear.iter().for_each(|&index| at[index] = f64::from(u8::from(index == of)));
            self.change(signals, &at, &mut no_draw())
        };
        linear.iter().map(unit).collect()
    }

    /// The parameters that linear coordinates stand for, in the order of [`Self::regressors`].
    #[expect(clippy::wrong_self_convention, reason = "an effect turns its coordinates into its parameters")]
    fn from_coordinates(&self, parameters: &[f64], coordinates: &[f64]) -> Vec<f64> {
        let mut at = parameters.to_vec();
        linear_parameters(self.spec()).iter().zip(coordinates).for_each(|(&index, &value)| at[index] = value);
        at
    }

    /// The load whose recorded current drives it, for the effect that may have one.
    fn load(&self) -> Option<&str> {
        None
    }

    /// Whether a recording holds what it needs.
    fn applies_to(&self, signals: &Signals) -> bool {
        let column = match self.spec().needs {
            None => true,
            Some(Column::Depth) => signals.trajectory().depth_m.is_some(),
            Some(Column::Temperature) => signals.trajectory().temperature_deg_c.is_some(),
        };
        column && self.load().is_none_or(|load| signals.current_a(load).is_some())
    }
}

/// Everything that an effect does to readings without noise: what its size is measured by.
pub fn change_of_clean(effect: &dyn Effect, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change {
    let clean = Readings { scalar_nt: signals.rows().scalar_nt.clone(), flux_nt: signals.rows().flux_nt.clone() };
    let mut readings = clean.clone();
    readings.add(&effect.change(signals, parameters, draw));
    effect.after_noise(signals, parameters, &mut readings, draw);
    let scalar_nt = readings.scalar_nt.iter().zip(&clean.scalar_nt).map(|(with, without)| with - without).collect();
    let flux_nt = readings.flux_nt.iter().zip(&clean.flux_nt).map(|(with, without)| minus(*with, *without)).collect();
    match effect.spec().channel {
        Channel::Scalar => Change::of_scalar(scalar_nt),
        Channel::Fluxgate => Change::of_flux(flux_nt),
    }
}

/// Where the linear parameters are.
pub fn linear_parameters(spec: &Spec) -> Vec<usize> {
    spec.parameters.iter().enumerate().filter(|(_, p)| p.kind == Kind::Linear).map(|(index, _)| index).collect()
}

/// For effects that draw nothing.
pub fn no_draw() -> Draw {
    rand::SeedableRng::seed_from_u64(0)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

impl Change {
    /// Of the scalar alone.
    pub fn of_scalar(scalar_nt: Vec<f64>) -> Self {
        Self { scalar_nt, flux_nt: Vec::new() }
    }

    /// Of the fluxgate alone.
    pub fn of_flux(flux_nt: Vec<[f64; 3]>) -> Self {
        Self { scalar_nt: Vec::new(), flux_nt }
    }

    /// Root mean square over the rows of what it changes: of the scalar, or of the fluxgate vector; nT.
    pub fn rms_nt(&self) -> f64 {
        let squares: Vec<f64> = match self.flux_nt.is_empty() {
            true => self.scalar_nt.iter().map(|x| x * x).collect(),
            false => self.flux_nt.iter().map(|v| v.iter().map(|x| x * x).sum()).collect(),
        };
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }
}

impl Readings {
    /// Add what an effect adds.
    pub fn add(&mut self, change: &Change) {
        self.scalar_nt.iter_mut().zip(&change.scalar_nt).for_each(|(reading, change)| *reading += change);
        for (reading, change) in self.flux_nt.iter_mut().zip(&change.flux_nt) {
            reading.iter_mut().zip(change).for_each(|(component, change)| *component += change);
        }
    }
}
