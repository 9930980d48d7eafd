//! Effects that users write, by the words of `docs/effect_files.md` and on the trial's own signals at 100 Hz: the language is
//! shared with the program that is tried, what it means is not.

use std::ops::Range;

use rand::RngExt;
use towmag_effect_file::{BoundFormula, EffectFile, Filter, FilterTime, Input, Kind, Parameter, Source, Variable};

use super::super::grid::Grid;
use super::super::{Change, World};
use super::effect::{Act, Channel, Effect, Parameters, Written, either_sign};
use super::timing::read_late;
use crate::random::Random;

/// Sizes are drawn within this share of their bounds, and sized from there.
const FIRST_SHARE: f64 = 0.1;

/// An effect of a file.
pub(crate) fn of_file(file: EffectFile) -> Result<Effect, String> {
    let depth = Source::Variable(Variable::Depth);
    let is_of_another = |input: &&Input| input.filter == Filter::Hilbert && input.of.alone() != Some(&depth);
    if let Some(input) = file.inputs.iter().find(is_of_another) {
        return Err(format!("{}: in a trial, hilbert is of depth alone", input.name));
    }
    if let Some(column) = file.columns().into_iter().find(|name| load_of(name).is_none()) {
        return Err(format!("{} needs the column {column}, which no recording of a trial has", file.name));
    }
    if file.channel == towmag_effect_file::Channel::Fluxgate && file.kind == Kind::Delay {
        return Err(format!("{} delays the fluxgate, of which the trial has no model", file.name));
    }
    let channel = match file.channel {
        towmag_effect_file::Channel::Scalar => Channel::Scalar,
        towmag_effect_file::Channel::Fluxgate => Channel::Fluxgate,
    };
    let sizes: Vec<&'static str> =
        file.parameters.iter().filter(|p| is_size(&file, p)).map(|p| &*String::leak(p.name.clone())).collect();
    Ok(Effect {
        name: String::leak(file.name.clone()),
        channel,
        sizes: Vec::leak(sizes),
        most: f64::MAX,
        draw: |_, _| None,
        act: Act::Own(Box::new(OfFile(file))),
    })
}

fn load_of(column: &str) -> Option<&str> {
    column.strip_prefix("current_")?.strip_suffix("_A")
}

/// Whether the change grows with a parameter: it is linear, or the only one of a delay.
fn is_size(file: &EffectFile, parameter: &Parameter) -> bool {
    parameter.is_linear || (file.kind == Kind::Delay && file.parameters.len() == 1 && file.is_proportional_to(0))
}

/// One that was read from a file.
struct OfFile(EffectFile);

impl Written for OfFile {
    fn change(&self, world: &World, parameters: &Parameters) -> Change {
        change(&self.0, world, parameters)
    }

    fn drawn(&self, world: &World, draw: &mut Random) -> Option<Parameters> {
        drawn(&self.0, world, draw)
    }

    fn room(&self, parameters: &Parameters) -> f64 {
        room(&self.0, parameters)
    }
}

/// Any parameters within their bounds; none where this world lacks what the formula is made of.
fn drawn(file: &EffectFile, world: &World, draw: &mut Random) -> Option<Parameters> {
    let is_there = |source: &Source| match source {
        Source::Variable(variable) => course(world, *variable).is_some(),
        Source::Column(name) => current(world, name).is_some(),
        Source::Parameter(_) | Source::Input(_) => true,
    };
    if !file.sources().all(is_there) {
        return None;
    }
    let mut one = |parameter: &Parameter| {
        let value = match is_size(file, parameter) {
            // Small, of a sign that the bounds allow.
            true if parameter.low < 0.0 && parameter.high > 0.0 => {
                FIRST_SHARE * either_sign(draw) * parameter.high.min(-parameter.low) * draw.random_range(0.3..1.0)
            }
            true => FIRST_SHARE * parameter.high + (1.0 - FIRST_SHARE) * parameter.low,
            false => draw.random_range(parameter.low..parameter.high),
        };
        (parameter.name.clone(), value)
    };
    Some(file.parameters.iter().map(&mut one).collect())
}

/// How many times as large all sizes may be within their bounds.
fn room(file: &EffectFile, parameters: &Parameters) -> f64 {
    let of = |parameter: &Parameter| {
        let value = parameters[&parameter.name];
        let end = if value < 0.0 { parameter.low } else { parameter.high };
        if value == 0.0 { f64::MAX } else { end / value }
    };
    file.parameters.iter().filter(|parameter| is_size(file, parameter)).map(of).fold(f64::MAX, f64::min)
}

/// What it changes at each row.
fn change(file: &EffectFile, world: &World, parameters: &Parameters) -> Change {
    let at: Vec<f64> = file.parameters.iter().map(|parameter| parameters[&parameter.name]).collect();
    let inputs = inputs(file, world, &at);
    let values: Vec<Vec<f64>> = file.formulas.iter().map(|formula| values(world, formula, &inputs, &at)).collect();
    let clean = world.clean();
    match (file.channel, file.kind) {
        (towmag_effect_file::Channel::Scalar, Kind::Additive) => Change::of_scalar(values.concat()),
        (towmag_effect_file::Channel::Scalar, Kind::Multiplicative) => {
            Change::of_scalar(values[0].iter().zip(&clean.scalar_nt).map(|(value, nt)| value * nt).collect())
        }
        (towmag_effect_file::Channel::Scalar, Kind::Delay) => {
            Change::of_scalar(read_late(world, |row, _| values[0][row]))
        }
        (towmag_effect_file::Channel::Fluxgate, kind) => {
            let factor = |row: usize, k: usize| if kind == Kind::Multiplicative { clean.flux_nt[row][k] } else { 1.0 };
            let row = |row: usize| [0, 1, 2].map(|k| values[k][row] * factor(row, k));
            Change { flux_nt: (0..world.rows()).map(row).collect(), ..Change::default() }
        }
    }
}

/// A formula at each row.
fn values(world: &World, formula: &BoundFormula, inputs: &[Vec<f64>], at: &[f64]) -> Vec<f64> {
    let column = |source: &Source| match source {
        Source::Parameter(index) => vec![at[*index]; world.rows()],
        Source::Input(index) => world.grid.at_rows(&inputs[*index]),
        Source::Variable(variable) => {
            course(world, *variable).map(|fine| world.grid.at_rows(&fine)).unwrap_or_default()
        }
        Source::Column(name) => current(world, name).unwrap_or_default().to_vec(),
    };
    let columns: Vec<Vec<f64>> = formula.sources.iter().map(column).collect();
    let row = |row: usize| formula.eval(&columns.iter().map(|column| column[row]).collect::<Vec<f64>>());
    // What has no value somewhere changes nothing there.
    (0..world.rows()).map(row).map(|value| if value.is_finite() { value } else { 0.0 }).collect()
}

/// A variable at 100 Hz; none where it is not recorded.
fn course(world: &World, variable: Variable) -> Option<Vec<f64>> {
    let component = |vectors: &[[f64; 3]], k: usize| vectors.iter().map(|v| v[k]).collect::<Vec<f64>>();
    let columns = &world.columns;
    Some(match variable {
        Variable::Direction(k) => component(&world.direction, k),
        Variable::DirectionRate(k) => component(&world.rate, k),
        Variable::Field => world.field_nt.clone(),
        Variable::Scalar => world.scalar_nt.clone(),
        Variable::Flux(k) => world.field_nt.iter().zip(&world.direction).map(|(nt, c)| nt * c[k]).collect(),
        Variable::Time => world.grid.times_s().collect(),
        Variable::RecordingTime => world.grid.times_s().map(|t| columns.first_time_s + t).collect(),
        Variable::Depth => {
            world.motion.depth.as_ref().filter(|_| columns.has_depth).map(|depth| depth.depth_m.clone())?
        }
        Variable::Temperature => columns.has_temperature.then(|| between_rows(world, &columns.temperature_deg_c))?,
    })
}

/// The current of a load at each row.
fn current<'a>(world: &'a World, column: &str) -> Option<&'a [f64]> {
    let (name, current_a) = world.columns.load.as_ref()?;
    (load_of(column) == Some(name)).then_some(current_a)
}

/// Straight lines between rows, at 100 Hz.
fn between_rows(world: &World, rows: &[f64]) -> Vec<f64> {
    let last = rows.len().saturating_sub(1);
    let at = |t: f64| {
        let place = (t / Grid::row_s(1)).clamp(0.0, last as f64);
        let row = (place.floor() as usize).min(last.saturating_sub(1));
        rows[row] + (place - row as f64) * (rows[(row + 1).min(last)] - rows[row])
    };
    world.grid.times_s().map(at).collect()
}

/// Every input at 100 Hz.
fn inputs(file: &EffectFile, world: &World, at: &[f64]) -> Vec<Vec<f64>> {
    let mut inputs: Vec<Vec<f64>> = Vec::new();
    for input in &file.inputs {
        let source = |source: &Source| match source {
            Source::Input(index) => inputs[*index].clone(),
            Source::Variable(variable) => course(world, *variable).unwrap_or_default(),
            Source::Column(name) => current(world, name).map(|rows| between_rows(world, rows)).unwrap_or_default(),
            Source::Parameter(index) => vec![at[*index]; world.grid.len()],
        };
        let of_all: Vec<Vec<f64>> = input.of.sources.iter().map(source).collect();
        let each = |k: usize| input.of.eval(&of_all.iter().map(|of| of[k]).collect::<Vec<f64>>());
        // What has no value somewhere is nothing there.
        let of: Vec<f64> =
            (0..world.grid.len()).map(each).map(|value| if value.is_finite() { value } else { 0.0 }).collect();
        let time_s = |time: FilterTime| match time {
            FilterTime::Fixed(time_s) => time_s,
            FilterTime::Parameter(index) => at[index],
        };
        inputs.push(match input.filter {
            Filter::LowPass(time) => low_pass(world, &of, time_s(time)),
            Filter::Delay(time) => delayed(world, &of, time_s(time)),
            Filter::Mean(time) => mean(world, &of, time_s(time)),
            Filter::Rate => Grid::derivative(&of),
            Filter::Play(width) => played(world, &of, width),
            Filter::Hold(width) => held(world, &of, width),
            Filter::Hilbert => world.motion.depth.as_ref().map(|depth| depth.behind_m.clone()).unwrap_or_default(),
        });
    }
    inputs
}

/// Samples that belong to each stretch without a gap, the first and the last with all that is beyond the rows.
fn stretches(world: &World) -> Vec<Range<usize>> {
    let segments = world.columns.segments(world.rows());
    let start = |row: usize| if row == 0 { 0 } else { Grid::of_row(row) };
    let end = |row: usize| if row == world.rows() { world.grid.len() } else { Grid::of_row(row - 1) + 1 };
    segments.iter().filter(|rows| !rows.is_empty()).map(|rows| start(rows.start)..end(rows.end)).collect()
}

fn low_pass(world: &World, of: &[f64], time_constant_s: f64) -> Vec<f64> {
    let restarts: Vec<usize> = stretches(world).iter().skip(1).map(|samples| samples.start).collect();
    Grid::low_pass(of, time_constant_s, &restarts)
}

fn delayed(world: &World, of: &[f64], delay_s: f64) -> Vec<f64> {
    let times_s: Vec<f64> = world.grid.times_s().collect();
    let mut late = of.to_vec();
    for samples in stretches(world) {
        let [from_s, to_s] = [times_s[samples.start], times_s[samples.end - 1]];
        for k in samples {
            late[k] = world.grid.at(of, (times_s[k] - delay_s).clamp(from_s, to_s));
        }
    }
    late
}

/// Follows once the play is taken up, anew in each stretch.
fn played(world: &World, of: &[f64], width: f64) -> Vec<f64> {
    let mut played = of.to_vec();
    for samples in stretches(world) {
        let mut at = of[samples.start];
        for k in samples {
            at = at.clamp(of[k] - width, of[k] + width);
            played[k] = at;
        }
    }
    played
}

/// Stays as it was until it is further away than that, anew in each stretch.
fn held(world: &World, of: &[f64], width: f64) -> Vec<f64> {
    let mut held = of.to_vec();
    for samples in stretches(world) {
        let mut at = of[samples.start];
        for k in samples {
            if (of[k] - at).abs() > width {
                at = of[k];
            }
            held[k] = at;
        }
    }
    held
}

/// Over the window, before the stretch begins what it was there.
fn mean(world: &World, of: &[f64], window_s: f64) -> Vec<f64> {
    if window_s < 1e-6 {
        return of.to_vec();
    }
    let integral = Grid::integral(of);
    let times_s: Vec<f64> = world.grid.times_s().collect();
    let mut mean = of.to_vec();
    for samples in stretches(world) {
        let first = samples.start;
        for k in samples {
            let before_s = (times_s[first] - (times_s[k] - window_s)).max(0.0);
            let from = world.grid.at(&integral, (times_s[k] - window_s).max(times_s[first]));
            mean[k] = (integral[k] - from + before_s * of[first]) / window_s;
        }
    }
    mean
}
