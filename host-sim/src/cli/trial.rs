//! What `trial` takes.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use host_sim::command;
use host_sim::error::HostError;
use host_sim::summary::to_json;
use towmag_trial::{Kind, RecorderKind, Setting, Shard, Trial, TrialOptions};

use super::say::{print, say, say_aside};

#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct TrialArgs {
    #[command(subcommand)]
    action: Option<TrialAction>,
    /// Folder for the results; made if absent.
    #[arg(long, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
    /// How many recordings.
    #[arg(long, value_name = "COUNT", default_value_t = 60)]
    recordings: usize,
    /// Length of each recording, minutes. By default each has its own: four of five 2 to 12, the others up to 60.
    #[arg(long, value_name = "MIN")]
    minutes: Option<f64>,
    /// Seed of everything drawn.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Where it is set: trial, which judges, or tuning, with other mechanisms outside the library and other jerks, for
    /// work on the diagnosis.
    #[arg(long, value_name = "SETTING", default_value_t = Setting::Trial, conflicts_with = "on")]
    setting: Setting,
    /// Hide only this kind of thing in every recording: none, single, pair, unequal_pair, triple, or foreign (a mechanism outside
    /// the library). By default each in its share.
    #[arg(long, value_name = "KIND", conflicts_with = "on")]
    only: Option<Kind>,
    /// Give the diagnosis a simulation of each recording's track, at another rate and by another clock: it then works as
    /// `diagnose --simulation`.
    #[arg(long, conflicts_with = "on")]
    simulated: bool,
    /// Take an effect out of the library; all single effects are then this one, tried once more with it back.
    #[arg(long, value_name = "NAME")]
    withhold: Option<String>,
    /// Hide effects that you have written, too, and give them to the diagnosis: every single effect is then one of these;
    /// docs/effect_files.md has the language. Repeatable.
    #[arg(long = "effect-file", value_name = "FILE.toml", conflicts_with = "on")]
    effect_files: Vec<PathBuf>,
    /// How the recorders round and write: fine, ordinary, or padded (more digits than steps). By default each
    /// recording has any of the three.
    #[arg(long, value_name = "KIND", conflicts_with = "on")]
    recorder: Option<RecorderKind>,
    /// Whether the recordings hold targets, passing iron in both sensors. By default two of three do.
    #[arg(long, value_name = "yes|no", value_parser = clap::builder::BoolishValueParser::new(), conflicts_with = "on")]
    targets: Option<bool>,
    /// Let the body heave with the sea, and turn, as it passes targets. By default it passes each on a straight line at one depth.
    #[arg(long, conflicts_with = "on")]
    rough_passes: bool,
    /// Put effects into this recording instead of making recordings: those that need no physics but what was recorded.
    #[arg(long, value_name = "REC.csv", conflicts_with = "minutes")]
    on: Option<PathBuf>,
    /// With --on: end at the first bad row of the recording instead of leaving it out.
    #[arg(long, requires = "on")]
    strict: bool,
    /// Try only part K of N, as one of N jobs; `trial merge` makes one of them, equal to the bit to the trial at once.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Keep the recordings, as recordings/000.csv and so on beside the answers.
    #[arg(long)]
    keep: bool,
    /// Print trial.json instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Subcommand)]
enum TrialAction {
    /// Put the parts of a trial together: all files are those of the trial that was run at once.
    ///
    /// Parts of different trials (options, seed, version) are refused, as are missing and doubled ones.
    Merge {
        /// What `trial --shard` has written, in any order.
        #[arg(value_name = "DIR", required = true)]
        parts: Vec<PathBuf>,
        /// Folder for the results; made if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Print trial.json instead of a table.
        #[arg(long)]
        json: bool,
    },
}

impl TrialArgs {
    /// Do the work and say how it went.
    pub(super) fn run(self) -> Result<(), HostError> {
        if let Some(TrialAction::Merge { parts, out, json }) = &self.action {
            show(&command::merge_trial(parts, out)?, *json);
            return Ok(());
        }
        let out = self.out.clone().unwrap_or_default();
        let trial = command::trial(&out, &self.options()?, |sha256| {
            say_aside(format_args!("answers.json sealed, SHA-256 {sha256}"));
        })?;
        show(&trial, self.json);
        Ok(())
    }

    fn options(&self) -> Result<TrialOptions, HostError> {
        Ok(TrialOptions {
            recordings: self.recordings,
            seed: self.seed,
            minutes: self.minutes,
            setting: self.setting,
            only: self.only,
            simulated: self.simulated,
            withhold: self.withhold.clone(),
            own: command::own_effects(&self.effect_files)?,
            recorder: self.recorder,
            targets: self.targets,
            rough_passes: self.rough_passes,
            on: self.on.clone(),
            strict: self.strict,
            shard: self.shard,
            keep: self.keep,
        })
    }
}

fn show(trial: &Trial, as_json: bool) {
    match (&trial.score, &trial.on) {
        (Some(score), _) if !as_json => say(host_sim::text::trial::text(score).trim_end_matches('\n')),
        (_, Some(on)) if !as_json => say(host_sim::text::trial::text_on(on).trim_end_matches('\n')),
        _ => print(to_json(trial)),
    }
}
