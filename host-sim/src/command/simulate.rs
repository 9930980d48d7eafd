//! `host-sim simulate`: a recording from a scenario, with unmodelled effects if asked for.

use std::io::{self, Write};
use std::path::Path;

use crate::effects::Request;
use crate::effects::{Column, change_of_clean, no_draw};
use crate::error::HostError;
use crate::output::{OutputError, OutputFile};
use crate::simulator::scenario::{Lost, Recorded, Scenario, Simulation, band_passed_std_nt};
use crate::wire::{Wires, through_sensors};

/// What stands for standard output on the command line.
const STDOUT: &str = "-";

/// What `simulate` made.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulateResult {
    /// Rows written.
    pub rows: usize,
    /// Seed that it was made with.
    pub seed: u64,
    /// Band-passed standard deviation of the scalar (0.1 to 0.9 Hz), nT.
    pub std_before_nt: f64,
    /// Name of each effect, and what it changes, nT rms.
    pub effects: Vec<(&'static str, f64)>,
    /// What the wires have cost, if it went through them.
    pub through: Option<Through>,
}

/// What became of a recording on its way through the sensors' wires.
#[derive(Clone, Debug, PartialEq)]
pub struct Through {
    /// Readings that the body does not have.
    pub lost: Lost,
    /// What its drivers have counted, and how often.
    pub faults: Vec<(&'static str, u32)>,
}

impl std::fmt::Display for Through {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Lost { scalar, fluxgate } = self.lost;
        write!(f, "Through the sensors: {scalar} scalar and {fluxgate} fluxgate readings lost")?;
        self.faults.iter().try_for_each(|(what, count)| write!(f, ", {what}: {count}"))
    }
}

/// Make a recording. `seed` goes before the scenario's own; with `wires`, the recording is what the body's drivers make
/// of what the sensors send.
pub fn simulate(
    scenario_file: &Path,
    out: &Path,
    seed: Option<u64>,
    effects: &[Request],
    wires: Option<&Wires>,
) -> Result<SimulateResult, HostError> {
    if let (Ok(input), Ok(output)) = (scenario_file.canonicalize(), out.canonicalize())
        && input == output
    {
        return Err(HostError::Usage(format!("{}: would be replaced by the recording", out.display())));
    }
    let scenario = Scenario::read(scenario_file)?;
    let seed = seed.unwrap_or(scenario.seed);
    let named = |what: String| HostError::Usage(format!("{}: {what}", scenario_file.display()));
    let simulation = Simulation::new(&scenario, seed).map_err(named)?;
    effects.iter().try_for_each(|request| check(request, &simulation))?;
    let mut recorded = simulation.record(effects);
    let through = wires.map(|wires| sensed(&mut recorded, wires)).transpose()?;
    match out.as_os_str() == STDOUT {
        true => print_whole(&csv(&recorded)?)?,
        false => write_whole(out, &csv(&recorded)?)?,
    }
    let readings_nt = recorded.readings.scalar_nt.iter().copied();
    let rms = |request: &Request| {
        let change = change_of_clean(&*request.effect, simulation.signals(), &request.parameters, &mut no_draw());
        (request.effect.spec().name, change.rms_nt())
    };
    Ok(SimulateResult {
        rows: simulation.signals().len(),
        seed,
        std_before_nt: band_passed_std_nt(readings_nt.filter(|nt| !nt.is_nan())),
        effects: effects.iter().map(rms).collect(),
        through,
    })
}

fn sensed(recorded: &mut Recorded<'_>, wires: &Wires) -> Result<Through, HostError> {
    let sensed = through_sensors(&csv(recorded)?, wires)?;
    Ok(Through { lost: recorded.sensed(&sensed.epochs), faults: sensed.faults })
}

fn csv(recorded: &Recorded<'_>) -> Result<Vec<u8>, HostError> {
    let mut csv = Vec::new();
    recorded.write_csv(&mut csv)?;
    Ok(csv)
}

/// Whoever reads it may have enough before the end.
fn print_whole(bytes: &[u8]) -> Result<(), OutputError> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(source) => Err(OutputError::Io { path: "standard output".into(), source }),
        Ok(()) => Ok(()),
    }
}

fn write_whole(out: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let mut file = OutputFile::create(out)?;
    let named =
        |source: io::Error| source.downcast().unwrap_or_else(|source| OutputError::Io { path: out.into(), source });
    file.write_all(bytes).map_err(named)?;
    file.commit()
}

/// Whether an effect has a meaning in this scenario.
fn check(request: &Request, simulation: &Simulation) -> Result<(), HostError> {
    let (spec, signals) = (request.effect.spec(), simulation.signals());
    let usable = vec![true; signals.len()];
    if let Some(reason) = request.effect.refusal(signals, &usable, Some(&request.parameters)) {
        return Err(HostError::Usage(reason));
    }
    if !request.effect.applies_to(signals) {
        let need = match (spec.needs, request.effect.load()) {
            (Some(Column::Depth), _) => "a tow, for it needs a depth".into(),
            (Some(Column::Temperature), _) => "a [temperature] in the scenario".into(),
            (None, load) => format!("a [[current]] named \"{}\" in the scenario", load.unwrap_or_default()),
        };
        return Err(HostError::Usage(format!("{} needs {need}", spec.name)));
    }
    let Some(at) = spec.moment() else { return Ok(()) };
    let (time_s, first_s) = (request.parameters[at], signals.recording_time_s(0));
    let last_s = signals.recording_time_s(signals.len() - 1);
    if (first_s..=last_s).contains(&time_s) {
        return Ok(());
    }
    let name = spec.name;
    Err(HostError::Usage(format!("{name}: time_s={time_s} is outside the recording, {first_s} to {last_s} s")))
}
