//! From a recording to its diagnosis.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use towmag::model::TERMS;

use crate::diagnosis::evidence::shrink::frozen;
use crate::diagnosis::noise::blocks::{Block, blocks};
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::null::omnibus::{Finding, findings};
use crate::diagnosis::reconstruct::prepared::{Table, fill_holes};
use crate::diagnosis::reconstruct::reconstruction::Reconstruction;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::regression::term::Library;
use crate::diagnosis::result::Diagnosis;
use crate::diagnosis::search::exact::{QuantisationGrid, Repeats, quantisation_grid, repeats};
use crate::diagnosis::selection::{Analysis, Asked, search};
use crate::diagnosis::verdict;
use crate::effects::library::library_for;
use crate::effects::{Channel, no_draw};
use crate::error::HostError;
use crate::simulator::signals::{LONGEST_STEP_S, Signals};

/// Twice the log likelihood that repeats must gain to be more than chance.
const REPEATS_GAIN: f64 = 36.0;
/// The scalar's field is subtracted from the fluxgate's magnitude where that makes it quieter by this factor.
const COMMON_FIELD: f64 = 0.8;

/// What a diagnosis may be told.
#[derive(Clone, Debug, Default)]
pub struct DiagnoseSettings {
    /// Effects that are taken out of the library.
    pub withheld: Vec<String>,
    /// Seed of everything drawn.
    pub seed: u64,
    /// Coefficients of a calibration, to start from, in the units of eq. (4).
    pub coefficients: Option<[f64; TERMS]>,
}

/// Both channels, searched, and what needs no search.
pub(crate) struct Found<'a> {
    pub(crate) table: &'a Table,
    pub(crate) library: &'a Library,
    pub(crate) scalar: Analysis<'a>,
    pub(crate) fluxgate: Analysis<'a>,
    pub(crate) scalar_findings: Vec<Finding>,
    pub(crate) fluxgate_findings: Vec<Finding>,
    pub(crate) repeats: Option<(usize, Repeats)>,
    pub(crate) grid: Option<(usize, QuantisationGrid)>,
}

/// Samples that a diagnosis needs at least, in stretches without long gaps.
const LEAST_SAMPLES: usize = 300;

/// What a diagnosis is doing, for who waits for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The 18 terms alone, and what needs no search.
    Terms,
    /// Effects of the fluxgate.
    Fluxgate,
    /// Effects of the scalar sensor.
    Scalar,
    /// Probabilities, intervals, what to do next.
    Verdict,
    /// A second recording.
    Second,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Terms => "fitting the 18 terms",
            Self::Fluxgate => "searching for effects of the fluxgate",
            Self::Scalar => "searching for effects of the scalar sensor",
            Self::Verdict => "weighing what was found",
            Self::Second => "trying it on the second recording",
        })
    }
}

/// Diagnose a recording; with a second one, try the findings on it.
pub fn diagnose(table: &Table, confirm: Option<&Table>, settings: &DiagnoseSettings) -> Result<Diagnosis, HostError> {
    diagnose_telling(table, confirm, settings, &|_| {})
}

/// The same; `begins` is told of every stage.
pub(crate) fn diagnose_telling(
    table: &Table,
    confirm: Option<&Table>,
    settings: &DiagnoseSettings,
    begins: &dyn Fn(Stage),
) -> Result<Diagnosis, HostError> {
    for table in [Some(table), confirm].into_iter().flatten() {
        let samples: usize =
            blocks(&table.epochs_s(), &table.usable, LONGEST_STEP_S + 1e-6).iter().map(Block::len).sum();
        if samples < LEAST_SAMPLES {
            return Err(HostError::NotEnough(format!(
                "{}: no stretch of valid rows is long enough for a diagnosis: at least {:.0} s in pieces of 8 s or more",
                table.file,
                LEAST_SAMPLES as f64 / 10.0
            )));
        }
    }
    begins(Stage::Terms);
    let reconstruction = Reconstruction::of(table);
    let filled = fill(&table.scalar_nt);
    let start = Signals::new(reconstruction.trajectory(
        table,
        &table.flux_nt,
        &filled,
        settings.coefficients.unwrap_or([0.0; TERMS]),
    ));
    let library = library_for(&start);
    let found = find(table, &reconstruction, &library, start, settings, begins);
    begins(Stage::Verdict);
    let mut diagnosis = verdict::of(&found, &mut ChaCha8Rng::seed_from_u64(settings.seed));
    if let Some(second) = confirm {
        begins(Stage::Second);
        confirm_on(second, &found, settings, &mut diagnosis);
    }
    Ok(diagnosis)
}

/// Try what was found on a second recording: parameters frozen, 18 terms and background fitted anew.
fn confirm_on(second: &Table, found: &Found<'_>, settings: &DiagnoseSettings, diagnosis: &mut Diagnosis) {
    let reconstruction = Reconstruction::of(second);
    let start =
        Signals::new(reconstruction.trajectory(second, &second.flux_nt, &fill(&second.scalar_nt), [0.0; TERMS]));
    let nothing = DiagnoseSettings {
        withheld: found.library.iter().map(|effect| effect.spec().name.to_string()).collect(),
        ..settings.clone()
    };
    // The effects of the first recording, so that their indices mean the same.
    let there = find(second, &reconstruction, found.library, start, &nothing, &|_| {});
    for (analysis, other) in [(&found.scalar, &there.scalar), (&found.fluxgate, &there.fluxgate)] {
        for term in &analysis.fit.terms {
            let effect = &found.library[term.effect];
            if !is_portable(effect.spec().name) || !effect.applies_to(&other.problem.signals) {
                continue;
            }
            let closed = frozen(&other.problem, &other.fit, term, other.variance);
            let named = diagnosis.effects.iter_mut().find(|found| found.name == effect.spec().name);
            if let Some(named) = named {
                named.confirmed = Some(closed);
            }
        }
    }
}

/// Whether the parameters of an effect mean the same on another recording: not those that say when.
fn is_portable(name: &str) -> bool {
    !["sample_slip", "permanent_step", "mains_alias", "load_current"].contains(&name)
}

fn find<'a>(
    table: &'a Table,
    reconstruction: &Reconstruction,
    library: &'a Library,
    start: Signals,
    settings: &DiagnoseSettings,
    begins: &dyn Fn(Stage),
) -> Found<'a> {
    let allowed = |channel: Channel| -> Vec<usize> {
        let is_allowed = |&index: &usize| {
            let spec = library[index].spec();
            spec.channel == channel && !settings.withheld.iter().any(|name| name == spec.name)
        };
        (0..library.len()).filter(is_allowed).collect()
    };
    let index_of = |name: &str| {
        (0..library.len())
            .find(|&k| library[k].spec().name == name && !settings.withheld.iter().any(|other| other == name))
    };
    let all_blocks = cut(table, &table.usable, &start);
    let first = quick(library, &start, table, &all_blocks);
    let repeats = index_of("stale_sample").and_then(|index| {
        let found = repeats(table, &differences(&first.model_nt));
        (found.glrt > REPEATS_GAIN).then_some((index, found))
    });
    let grid = index_of("fluxgate_quantisation").and_then(|index| quantisation_grid(table).map(|grid| (index, grid)));
    let mut fresh = table.usable.clone();
    if let Some((_, repeats)) = &repeats {
        repeats.rows.iter().for_each(|&row| fresh[row] = false);
        // Whether the first reading after a hole repeats what is not there cannot be known.
        (1..table.len()).filter(|&row| !table.usable[row - 1]).for_each(|row| fresh[row] = false);
    }
    let scalar_blocks = cut(table, &fresh, &start);
    let flux_allowed: Vec<usize> = allowed(Channel::Fluxgate);
    let background_nt = first.field_nt.clone();
    let direction_noise_rad = table.direction_noise_rad();
    let searched = |flux_nt: &[[f64; 3]], reading: &[f64]| {
        let trajectory = reconstruction.trajectory(table, flux_nt, &background_nt, start.trajectory().coefficients);
        search(Asked {
            library,
            channel: Channel::Fluxgate,
            signals: Signals::new(trajectory),
            reading: reading.to_vec(),
            blocks: &all_blocks,
            allowed: &flux_allowed,
            direction_noise_rad,
        })
    };
    begins(Stage::Fluxgate);
    let reading = magnitude(table, &first, &start, &all_blocks);
    let mut fluxgate = searched(&table.flux_nt, &reading);
    let mut flux_nt = table.flux_nt.clone();
    if !fluxgate.named.is_empty() {
        // Once more with the direction that the corrected fluxgate gives.
        flux_nt = corrected(table, &fluxgate);
        fluxgate = searched(&flux_nt, &reading);
        flux_nt = corrected(table, &fluxgate);
    }
    let trajectory = reconstruction.trajectory(table, &flux_nt, &background_nt, first.coefficients);
    begins(Stage::Scalar);
    let scalar = search(Asked {
        library,
        channel: Channel::Scalar,
        signals: Signals::new(trajectory),
        reading: table.scalar_nt.clone(),
        blocks: &scalar_blocks,
        allowed: &allowed(Channel::Scalar),
        direction_noise_rad,
    });
    let scalar_findings = findings(&scalar);
    let fluxgate_findings = findings(&fluxgate);
    Found { table, library, scalar, fluxgate, scalar_findings, fluxgate_findings, repeats, grid }
}

/// A first fit of the 18 terms, without any effect.
struct Quick {
    coefficients: [f64; TERMS],
    /// Reading less interference, nT, holes bridged.
    field_nt: Vec<f64>,
    /// What the model says of each row, nT.
    model_nt: Vec<f64>,
    /// Interference, nT.
    interference_nt: Vec<f64>,
}

fn quick(library: &Library, signals: &Signals, table: &Table, blocks: &[Block]) -> Quick {
    let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
    let problem = RegressionProblem::new(library, Channel::Scalar, signals.clone(), table.scalar_nt.clone(), whitening);
    let fit = problem.fit(&[]);
    let field_nt = fill(&problem.residual_nt(&fit));
    let slow_nt = crate::diagnosis::reconstruct::smooth::slow(&field_nt, 60);
    let mut interference_nt = vec![0.0; table.len()];
    for (column, coefficient) in problem.nuisance_columns.iter().zip(&fit.coefficients) {
        interference_nt.iter_mut().zip(column).for_each(|(sum, x)| *sum += coefficient * x);
    }
    let model_nt = slow_nt.iter().zip(&interference_nt).map(|(slow, more)| slow + more).collect();
    Quick { coefficients: problem.eq4(&fit.coefficients), field_nt, model_nt, interference_nt }
}

/// Magnitude of the fluxgate vector, less the field that the scalar gives where the two share more than a slow background.
fn magnitude(table: &Table, first: &Quick, signals: &Signals, blocks: &[Block]) -> Vec<f64> {
    let alone: Vec<f64> = table.flux_nt.iter().map(|f| (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt()).collect();
    let field = |row: usize| table.scalar_nt[row] - first.interference_nt[row];
    let less: Vec<f64> = (0..table.len()).map(|row| alone[row] - field(row)).collect();
    let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
    let power = |column: &[f64]| {
        let projected = whitening.apply(column);
        dot(&projected, &projected)
    };
    debug_assert!(signals.len() == table.len());
    if power(&less) < COMMON_FIELD * power(&alone) { less } else { alone }
}

/// The fluxgate less what the named effects add to it.
fn corrected(table: &Table, analysis: &Analysis<'_>) -> Vec<[f64; 3]> {
    let mut flux_nt = table.flux_nt.clone();
    for term in &analysis.fit.terms {
        let effect = &analysis.problem.library[term.effect];
        let change =
            effect.change(&analysis.problem.signals, &term.parameters(analysis.problem.library), &mut no_draw());
        for (flux, change) in flux_nt.iter_mut().zip(&change.flux_nt) {
            flux.iter_mut().zip(change).for_each(|(component, change)| *component -= change);
        }
    }
    flux_nt
}

fn cut(table: &Table, usable: &[bool], signals: &Signals) -> Vec<Block> {
    debug_assert!(table.len() == usable.len());
    blocks(signals.epochs_s(), usable, LONGEST_STEP_S + 1e-6)
}

fn differences(values: &[f64]) -> Vec<f64> {
    (0..values.len()).map(|k| if k == 0 { 0.0 } else { values[k] - values[k - 1] }).collect()
}

fn fill(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    fill_holes(&mut values);
    values
}
