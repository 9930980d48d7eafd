//! The commands and their arguments.

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use host_sim::wire::Fault;
use towmag::sensors::scalar::ScalarSettings;
use towmag_export::Format;

use super::card::CardAction;
use super::import::ImportArgs;
use super::listen::ListenArgs;
use super::options::{MethodArg, ReadingArgs, ResultArgs, SettingsArgs, export_format, scalar_sensor};
use super::survey::SurveyArgs;
use super::trial::TrialArgs;
#[cfg(unix)]
use super::watch::WatchArgs;

/// Magnetic compensation of a towed body's recordings, with the very core that the body runs.
///
/// A recording is a CSV file with the columns time_s, scalar_nT, flux_x_nT, flux_y_nT, flux_z_nT at 10 Hz; more columns
/// are carried through. It may be gzipped, a device log, or come through a pipe: - is standard input. Exit codes: 0 done, 1 the work failed, 2 bad usage or bad input.
#[derive(Parser)]
#[command(version, max_term_width = 110)]
pub(super) struct Cli {
    /// Print nothing but warnings and errors, and show no progress.
    #[arg(long, global = true)]
    pub(super) quiet: bool,
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Subcommand)]
pub(super) enum Command {
    /// Fit the 18 coefficients to a calibration recording: batch elastic net, eq. (7).
    ///
    /// Needs 60 s of valid rows, better 6 minutes: roll, pitch and yaw on four headings.
    /// Writes coefficients.toml, summary.json and report.html.
    Calibrate {
        /// The calibration recording.
        #[arg(value_name = "CAL.csv")]
        recording: PathBuf,
        #[command(flatten)]
        reading: ReadingArgs,
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
        reading: ReadingArgs,
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
        reading: ReadingArgs,
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
        #[arg(long, value_parser = scalar_sensor(), default_value = "qtfm-gen1")]
        scalar: ScalarSettings,
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
        watching: WatchArgs,
        #[command(flatten)]
        reading: ReadingArgs,
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
    /// Bring any recording into this project's format: finds out what a file is, says what it took for what, and what is odd.
    ///
    /// Reads delimited text of any kind, spreadsheets, Geosoft XYZ, MagNav HDF5, MATLAB, ASEG-GDF2, MGD77T, IAGA-2002, NMEA and
    /// RTKLIB logs, and the body's own log, gzipped or not. Writes the recording at 10 Hz, and beside it REC.profile.toml, which
    /// can be corrected and given back, and REC.import.json.
    Import(Box<ImportArgs>),
    /// Find the gap between a recording and the simulator: where it lies, which effect causes it, how far it shrinks.
    ///
    /// Needs 60 s of valid rows, better 10 minutes with manoeuvres. Writes diagnosis.json, gap.csv (the residual of
    /// both sensors before and after the effects that were found) and report.html.
    Diagnose {
        /// The recording.
        #[arg(value_name = "REC.csv", required_unless_present = "plan", conflicts_with = "plan")]
        recording: Option<PathBuf>,
        /// Before the tow: say which effects a recording of this scenario could not tell apart at which strength, and what
        /// to sail beside it so that they come apart. Writes plan.json.
        #[arg(long, value_name = "SCENARIO.toml", conflicts_with_all = ["coefficients", "confirm", "withheld", "simulation"])]
        plan: Option<PathBuf>,
        /// What `calibrate` wrote, to start from; the 18 coefficients are refitted in any case.
        #[arg(long, value_name = "FILE")]
        coefficients: Option<PathBuf>,
        /// A second recording: the effects that were found are tried on it, their parameters frozen.
        #[arg(long, value_name = "REC2.csv")]
        confirm: Option<PathBuf>,
        /// A simulation of your own of the same track, at any rate, in the place of the built-in one: a CSV file with time_s,
        /// scalar_nT, flux_x_nT, flux_y_nT and flux_z_nT. It is laid on the recording in time by the fluxgate.
        #[arg(long, value_name = "SIM.csv")]
        simulation: Option<PathBuf>,
        /// Hold the 18 terms of the simulation; otherwise they are fitted to the recording.
        #[arg(long, requires = "simulation")]
        hold_terms: bool,
        /// Take an effect out of the library. Repeatable.
        #[arg(long = "withhold", value_name = "NAME")]
        withheld: Vec<String>,
        /// Look for an effect that you have written, too; docs/effect_files.md has the language. Repeatable.
        #[arg(long = "effect-file", value_name = "FILE.toml")]
        effect_files: Vec<PathBuf>,
        /// Try a column of the recording: as it adds to the field, as a moment in the body, and up to 2 s late or early.
        /// Repeatable.
        #[arg(long = "regressor", value_name = "COLUMN")]
        regressors: Vec<String>,
        /// Seed of everything drawn.
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        seed: u64,
        #[command(flatten)]
        reading: ReadingArgs,
        #[command(flatten)]
        result: ResultArgs,
    },
    /// Survey one or several tows of a body: the field at its level, the contacts in it, and where they are.
    ///
    /// Writes levelled.csv (the recordings with field_nT, field_std_nT, anomaly_nT, anomaly_std_nT, valid), contacts.csv,
    /// contacts.geojson, track.geojson and summary.json; with positions grid.tif too, the anomaly on a UTM grid.
    Survey(Box<SurveyArgs>),
    /// Try the diagnosis blind: on recordings with hidden effects, whose answers are sealed before it begins.
    ///
    /// Three in ten hide nothing, the others one effect, two, or a mechanism that is not in the library, 1, 3 or 10 times
    /// as strong as the noise; docs/trial.md says how they are made. Writes answers.json, report.html and trial.json, the
    /// latter first without the score and with the SHA-256 of the answers, which is also printed.
    Trial(Box<TrialArgs>),
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
        /// The recording; replaced if it is there. With - it goes to standard output.
        #[arg(long, value_name = "REC.csv")]
        out: PathBuf,
        /// Seed of everything random, in place of the scenario's.
        #[arg(long, value_name = "NUMBER")]
        seed: Option<u64>,
        /// An unmodelled effect, as in scalar_lag:lag_s=0.05. Repeatable.
        #[arg(long = "effect", value_name = "NAME:PARAM=VALUE,...")]
        effects: Vec<String>,
        /// An effect that you have written; docs/effect_files.md has the language. --effect NAME:PARAM=VALUE sets its
        /// parameters, else they are those that the file gives. Repeatable.
        #[arg(long = "effect-file", value_name = "FILE.toml")]
        effect_files: Vec<PathBuf>,
        /// Send the readings over the sensors' wires, as this scalar sensor's sentences and the converter's SPI frames, to
        /// the drivers, the 10 Hz grid and the core of the firmware: the recording is then what the body has of it.
        #[arg(
            long,
            value_name = "SCALAR",
            value_parser = scalar_sensor(),
            num_args = 0..=1,
            require_equals = true,
            default_missing_value = "g882"
        )]
        through_sensors: Option<ScalarSettings>,
        /// What befalls the wires: drop, damage, late, stuck, noise (scalar sensor), crc or unplug (converter), then @ROW or
        /// @ROW+COUNT. Repeatable.
        #[arg(long = "fault", value_name = "KIND@ROW", requires = "through_sensors")]
        faults: Vec<Fault>,
    },
    /// Write a recording or a result as a file for other tools: maps, plots, notebooks.
    ///
    /// All columns are kept. docs/using.md says which program opens what.
    Export {
        /// The recording, a table of a result (compensated.csv, levelled.csv, gap.csv), or the folder of a result.
        #[arg(value_name = "FILE")]
        input: PathBuf,
        /// What to write.
        #[arg(long, value_name = "FORMAT", value_parser = export_format())]
        format: Format,
        /// The file; replaced if it is there. - is stdout, for xyz and geojson.
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
        /// geojson: seconds between two points of the track; all rows without.
        #[arg(long, value_name = "SECONDS")]
        every: Option<f64>,
        /// geojson: also a point a row, with all its columns.
        #[arg(long)]
        points: bool,
    },
    /// Print what a shell needs to complete commands and options, for it to load at its start.
    ///
    /// For example: host-sim completions bash > ~/.local/share/bash-completion/completions/host-sim
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write the manual pages, one a command; read them with man DIR/host-sim-replay.1, or install them.
    Man {
        /// Folder for them; made if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Prepare a card for the body, or try whether it is fit.
    #[command(subcommand)]
    Card(CardAction),
    /// Show the body's telemetry live, record it, and pass typed commands to the body.
    ///
    /// What is typed goes to the body line by line; type help for its commands. Ctrl-C ends; all that was heard
    /// is in the files by then. A recording made with --record can be listened to again. With --serve there is a page for
    /// browsers, too: a strip chart, lamps, alarms, marks and contacts.
    Listen(Box<ListenArgs>),
}
