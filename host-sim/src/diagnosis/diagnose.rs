//! From a recording to its diagnosis, as a chain of values, each made once from those before it:
//!
//! ```text
//! Prepared -> Rounding, Reconstruction -> Targets
//!       -> BaseFit -> Selection of the fluxgate -> corrected fluxgate -> Selection of the scalar -> Findings
//!       -> more Targets, recorded columns: if any, Findings beside them
//!       -> where a rest is left, Findings further from the targets -> Diagnosis
//! ```

#[cfg(test)]
mod bootstrap;
#[cfg(test)]
pub(super) mod simulated;

use std::iter::successors;
use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use towmag::model::TERMS;

use super::base::{BaseFit, blocks_of, fresh_rows};
use super::change::NamedChange;
use super::channel_search::Search;
use super::confirm::confirm;
use super::consequence;
use super::findings::{ChannelFindings, Findings};
use super::noise::blocks::Block;
use super::own_simulation::OwnSimulation;
use super::own_simulation::beyond::SimulationUsed;
use super::plan::{self, Plan};
use super::policy::{LEAST_SAMPLES, TARGET_PERIODS, TARGETS_OF_REST_MOST};
use super::reconstruct::prepared::Prepared;
use super::recording::Recording;
use super::regression::problem::{Fit, RegressionProblem};
use super::regression::term::Term;
use super::result::{Diagnosis, Verdict};
use super::search::recorded::{RecordedColumn, recorded_column};
use super::selection::Selection;
use super::targets::judged::Trust;
use super::targets::search::TargetSearch;
use super::targets::{Rest, Targets};
use super::unexplained::{describe, outdone};
use super::verdict;
use crate::effects::{Effect, HeldOut, Library, RecordedForm};
use crate::error::HostError;

/// What a diagnosis may be told.
#[derive(Clone, Debug, Default)]
pub struct DiagnoseSettings {
    /// Effects that are taken out of the library.
    pub withheld: Vec<String>,
    /// Seed of everything drawn.
    pub seed: u64,
    /// Coefficients of a calibration, to start from, in the units of eq. (4).
    pub coefficients: Option<[f64; TERMS]>,
    /// The effects that are looked for.
    pub library: Library,
    /// A simulation of the user's own in the place of the base simulator.
    pub simulation: Option<OwnSimulation>,
    /// Whether an effect that was expressly asked for is left out where the recording lacks what it needs, and not refused.
    pub is_lenient: bool,
}

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
    /// What is left without a name.
    Rest,
    /// A second recording.
    Second,
}

/// Diagnose a recording; with a second one, try the findings on it.
///
/// # Errors
///
/// When a recording has too few rows in stretches without long gaps.
pub fn diagnose(
    table: &Prepared,
    second: Option<&Prepared>,
    settings: &DiagnoseSettings,
) -> Result<Diagnosis, HostError> {
    diagnose_telling(table, second, settings, &|_| {})
}

/// The same; `begins` is told of every stage.
pub(crate) fn diagnose_telling(
    recorded: &Prepared,
    second: Option<&Prepared>,
    settings: &DiagnoseSettings,
    begins: &dyn Fn(Stage),
) -> Result<Diagnosis, HostError> {
    [Some(recorded), second].into_iter().flatten().try_for_each(check_length)?;
    begins(Stage::Terms);
    let laid = settings.simulation.as_ref().map(|own| held_against(recorded, own, settings)).transpose()?;
    let (table, simulation) = laid.map_or((None, None), |(table, used)| (Some(table), Some(used)));
    let table = table.as_ref().unwrap_or(recorded);
    let held = table.beyond.held;
    let recording = Recording::of(table, held.or(settings.coefficients).unwrap_or([0.0; TERMS]));
    check_asked(settings, &recording)?;
    let library = settings.library.applicable_to(&recording.start);
    let found = recording.findings(&library, settings, begins);
    begins(Stage::Verdict);
    let (found, diagnosis) = judged(found, settings.seed);
    let has_gap = diagnosis.channels.iter().any(|gap| gap.channel == "scalar" && gap.verdict != Verdict::NoGap);
    let consequence = has_gap.then(|| consequence::of(&found)).flatten();
    let diagnosis = Diagnosis { simulation, consequence, ..diagnosis };
    let Some(second) = second else {
        begins(Stage::Rest);
        let description = describe(&found, &diagnosis, None, settings.seed);
        return Ok(Diagnosis { description, ..diagnosis });
    };
    begins(Stage::Second);
    // With the effects of the first recording, so that their indices mean the same.
    let other = Recording::of(second, [0.0; TERMS]);
    check_asked(settings, &other)?;
    let there = other.findings(&library, &nothing_named(&library, settings), &|_| {});
    begins(Stage::Rest);
    let description = describe(&found, &diagnosis, Some(&there), settings.seed);
    Ok(Diagnosis { description, ..confirm(diagnosis, &found, &there) })
}

/// Findings and what they come to; without the names that are more likely pieces of what is left.
fn judged(found: Findings<'_>, seed: u64) -> (Findings<'_>, Diagnosis) {
    let verdict = |found: &Findings<'_>| verdict::of(found, &mut ChaCha8Rng::seed_from_u64(seed));
    let diagnosis = verdict(&found);
    let outdone = outdone(&found, &diagnosis);
    if outdone.is_empty() {
        return (found, diagnosis);
    }
    let found = found.with_outdone(&outdone);
    let diagnosis = verdict(&found);
    (found, diagnosis)
}

/// A recording with what a simulation of the user's own says of it, and how that was laid on it.
fn held_against(
    table: &Prepared,
    own: &OwnSimulation,
    settings: &DiagnoseSettings,
) -> Result<(Prepared, SimulationUsed), HostError> {
    let (alignment, recorded, simulated) = own.laid_on(table)?;
    [&recorded, &simulated].into_iter().try_for_each(check_length)?;
    let recording = Recording::of(&simulated, [0.0; TERMS]);
    let library = settings.library.applicable_to(&recording.start);
    let (beyond, used) =
        own.beyond(alignment, &recording.findings(&library, &nothing_named(&library, settings), &|_| {}));
    Ok((Prepared { beyond, ..recorded }, used))
}

/// Before the tow: what a recording like a simulated one, in which nothing is but noise, would tell of each effect.
///
/// # Errors
///
/// When the recording has too few rows in stretches without long gaps.
pub fn plan(table: &Prepared, settings: &DiagnoseSettings) -> Result<Plan, HostError> {
    check_length(table)?;
    let recording = Recording::of(table, [0.0; TERMS]);
    let library = settings.library.applicable_to(&recording.start);
    Ok(plan::of(&recording.findings(&library, &nothing_named(&library, settings), &|_| {})))
}

/// What the effects that a diagnosis names do to the scalar's readings, of those that are at work with this probability at least. Those
/// that are more likely pieces of what is left are among them: they take most of it off all the same.
///
/// # Errors
///
/// When the recording has too few rows in stretches without long gaps.
pub fn named_change(
    table: &Prepared,
    settings: &DiagnoseSettings,
    least_probability: f64,
) -> Result<NamedChange, HostError> {
    check_length(table)?;
    let recording = Recording::of(table, settings.coefficients.unwrap_or([0.0; TERMS]));
    let library = settings.library.applicable_to(&recording.start);
    let found = recording.findings(&library, settings, &|_| {});
    let (named, rest) = verdict::named_effects(&found, &mut ChaCha8Rng::seed_from_u64(settings.seed));
    Ok(NamedChange::of(&found, &named, least_probability).beside(rest.as_ref()))
}

/// No effect is named: all of the library are withheld.
fn nothing_named(library: &Library, settings: &DiagnoseSettings) -> DiagnoseSettings {
    DiagnoseSettings { withheld: library.specs().map(|spec| spec.name.to_string()).collect(), ..settings.clone() }
}

/// Refuse a recording on which an effect has no meaning that was expressly asked for.
fn check_asked(settings: &DiagnoseSettings, recording: &Recording<'_>) -> Result<(), HostError> {
    if settings.is_lenient {
        return Ok(());
    }
    let refusal = |effect: &Arc<dyn Effect>| effect.refusal(&recording.start, &recording.table.usable, None);
    let refused = settings.library.iter().find_map(refusal);
    refused.map_or(Ok(()), |reason| Err(HostError::Usage(format!("{}: {reason}", recording.table.file))))
}

fn check_length(table: &Prepared) -> Result<(), HostError> {
    let samples: usize = blocks_of(&table.epochs_s(), &table.usable).iter().map(Block::len).sum();
    if samples >= LEAST_SAMPLES {
        return Ok(());
    }
    Err(HostError::NotEnough(format!(
        "{}: no stretch of valid rows is long enough for a diagnosis: at least {:.0} s in pieces of 8 s or more",
        table.file,
        LEAST_SAMPLES as f64 / 10.0
    )))
}

impl<'a> Recording<'a> {
    /// Blocks of the usable rows, beside the targets.
    fn blocks(&self, usable: &[bool], targets: &Targets) -> Vec<Block> {
        let epochs_s = self.start.epochs_s();
        targets.blocks(epochs_s, &targets.without_cores(epochs_s, usable))
    }

    /// Everything that is found in both channels, of the effects that are not withheld, and the targets.
    fn findings(&self, library: &'a Library, settings: &DiagnoseSettings, begins: &dyn Fn(Stage)) -> Findings<'a> {
        let search = TargetSearch { table: self.table, signals: &self.start };
        let targets = search.at_start(|targets| self.terms_alone(library, targets));
        let found = self.findings_beside(Known { targets, columns: Vec::new() }, library, settings, begins);
        let columns = self.recorded_columns(&found, settings);
        let targets = more_targets(&search, &found);
        let is_all = targets == found.targets && columns.is_empty();
        let found =
            if is_all { found } else { self.findings_beside(Known { targets, columns }, library, settings, begins) };
        let found = found.tested(&self.direction_noise);
        self.without_rest_of_targets(&search, &found, library, settings, begins).unwrap_or(found).with_beside_rest()
    }

    /// The same with the targets that the rest shows, or else without rows further from all of them, where that leaves no rest: it was
    /// targets, or what their dipoles have wrong. None where nothing is left unexplained, or so much is without targets too.
    fn without_rest_of_targets(
        &self,
        search: &TargetSearch<'_>,
        found: &Findings<'a>,
        library: &'a Library,
        settings: &DiagnoseSettings,
        begins: &dyn Fn(Stage),
    ) -> Option<Findings<'a>> {
        if !found.has_rest() {
            return None;
        }
        let further = |targets: &Targets| targets.with_further_left_out(self.start.epochs_s(), &self.table.usable);
        let beside = |targets: Targets| {
            let known = Known { targets, columns: found.columns.clone() };
            self.findings_beside(known, library, settings, begins).tested(&self.direction_noise)
        };
        let duration_s = found.scalar.selection.problem.duration_s();
        let is_small = |share: f64| 0.0 < share && share <= TARGETS_OF_REST_MOST;
        let more = Some(more_targets(search, found));
        let more = more.filter(|more| is_small(more.share_beyond(&found.targets, duration_s)));
        let known = more.into_iter().chain(successors(further(&found.targets), further));
        known.map(beside).find(|found| !found.has_rest())
    }

    /// Recorded columns that carry a gap, but were not found in the whitened residual; the one that explains most first.
    fn recorded_columns(&self, found: &Findings<'_>, settings: &DiagnoseSettings) -> Vec<RecordedColumn> {
        let Selection { problem, accepted, noise, .. } = &found.scalar.selection;
        let noise_nt = noise.std_nt().unwrap_or(0.0);
        let is_open = |&effect: &usize| {
            let tried = &found.library[effect];
            let Some(recorded) = tried.recorded().filter(|recorded| recorded.form == RecordedForm::Moment) else {
                return false;
            };
            let column = |effect: usize| found.library[effect].recorded().map(|recorded| recorded.column);
            !settings.withheld.iter().any(|name| name == tried.spec().name)
                && accepted.iter().all(|other| column(other.candidate.term.effect).as_ref() != Some(&recorded.column))
        };
        let mut open: Vec<usize> = (0..found.library.len()).filter(is_open).collect();
        let (mut columns, mut known_nt): (Vec<RecordedColumn>, _) = (Vec::new(), vec![0.0; problem.signals.len()]);
        while let Some(column) = recorded_column(problem, &open, &known_nt, noise_nt) {
            let name = |effect: usize| found.library[effect].recorded().map(|recorded| recorded.column);
            let taken = name(column.term.effect);
            open.retain(|&effect| name(effect) != taken);
            known_nt.iter_mut().zip(&column.column_nt).for_each(|(sum, nt)| *sum += nt);
            columns.push(column);
        }
        columns
    }

    /// What the 18 terms alone leave of the scalar beside some targets.
    fn terms_alone(&self, library: &Library, targets: &Targets) -> Rest {
        let epochs_s = self.start.epochs_s();
        let usable = targets.without_cores(epochs_s, &self.table.usable);
        let direction = (&self.start, &self.direction_noise);
        Rest::of_terms(self.table, direction, library, &usable, |usable| targets.blocks(epochs_s, usable))
    }

    /// Everything but the targets, which are known; no test has been made of what is left.
    fn findings_beside(
        &self,
        known: Known,
        library: &'a Library,
        settings: &DiagnoseSettings,
        begins: &dyn Fn(Stage),
    ) -> Findings<'a> {
        let Known { targets, columns } = known;
        let epochs_s = self.start.epochs_s();
        let blocks = self.blocks(&self.table.usable, &targets);
        let base = BaseFit::of(library, &self.start, self.table, &blocks, &targets.anomaly_nt(epochs_s));
        let asked = Search { recording: self, library, base: &base, withheld: &settings.withheld, columns: &columns };
        begins(Stage::Fluxgate);
        let (fluxgate, flux_nt) = asked.fluxgate(&blocks);
        begins(Stage::Scalar);
        let exact = asked.exact(&fluxgate, &targets.with_known_changes(epochs_s, &self.table.usable));
        let fresh = fresh_rows(self.table, exact.repeats.as_ref().map(|(_, repeats)| repeats));
        let scalar = asked.scalar(&flux_nt, &self.blocks(&fresh, &targets));
        Findings {
            table: self.table,
            library,
            specs: settings.library.specs().collect(),
            scalar: ChannelFindings::untested(scalar),
            fluxgate: ChannelFindings::untested(fluxgate),
            exact,
            columns,
            targets,
            rounding: self.rounding.clone(),
        }
    }
}

/// The targets with those that are too weak beside an effect until it is known. What happens once or a few times may be targets itself:
/// it is none where it explains more than they would without it.
fn more_targets(search: &TargetSearch<'_>, found: &Findings<'_>) -> Targets {
    let Selection { problem, fit, .. } = &found.scalar.selection;
    let random_nt2 = found.scalar.selection.random_nt2();
    let beside = |fit: &Fit| search.beside(&found.targets, &Rest::of(problem, fit, &random_nt2), Trust::Unseen);
    if let Some(lasting) = lasting(problem, fit) {
        let targets = beside(&lasting);
        if targets.glrt_beyond(&found.targets) > lasting.sse() - fit.sse() {
            return targets;
        }
    }
    beside(fit)
}

/// A fit without what happens once or a few times, which may be a target as well; none where there is no such thing.
fn lasting(problem: &RegressionProblem<'_>, fit: &Fit) -> Option<Fit> {
    let lasts = |term: &&Term| {
        let effect = &problem.library[term.effect];
        match effect.spec().held_out {
            HeldOut::NotAsked => true,
            HeldOut::MustNotHarm => false,
            HeldOut::MustExplain => {
                effect.fundamental_hz(&term.at).is_none_or(|hz| hz * problem.duration_s() >= TARGET_PERIODS)
            }
        }
    };
    let terms: Vec<Term> = fit.terms.iter().filter(lasts).cloned().collect();
    (terms.len() < fit.terms.len()).then(|| problem.fit(&terms))
}

/// What is known before the search of the effects.
struct Known {
    targets: Targets,
    columns: Vec<RecordedColumn>,
}
