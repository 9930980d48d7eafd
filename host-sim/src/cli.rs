//! Arguments of `host-sim`, and what it prints.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use host_sim::command::{self, CompareOptions, CompareResult, Table, Tow};
use host_sim::detection::{Combination, Detection, TrialSettings};
use host_sim::error::HostError;
use host_sim::listen::{ListenOptions, Screen, listen};
use host_sim::simulator::library::{Request, RequestError};
use host_sim::summary::{Summary, to_json};
use host_sim::trial::TrialOptions;
use host_sim::wire::{Fault, Wires};
use towmag::compensation::{BandPassDesign, ElasticNet};
use towmag::{Method, Settings};

/// Magnetic compensation of a towed body's recordings, with the very core that the body runs.
///
/// A recording is a CSV file with the columns time_s, scalar_nT, flux_x_nT, flux_y_nT, flux_z_nT at 10 Hz; more columns
/// are carried through. Exit codes: 0 done, 1 the work failed, 2 bad usage or bad input.
#[derive(Parser)]
#[command(version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Fit the 18 coefficients to a calibration recording: batch elastic net, eq. (7).
    ///
    /// Needs 60 s of valid rows, better 6 minutes: roll, pitch and yaw on four headings.
    /// Writes coefficients.toml, summary.json and report.html.
    Calibrate {
        /// The calibration recording.
        #[arg(value_name = "CAL.csv")]
        recording: PathBuf,
        #[command(flatten)]
        result: ResultArgs,
        #[command(flatten)]
        settings: SettingsArgs,
    },
    /// Compensate a recording, row by row, each with coefficients that have not yet seen it.
    ///
    /// Writes compensated.csv (the recording with interference_nT, compensated_nT, residual_nT,
    /// residual_after_update_nT, valid, and from the adaptive method predicted_std_nT, adapted_share, adaptation),
    /// summary.json and report.html.
    Replay {
        /// The recording.
        #[arg(value_name = "REC.csv")]
        recording: PathBuf,
        /// What `calibrate` wrote. Without it, an adaptive method starts from zero.
        #[arg(long, value_name = "FILE")]
        coefficients: Option<PathBuf>,
        /// How the coefficients follow the data.
        #[arg(long, value_enum, default_value_t = MethodArg::Adaptive)]
        method: MethodArg,
        #[command(flatten)]
        result: ResultArgs,
        #[command(flatten)]
        settings: SettingsArgs,
    },
    /// Calibrate on one recording, run every method on another, and show the table of the paper.
    ///
    /// Writes coefficients.toml, summary.json (one summary a method) and report.html.
    Compare {
        /// The calibration recording.
        #[arg(value_name = "CAL.csv")]
        calibration: PathBuf,
        /// The recording to compensate.
        #[arg(value_name = "REC.csv")]
        recording: PathBuf,
        /// Further pairs of both, for the table of anomalies.
        #[arg(value_name = "CAL.csv REC.csv", requires = "anomalies")]
        further: Vec<PathBuf>,
        /// Inject dipole anomalies (5 to 15 nT, 1 to 2.5 s wide at half height) and show what each method keeps of them;
        /// mean of four sets.
        #[arg(long, value_name = "COUNT")]
        anomalies: Option<usize>,
        /// Only rows whose column line is this count in the table of anomalies.
        #[arg(long, value_name = "NAME", requires = "anomalies")]
        line: Option<String>,
        /// Time after the first row that counts which does not count itself, s.
        #[arg(long, value_name = "S", default_value_t = 0.0, requires = "anomalies")]
        skip_s: f64,
        /// Seed of the anomalies.
        #[arg(long, value_name = "SEED", default_value_t = 0, requires = "anomalies")]
        seed: u64,
        #[command(flatten)]
        result: ResultArgs,
        #[command(flatten)]
        settings: SettingsArgs,
    },
    /// The paper's Table 1 on simulated recordings: calibrate on one scenario, run every method on the others.
    ///
    /// The bodies of the scenarios are not the same, unless their files say so: the calibration no longer holds, as in the
    /// paper. Writes table.json.
    Table {
        /// Scenario of the calibration, as `simulate` takes it.
        #[arg(value_name = "CAL.toml")]
        calibration: PathBuf,
        /// Scenarios of the tows.
        #[arg(value_name = "TOW.toml", required = true)]
        tows: Vec<PathBuf>,
        #[command(flatten)]
        result: ResultArgs,
        #[command(flatten)]
        settings: SettingsArgs,
    },
    /// Run the firmware image on an emulated STM32F405, fed with a recording over its UART and its fluxgate bus.
    ///
    /// Holds what it sends and logs against a replay of the same bytes: equal bit for bit, or the first differing epoch
    /// is named. Needs qemu-system-arm and the image that `cargo fw-emu` builds. Writes what `replay` writes, and
    /// log.bin (the sectors of the log), telemetry.bin and figures.json (costs and counters of the body).
    #[cfg(unix)]
    Emulate {
        /// The recording.
        #[arg(value_name = "REC.csv")]
        recording: PathBuf,
        /// What `calibrate` wrote. Without it, an adaptive method starts from zero.
        #[arg(long, value_name = "FILE")]
        coefficients: Option<PathBuf>,
        /// How the coefficients follow the data.
        #[arg(long, value_enum, default_value_t = MethodArg::Adaptive)]
        method: MethodArg,
        /// The firmware image.
        #[arg(long, value_name = "FILE", default_value = host_sim::emulator::DEFAULT_IMAGE)]
        image: PathBuf,
        /// What the scalar sensor sends.
        #[arg(long, value_enum, default_value_t = ScalarArg::QtfmGen1)]
        scalar: ScalarArg,
        /// Fluxgate conversions to an epoch, odd, 1 to 25. The board has 25; few are faster.
        #[arg(long, value_name = "COUNT", default_value_t = 1)]
        conversions: u8,
        /// What befalls the body: drop, damage, late, stuck, noise (scalar sensor), crc, unplug (converter), reset, power or
        /// panic, then @ROW or @ROW+COUNT. Repeatable.
        #[arg(long = "fault", value_name = "KIND@ROW")]
        faults: Vec<Fault>,
        /// A line for the body's console, and the row at which it is typed. Repeatable.
        #[arg(long = "type", value_name = "ROW:LINE")]
        typed: Vec<host_sim::emulator::Typed>,
        #[command(flatten)]
        result: ResultArgs,
        #[command(flatten)]
        settings: SettingsArgs,
    },
    /// Get every record out of a card, even a damaged or unclosed one.
    ///
    /// Looks at every block of the card, of an image of it or of its TOWMAGnn.BIN, and trusts no file system. Writes
    /// recording.csv, which the other commands read, events.txt and summary.json.
    Recover {
        /// Card, card image or log file.
        #[arg(value_name = "CARD_IMAGE")]
        image: PathBuf,
        #[command(flatten)]
        result: ResultArgs,
    },
    /// Find the gap between a recording and the simulator: where it lies, which effect causes it, how far it shrinks.
    ///
    /// Needs 60 s of valid rows, better 10 minutes with manoeuvres. Writes diagnosis.json, gap.csv (the residual of
    /// both sensors before and after the effects that were found) and report.html.
    Diagnose {
        /// The recording.
        #[arg(value_name = "REC.csv")]
        recording: PathBuf,
        /// What `calibrate` wrote, to start from; the 18 coefficients are refitted in any case.
        #[arg(long, value_name = "FILE")]
        coefficients: Option<PathBuf>,
        /// A second recording: the effects that were found are tried on it, their parameters frozen.
        #[arg(long, value_name = "REC2.csv")]
        confirm: Option<PathBuf>,
        /// Take an effect out of the library. Repeatable.
        #[arg(long = "withhold", value_name = "NAME")]
        withheld: Vec<String>,
        /// Seed of everything drawn.
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        seed: u64,
        #[command(flatten)]
        result: ResultArgs,
    },
    /// Try the diagnosis blind: on recordings with hidden effects, whose answers are sealed before it begins.
    ///
    /// Three in ten hide nothing, the others one effect, two, or a mechanism that is not in the library, 1, 3 or 10 times
    /// as strong as the noise; docs/trial.md says how they are made. Writes answers.json, report.html and trial.json, the
    /// latter first without the score and with the SHA-256 of the answers, which is also printed.
    Trial {
        /// Folder for the results; made if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// How many recordings.
        #[arg(long, value_name = "COUNT", default_value_t = 60)]
        recordings: usize,
        /// Length of a recording, minutes.
        #[arg(long, value_name = "MIN", default_value_t = 10.0)]
        minutes: f64,
        /// Seed of everything drawn.
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        seed: u64,
        /// Take an effect out of the library; all single effects are then this one, tried once more with it back.
        #[arg(long, value_name = "NAME")]
        withhold: Option<String>,
        /// Put effects into this recording instead of making recordings: those that need no physics but what was recorded.
        #[arg(long, value_name = "REC.csv", conflicts_with = "minutes")]
        on: Option<PathBuf>,
        /// Keep the recordings, as recordings/000.csv and so on beside the answers.
        #[arg(long)]
        keep: bool,
        /// Print trial.json instead of a table.
        #[arg(long)]
        json: bool,
    },
    /// Make the two sample recordings, calibration.csv and survey.csv; the same bytes every time.
    Sample {
        /// Folder for them; made if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Make a recording from a scenario: motion, field, interference, noise, and unmodelled effects if asked for.
    ///
    /// docs/scenarios.md explains the scenario file and lists the effects. The same scenario, seed and effects give the
    /// same bytes.
    Simulate {
        /// The scenario.
        #[arg(value_name = "SCENARIO.toml")]
        scenario: PathBuf,
        /// The recording; replaced if it is there.
        #[arg(long, value_name = "REC.csv")]
        out: PathBuf,
        /// Seed of everything random, in place of the scenario's.
        #[arg(long, value_name = "NUMBER")]
        seed: Option<u64>,
        /// An unmodelled effect, as in scalar_lag:lag_s=0.05. Repeatable.
        #[arg(long = "effect", value_name = "NAME:PARAM=VALUE,...")]
        effects: Vec<String>,
        /// Send the readings over the sensors' wires, as this scalar sensor's sentences and the converter's SPI frames, to
        /// the drivers, the 10 Hz grid and the core of the firmware: the recording is then what the body has of it.
        #[arg(
            long,
            value_enum,
            value_name = "SCALAR",
            num_args = 0..=1,
            require_equals = true,
            default_missing_value = "g882"
        )]
        through_sensors: Option<ScalarArg>,
        /// What befalls the wires: drop, damage, late, stuck, noise (scalar sensor), crc or unplug (converter), then @ROW or
        /// @ROW+COUNT. Repeatable.
        #[arg(long = "fault", value_name = "KIND@ROW", requires = "through_sensors")]
        faults: Vec<Fault>,
    },
    /// Show the body's telemetry live, record it, and pass typed commands to the body.
    ///
    /// What is typed goes to the body line by line; type help for its commands. Ctrl-C ends; all that was heard
    /// is in the files by then. A recording made with --record can be listened to again.
    Listen {
        /// A serial port such as /dev/ttyUSB0, an address such as localhost:4000, or a recording.
        #[arg(value_name = "PORT")]
        port: String,
        /// Baud rate of the serial port.
        #[arg(long, value_name = "BAUD", default_value_t = 38_400)]
        baud: u32,
        /// New file for every byte as it comes.
        #[arg(long, value_name = "FILE")]
        record: Option<PathBuf>,
        /// New file for the telemetry as a table, one row per epoch.
        #[arg(long, value_name = "FILE.csv")]
        csv: Option<PathBuf>,
    },
}

#[derive(Args)]
struct ResultArgs {
    /// Folder for the results; made if absent. Results that are there are replaced, but only once all new ones are whole.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Print summary.json instead of a table.
    #[arg(long)]
    json: bool,
}

/// Defaults are the published ones: Yan, Zhao, Liu, Wu 2025, doi:10.19306/j.cnki.2095-8110.2025.02.005, section 3.1.
#[derive(Args)]
#[command(
    next_help_heading = "Settings of the estimators (defaults as published, doi:10.19306/j.cnki.2095-8110.2025.02.005)"
)]
struct SettingsArgs {
    /// Weight of the coefficients' magnitudes, eq. (7); coefficients in nT, nT/nT and s.
    #[arg(long, value_name = "WEIGHT", default_value_t = ElasticNet::default().lambda1)]
    lambda1: f64,
    /// Weight of half the coefficients' squares, eq. (7); above 0.
    #[arg(long, value_name = "WEIGHT", default_value_t = ElasticNet::default().lambda2)]
    lambda2: f64,
    /// Forgetting per epoch, gamma of eq. (8): above 0.9, at most 1. 0.9999 remembers 1,000 s.
    #[arg(long, value_name = "FACTOR", default_value_t = Settings::default().forgetting)]
    forgetting: f64,
    /// Step of the dual variable, nu of eq. (14).
    #[arg(long, value_name = "STEP", default_value_t = Settings::default().dual_step)]
    dual_step: f64,
    /// Lower edge of the band-pass, Hz.
    #[arg(long, value_name = "HZ", default_value_t = BandPassDesign::default().low_hz)]
    band_low_hz: f64,
    /// Upper edge of the band-pass, Hz; below 5.
    #[arg(long, value_name = "HZ", default_value_t = BandPassDesign::default().high_hz)]
    band_high_hz: f64,
    /// Poles of the band-pass on each side, 1 to 8.
    #[arg(long, value_name = "POLES", default_value_t = BandPassDesign::default().order)]
    band_order: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum ScalarArg {
    /// Geometrics G-882.
    G882,
    /// QuSpin QTFM Gen-1.
    QtfmGen1,
}

impl From<ScalarArg> for towmag::sensors::scalar::ScalarSettings {
    fn from(scalar: ScalarArg) -> Self {
        match scalar {
            ScalarArg::G882 => Self::G882,
            ScalarArg::QtfmGen1 => Self::QTFM_GEN1,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum MethodArg {
    /// No compensation.
    None,
    /// The calibrated coefficients throughout.
    Fixed,
    /// Recursive least squares with forgetting.
    Rls,
    /// The published saddle-point elastic net, eqs. (8) to (18).
    SaddlePoint,
    /// A bank of estimators that keep more or less of the calibration, averaged by how well they predict.
    Adaptive,
}

impl From<MethodArg> for Method {
    fn from(method: MethodArg) -> Self {
        match method {
            MethodArg::None => Self::None,
            MethodArg::Fixed => Self::Fixed,
            MethodArg::Rls => Self::Rls,
            MethodArg::SaddlePoint => Self::SaddlePoint,
            MethodArg::Adaptive => Self::Adaptive,
        }
    }
}

impl SettingsArgs {
    fn settings(&self, method: Method) -> Settings {
        Settings {
            method,
            band_pass: BandPassDesign {
                low_hz: self.band_low_hz,
                high_hz: self.band_high_hz,
                order: self.band_order,
                ..BandPassDesign::default()
            },
            penalty: ElasticNet { lambda1: self.lambda1, lambda2: self.lambda2 },
            forgetting: self.forgetting,
            dual_step: self.dual_step,
        }
    }
}

/// Parse the arguments, do the work, say how it went.
pub(crate) fn run() -> ExitCode {
    match execute(Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn execute(command: Command) -> Result<(), HostError> {
    match command {
        Command::Calibrate { recording, result, settings } => {
            let calibrated = command::calibrate(&recording, &result.out, &settings.settings(Method::Fixed))?;
            let heading = format!("Condition number {:.0}", calibrated.file.calibration.condition_number);
            show(&result, &calibrated.summary, std::slice::from_ref(&calibrated.summary), &heading);
        }
        Command::Replay { recording, coefficients, method, result, settings } => {
            let settings = settings.settings(method.into());
            let summary = command::replay(&recording, coefficients.as_deref(), &result.out, &settings)?;
            show(&result, &summary, std::slice::from_ref(&summary), "");
        }
        Command::Compare { calibration, recording, further, anomalies, line, skip_s, seed, result, settings } => {
            let settings = settings.settings(Method::None);
            let trial = TrialSettings { anomalies: anomalies.unwrap_or(0), seed, line, skip_s };
            let options = CompareOptions { further: pairs(further)?, trial };
            let compared: CompareResult = command::compare(&calibration, &recording, &result.out, &settings, &options)?;
            let heading = format!(
                "Calibration: improvement ratio {:.3}, condition number {:.0}",
                compared.calibration_improvement_ratio, compared.condition_number
            );
            show(&result, &compared, &compared.methods, &heading);
            if !result.json {
                compared.detection.iter().for_each(show_detection);
            }
        }
        Command::Table { calibration, tows, result, settings } => {
            let table = command::table(&calibration, &tows, &result.out, &settings.settings(Method::None))?;
            if result.json { print!("{}", to_json(&table)) } else { show_table(&table) }
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
            result,
            settings,
        } => {
            let settings = settings.settings(method.into());
            let scalar = scalar.into();
            let emulation =
                host_sim::emulator::EmulationSettings { image, scalar, conversions_per_epoch, faults, typed };
            let emulated = command::emulate(&recording, coefficients.as_deref(), &result.out, &settings, &emulation)?;
            show(&result, &emulated.summary, std::slice::from_ref(&emulated.summary), &emulated.heading());
        }
        Command::Recover { image, result } => {
            let recovered = command::recover(&image, &result.out)?;
            if result.json {
                print!("{}", to_json(&recovered));
            } else {
                println!(
                    "{} epochs of {} sessions in {} intact sectors; {} sectors missing, {} blocks damaged, {} unreadable; \
                     the body reported {} epochs lost.",
                    recovered.epochs,
                    recovered.sessions,
                    recovered.sectors,
                    recovered.missing_sectors,
                    recovered.damaged_blocks,
                    recovered.unreadable_blocks,
                    recovered.epochs_reported_lost
                );
            }
        }
        Command::Diagnose { recording, coefficients, confirm, withheld, seed, result } => {
            let options = command::DiagnoseOptions {
                coefficients: coefficients.as_deref(),
                confirm: confirm.as_deref(),
                withheld,
                seed,
            };
            let diagnosis = command::diagnose(&recording, &result.out, &options)?;
            if result.json {
                print!("{}", to_json(&diagnosis));
            } else {
                print!("{}", host_sim::gap::terminal::text(&diagnosis));
                point_to_report(&result);
            }
        }
        Command::Trial { out, recordings, minutes, seed, withhold, on, keep, json } => {
            let options = TrialOptions { recordings, seed, minutes, withhold, on, keep };
            let trial = command::trial(&out, &options, |sha256| eprintln!("answers.json sealed, SHA-256 {sha256}"))?;
            match (&trial.score, &trial.on) {
                (Some(score), _) if !json => print!("{}", host_sim::trial::terminal::text(score)),
                (_, Some(on)) if !json => print!("{}", host_sim::trial::terminal::text_on(on)),
                _ => print!("{}", to_json(&trial)),
            }
        }
        Command::Sample { out } => command::sample(&out)?,
        Command::Simulate { scenario, out, seed, effects, through_sensors, faults } => {
            let parsed = effects.iter().map(|text| text.parse());
            let requests: Vec<Request> = parsed.collect::<Result<_, RequestError>>()?;
            let wires = through_sensors.map(|scalar| Wires { scalar: scalar.into(), faults });
            let made = command::simulate(&scenario, &out, seed, &requests, wires.as_ref())?;
            println!("{} rows, seed {}, {:.3} nT in the band.", made.rows, made.seed, made.std_before_nt);
            made.effects.iter().for_each(|(name, rms_nt)| println!("{name}: {rms_nt:.4} nT rms"));
            made.through.iter().for_each(|through| println!("{through}."));
        }
        Command::Listen { port, baud, record, csv } => {
            let stdout = std::io::stdout();
            let mut screen = Screen::new(&stdout, stdout.is_terminal());
            let commands = std::io::BufReader::new(std::io::stdin());
            listen(&ListenOptions { port, baud, record, csv }, commands, &mut screen)?;
        }
    }
    Ok(())
}

/// Further arguments of `compare`, two by two.
fn pairs(further: Vec<PathBuf>) -> Result<Vec<[PathBuf; 2]>, HostError> {
    let pairs = further.chunks(2).map(|pair| pair.to_vec().try_into()).collect::<Result<_, _>>();
    pairs.map_err(|_| HostError::Usage("each further CAL.csv needs its REC.csv".into()))
}

/// The table of the paper, over the whole tow and from the third minute on.
fn show_table(table: &Table) {
    let Table { calibration, calibration_improvement_ratio, tows, .. } = table;
    println!("Calibrated on {calibration}, improvement ratio {calibration_improvement_ratio:.3}");
    for Tow { scenario, whole, late, late_bound_improvement_ratio } in tows {
        println!("\n{scenario:<14} {:>25} {:>30}", "whole tow", "from the third minute on");
        println!(
            "{:<14} {:>12} {:>12} {:>17} {:>12}",
            "method", "after (nT)", "improvement", "after (nT)", "improvement"
        );
        for (whole, late) in whole.iter().zip(late) {
            println!(
                "{:<14} {:>12.4} {:>12.4} {:>17.4} {:>12.4}",
                whole.method, whole.std_after_nT, whole.improvement_ratio, late.std_after_nT, late.improvement_ratio
            );
        }
        println!("Improvement of the best 18 fixed coefficients in hindsight: {late_bound_improvement_ratio:.4}.");
    }
    println!("\nStandard deviations in the band, strictly predictive.");
}

/// What the methods leave of injected anomalies.
fn show_detection(combination: &Combination) {
    let Combination { calibration, recording, bound_nT, methods } = combination;
    println!("\n{calibration} -> {recording}: bound {bound_nT:.3} nT");
    println!(
        "{:<14} {:>11} {:>12} {:>6} {:>11} {:>11} {:>10}",
        "method", "after/bound", "output/bound", "kept", "kept strong", "distortion", "detection"
    );
    for of in methods {
        let Detection { method, residual_over_bound, end_to_end_over_bound, kept, distortion, detection, .. } = of;
        let strong = of.kept_strong.map_or("-".into(), |kept| format!("{kept:.3}"));
        println!(
            "{method:<14} {residual_over_bound:>11.3} {end_to_end_over_bound:>12.3} {kept:>6.3} {strong:>11} \
             {distortion:>11.3} {detection:>10.3}"
        );
    }
    println!("Kept strong: of the anomalies whose peak is at least ten times the bound.");
}

/// The summary as JSON, or the table of the paper and where the rest is.
fn show(result: &ResultArgs, whole: &impl serde::Serialize, methods: &[Summary], heading: &str) {
    if result.json {
        print!("{}", to_json(whole));
        return;
    }
    if !heading.is_empty() {
        println!("{heading}");
    }
    println!(
        "{:<14} {:>14} {:>13} {:>12} {:>17}",
        "method", "before (nT)", "after (nT)", "improvement", "after update (nT)"
    );
    for Summary { method, std_before_nT, std_after_nT, improvement_ratio, std_after_update_nT, .. } in methods {
        println!(
            "{method:<14} {std_before_nT:>14.4} {std_after_nT:>13.4} {improvement_ratio:>12.4} {std_after_update_nT:>17.4}"
        );
    }
    println!("Standard deviations in the band, over {} rows of {}.", methods[0].used_rows, methods[0].rows);
    point_to_report(result);
}

/// For a person, not for a script.
fn point_to_report(result: &ResultArgs) {
    if std::io::stdout().is_terminal() {
        println!("Open {} in a browser.", result.out.join("report.html").display());
    }
}
