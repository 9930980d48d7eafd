//! `host-sim` at the terminal.

mod arguments;
mod card;
mod documents;
mod import;
mod listen;
mod options;
mod say;
mod show;
mod survey;
mod trial;
#[cfg(unix)]
mod watch;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use host_sim::command::{self, CompareOptions, CompareResult};
use host_sim::detection::InjectionSettings;
use host_sim::error::HostError;
use host_sim::output::{clean_up_on_signals, wait_if_ending};
use host_sim::summary::to_json;
use host_sim::wire::Wires;
use towmag::Method;
use towmag_export::Options;

use arguments::{Cli, Command};
use say::{be_quiet, print, say, say_aside, warn};
use show::{point_to_report, show, show_detection, show_table};
#[cfg(unix)]
use watch::Watching;

/// Parse the arguments, do the work, say how it went.
pub(crate) fn run() -> ExitCode {
    let Cli { quiet, command } = Cli::parse();
    if quiet {
        be_quiet();
    }
    // These two end by a signal as a matter of course, and leave nothing unfinished.
    if !matches!(command, Command::Listen(_) | Command::Card(_)) && clean_up_on_signals().is_err() {
        eprintln!("Ctrl-C will leave unfinished files behind: the system does not tell of signals.");
    }
    match execute(command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            wait_if_ending();
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn execute(command: Command) -> Result<(), HostError> {
    match command {
        Command::Calibrate { recording, reading, result, settings } => {
            let calibrated =
                command::calibrate(reading.input(recording), &result.out, &settings.settings(Method::Fixed))?;
            let heading = format!("Condition number {:.0}", calibrated.file.calibration.condition_number);
            show(&result, &calibrated.summary, std::slice::from_ref(&calibrated.summary), None, &heading);
        }
        Command::Replay { recording, coefficients, method, reading, result, settings } => {
            let settings = settings.settings(method.into());
            let summary = command::replay(reading.input(recording), coefficients.as_deref(), &result.out, &settings)?;
            show(&result, &summary, std::slice::from_ref(&summary), None, "");
        }
        Command::Compare {
            calibration,
            recording,
            further,
            anomalies,
            line,
            skip_s,
            seed,
            reading,
            result,
            settings,
        } => {
            let settings = settings.settings(Method::None);
            let injection = InjectionSettings { anomalies: anomalies.unwrap_or(0), seed, line, skip_s };
            let options = CompareOptions { further: pairs(further)?, is_strict: reading.strict, injection };
            let compared: CompareResult = command::compare(
                reading.input(calibration),
                reading.input(recording),
                &result.out,
                &settings,
                &options,
            )?;
            let heading = format!(
                "Calibration: improvement ratio {:.3}, condition number {:.0}",
                compared.calibration_improvement_ratio, compared.condition_number
            );
            warn(&compared.calibration_bad_rows.sentences());
            show(&result, &compared, &compared.methods, compared.targets.as_ref(), &heading);
            if !result.json {
                compared.detection.iter().for_each(show_detection);
            }
        }
        Command::Table { calibration, tows, result, settings } => {
            let table = command::table(&calibration, &tows, &result.out, &settings.settings(Method::None))?;
            if result.json { print(to_json(&table)) } else { show_table(&table) }
        }
        #[cfg(unix)]
        Command::Emulate {
            recording,
            coefficients,
            method,
            image,
            scalar,
            conversions: conversions_per_epoch,
            faults,
            typed,
            watching,
            reading,
            result,
            settings,
        } => {
            let settings = settings.settings(method.into());
            let emulation =
                host_sim::emulator::EmulationSettings { image, scalar, conversions_per_epoch, faults, typed };
            let (onlooker, watching) = watching.begin(&recording)?;
            let emulated = command::emulate_watched(
                reading.input(recording),
                coefficients.as_deref(),
                &result.out,
                &settings,
                &emulation,
                onlooker,
            )?;
            show(&result, &emulated.summary, std::slice::from_ref(&emulated.summary), None, &emulated.heading());
            watching.map_or(Ok(()), Watching::end)?;
        }
        Command::Import(import) => {
            let imported = command::import(&import.files, &import.out, &import.options()?)?;
            let is_stream = import.out == std::path::Path::new("-");
            match (import.json, is_stream) {
                (true, false) => print(imported.to_json()),
                (true, true) => eprint!("{}", imported.to_json()),
                (false, false) => imported.report.lines().iter().for_each(say),
                (false, true) => imported.report.lines().iter().for_each(say_aside),
            }
        }
        Command::Recover { image, result } => {
            let recovered = command::recover(&image, &result.out)?;
            if result.json {
                print(to_json(&recovered));
            } else {
                say(format_args!(
                    "{} epochs of {} sessions in {} intact sectors; {} sectors missing, {} blocks damaged, {} unreadable; \
                     the body reported {} epochs lost.",
                    recovered.epochs,
                    recovered.sessions,
                    recovered.sectors,
                    recovered.missing_sectors,
                    recovered.damaged_blocks,
                    recovered.unreadable_blocks,
                    recovered.epochs_reported_lost
                ));
            }
        }
        Command::Diagnose { plan: Some(scenario), effect_files, seed, result, .. } => {
            let plan = command::plan(&scenario, &result.out, seed, command::library_with(&effect_files)?)?;
            match result.json {
                true => print(host_sim::text::plan::json(&plan)),
                false => say(host_sim::text::plan::text(&plan).trim_end_matches('\n')),
            }
        }
        Command::Diagnose {
            recording,
            coefficients,
            confirm,
            simulation,
            hold_terms,
            withheld,
            effect_files,
            regressors,
            seed,
            reading,
            result,
            ..
        } => {
            let recording = recording.unwrap_or_default();
            let options = command::DiagnoseOptions {
                coefficients: coefficients.as_deref(),
                confirm: confirm.as_deref(),
                withheld,
                simulation: simulation.as_deref(),
                holds_terms: hold_terms,
                effect_files,
                regressors,
                seed,
            };
            let diagnosis = command::diagnose(reading.input(recording), &result.out, &options)?;
            warn(&diagnosis.bad_rows.sentences());
            if result.json {
                print(host_sim::text::diagnosis_json::json(&diagnosis));
            } else {
                say(host_sim::text::diagnosis_terminal::text(&diagnosis).trim_end_matches('\n'));
                point_to_report(&result);
            }
        }
        Command::Survey(survey) => survey.run()?,
        Command::Trial(trial) => trial.run()?,
        Command::Sample { out } => command::sample(&out)?,
        Command::Simulate { scenario, out, seed, effects, effect_files, through_sensors, faults } => {
            let requests = command::requests(&command::library_with(&effect_files)?, &effects)?;
            let wires = through_sensors.map(|scalar| Wires { scalar, faults });
            let made = command::simulate(&scenario, &out, seed, &requests, wires.as_ref())?;
            // Standard output may be where the recording goes.
            let tell: fn(String) = if out.as_os_str() == "-" { say_aside } else { say };
            tell(format!("{} rows, seed {}, {:.3} nT in the band.", made.rows, made.seed, made.std_before_nt));
            made.effects.iter().for_each(|(name, rms_nt)| tell(format!("{name}: {rms_nt:.4} nT rms")));
            made.through.iter().for_each(|through| tell(format!("{through}.")));
        }
        Command::Export { input, format, out, every: every_s, points } => {
            let exported = command::export(&input, format, &out, &Options { every_s, points })?;
            if !exported.is_on_stdout {
                let command::ExportResult { source, rows, columns, .. } = exported;
                let (source, out) = (source.display(), out.display());
                say(format_args!("{source}: {rows} rows and {columns} columns to {out} as {format}."));
            }
        }
        Command::Completions { shell } => documents::completions(shell)?,
        Command::Man { out } => documents::manual(&out)?,
        Command::Card(action) => action.run()?,
        Command::Listen(listen) => listen.run()?,
    }
    Ok(())
}

/// Further arguments of `compare`, two by two.
fn pairs(further: Vec<PathBuf>) -> Result<Vec<[PathBuf; 2]>, HostError> {
    let pairs = further.chunks(2).map(|pair| pair.to_vec().try_into()).collect::<Result<_, _>>();
    pairs.map_err(|_| HostError::Usage("each further CAL.csv needs its REC.csv".into()))
}
