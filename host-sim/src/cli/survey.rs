//! What `survey` takes.

use std::path::PathBuf;

use clap::Args;
use host_sim::command::{self, SurveyRequest, SurveySummary};
use host_sim::error::HostError;
use host_sim::summary::to_json;
use host_sim::text::survey::NO_SMALLEST;
use towmag_survey::SurveyOptions;
use towmag_survey::navigation::{Layback, NavigationOptions, PositionOf};

use super::options::{ReadingArgs, ResultArgs};
use super::say::{print, say, warn};

#[derive(Args)]
pub(super) struct SurveyArgs {
    /// Recordings of one body: they share what is known of it.
    #[arg(value_name = "REC.csv", required = true)]
    recordings: Vec<PathBuf>,
    /// What `calibrate` wrote.
    #[arg(long, value_name = "FILE")]
    coefficients: Option<PathBuf>,
    /// The positions are the ship's: the body follows in her wake, as far behind as --layback-m says, or else the columns
    /// cable_out_m and depth_m.
    #[arg(long)]
    ship_position: bool,
    /// From the tow point back to the body, over ground, m. The positions are the ship's then.
    #[arg(long, value_name = "M")]
    layback_m: Option<f64>,
    /// What the layback from cable_out_m and depth_m is multiplied by: 1 for a straight cable, less for one that sags.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, conflicts_with = "layback_m")]
    catenary: f64,
    /// From the ship's antenna back to the tow point, m.
    #[arg(long, value_name = "M", default_value_t = 0.0, allow_hyphen_values = true)]
    tow_point_m: f64,
    /// Positions are this much late against the magnetics, s.
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_hyphen_values = true)]
    navigation_lag_s: f64,
    /// A base station, whose change with the day is taken from the field: IAGA-2002, or a table with utc_s or time_s and
    /// base_nT or scalar_nT. Without it the column base_nT, where there is one.
    #[arg(long, value_name = "FILE")]
    base: Option<PathBuf>,
    /// False contacts in an hour that are allowed.
    #[arg(long, value_name = "RATE", default_value_t = SurveyOptions::default().false_alarms_per_hour)]
    false_alarms_per_hour: f64,
    /// Side of a cell of grid.tif, m. By default a quarter of the distance between lines, rounded up.
    #[arg(long, value_name = "M")]
    grid_m: Option<f64>,
    /// Take the readings as they are. Without it, what `diagnose` names in the scalar and is louder than the noise is taken off them
    /// first: a fault of the sensor is no contact.
    #[arg(long)]
    no_diagnose: bool,
    #[command(flatten)]
    reading: ReadingArgs,
    #[command(flatten)]
    result: ResultArgs,
}

impl SurveyArgs {
    /// Do the work and say how it went.
    pub(super) fn run(self) -> Result<(), HostError> {
        let navigation = NavigationOptions {
            position: self.position()?,
            lag_s: finite("--navigation-lag-s", self.navigation_lag_s)?,
        };
        let options =
            SurveyOptions { navigation, false_alarms_per_hour: self.false_alarms_per_hour, ..SurveyOptions::default() };
        let request = SurveyRequest {
            recordings: self.recordings.iter().map(|path| self.reading.input(path.clone())).collect(),
            coefficients: self.coefficients,
            base: self.base,
            cell_m: self.grid_m,
            is_diagnosed: !self.no_diagnose,
            options,
        };
        let summary = command::survey(request, &self.result.out)?;
        warn(&summary.bad_rows.sentences());
        warn(&summary.warnings);
        if self.result.json {
            print(to_json(&summary))
        } else {
            show(&summary)
        }
        Ok(())
    }

    /// What is of the ship alone would change nothing, without a word.
    fn of_body(&self) -> Result<PositionOf, HostError> {
        let ships = [("--tow-point-m", self.tow_point_m != 0.0), ("--catenary", self.catenary != 1.0)];
        match ships.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(HostError::Usage(format!(
                "{option}: is of the ship's positions: give --ship-position or --layback-m too"
            ))),
            None => Ok(PositionOf::Body),
        }
    }

    fn position(&self) -> Result<PositionOf, HostError> {
        let tow_point_m = finite("--tow-point-m", self.tow_point_m)?;
        let layback = match self.layback_m {
            Some(metres) => Layback::Fixed(not_negative("--layback-m", metres)?),
            None if self.ship_position => Layback::Cable(not_negative("--catenary", self.catenary)?),
            None => return self.of_body(),
        };
        Ok(PositionOf::Ship { layback, tow_point_m })
    }
}

fn finite(option: &str, value: f64) -> Result<f64, HostError> {
    let refused = || HostError::Usage(format!("{option} {value}: must be a finite number"));
    value.is_finite().then_some(value).ok_or_else(refused)
}

fn not_negative(option: &str, value: f64) -> Result<f64, HostError> {
    let refused = || HostError::Usage(format!("{option} {value}: must be 0 or more"));
    (value.is_finite() && value >= 0.0).then_some(value).ok_or_else(refused)
}

fn show(summary: &SurveySummary) {
    let SurveySummary { recordings, duration_s, contacts, noise_floor_nT, false_alarms_per_hour, .. } = summary;
    let lines: usize = recordings.iter().map(|recording| recording.lines.len()).sum();
    say(format_args!(
        "{} recording(s), {:.1} min of valid rows, {lines} line(s): {contacts} contact(s) at {false_alarms_per_hour} false \
         alarms an hour.",
        recordings.len(),
        duration_s / 60.0
    ));
    if noise_floor_nT.is_finite() {
        say(format_args!("Noise floor in the band: {noise_floor_nT:.4} nT."));
    }
    let smallest = summary.smallest_moment_Am2.map_or_else(|| NO_SMALLEST.into(), |am2| format!("{am2:.2} A m2"));
    say(format_args!("Smallest moment below the track that is found nine times in ten: {smallest}."));
    if let Some(grid) = &summary.grid {
        let distance = grid.line_distance_m.map(|metres| format!(", lines {metres:.1} m apart")).unwrap_or_default();
        say(format_args!(
            "Map: {} by {} cells of {} m, EPSG:{}{distance}.",
            grid.width, grid.height, grid.cell_m, grid.epsg
        ));
    }
}
