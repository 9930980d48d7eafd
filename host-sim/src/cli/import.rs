//! What `import` takes.

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::error::HostError;
use towmag_import::Options;
use towmag_import::profile::{Axis, Profile, parse_axes};

#[derive(Args)]
pub(super) struct ImportArgs {
    /// One or more files; - is standard input. Pieces of one log are appended, navigation and other sensors are merged by
    /// time.
    #[arg(value_name = "FILE", required = true)]
    pub(super) files: Vec<PathBuf>,
    /// The recording; replaced if it is there. With - it goes to standard output, without the files beside it.
    #[arg(long, value_name = "REC.csv")]
    pub(super) out: PathBuf,
    /// What an earlier import has written beside its recording, or a correction of it.
    #[arg(long, value_name = "REC.profile.toml")]
    profile: Option<PathBuf>,
    /// The column of the scalar sensor.
    #[arg(long, value_name = "NAME")]
    scalar: Option<String>,
    /// What the names of the fluxgate's columns have in common, or its three names with commas.
    #[arg(long, value_name = "NAME")]
    flux: Option<String>,
    /// The column of the time, or date and time of day with a comma.
    #[arg(long, value_name = "NAME[,NAME]", value_delimiter = ',')]
    time: Vec<String>,
    /// Rows a second, where no column holds the time.
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Date of the first row, where the file tells only the time of day.
    #[arg(long, value_name = "YYYY-MM-DD")]
    date: Option<String>,
    /// Unit of scalar and fluxgate: nT, uT, G and the like.
    #[arg(long, value_name = "UNIT")]
    units: Option<String>,
    /// What the fluxgate's readings are multiplied by, to nT: of counts.
    #[arg(long, value_name = "FACTOR")]
    flux_factor: Option<f64>,
    /// Forward, starboard and down in terms of the file's own axes, as in y,x,-z.
    #[arg(long, value_name = "AXES", allow_hyphen_values = true, value_parser = axes)]
    axes: Option<[Axis; 3]>,
    /// A column of the recording and what it comes from. Repeatable.
    #[arg(long = "map", value_name = "COLUMN=NAME", value_parser = pair)]
    map: Vec<(String, String)>,
    /// A value that stands for "missing". Repeatable.
    #[arg(long = "dummy", value_name = "VALUE", allow_hyphen_values = true)]
    dummies: Vec<f64>,
    /// The scalar's readings are this much late against the fluxgate's, and are moved back, s.
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    scalar_lag: Option<f64>,
    /// Sheet of a workbook, group or sensor of a file.
    #[arg(long, value_name = "NAME")]
    part: Option<String>,
    /// What parts the fields of a text: comma, semicolon, tab, bar or blanks.
    #[arg(long, value_name = "NAME")]
    delimiter: Option<String>,
    /// What stands before the decimals of a text: point or comma.
    #[arg(long, value_name = "NAME")]
    decimal: Option<String>,
    /// Encoding of a text: utf-8, utf-16le, windows-1252 and the like.
    #[arg(long, value_name = "NAME")]
    encoding: Option<String>,
    /// Print REC.import.json instead of a few lines.
    #[arg(long)]
    pub(super) json: bool,
}

fn axes(text: &str) -> Result<[Axis; 3], String> {
    parse_axes(text).map_err(|error| error.to_string())
}

fn pair(text: &str) -> Result<(String, String), String> {
    let (column, name) = text.split_once('=').ok_or("give COLUMN=NAME, as in depth_m=Tiefe")?;
    Ok((column.trim().into(), name.trim().into()))
}

impl ImportArgs {
    /// The profile, and what goes before it.
    pub(super) fn options(&self) -> Result<Options, HostError> {
        let mut profile = self.profile.as_deref().map(read).transpose()?.unwrap_or_default();
        if !self.time.is_empty() {
            profile.time.columns.clone_from(&self.time);
            profile.time.form = None;
        }
        let time = &mut profile.time;
        replace(&mut time.rate_hz, self.rate);
        replace(&mut time.date, self.date.clone());
        replace(&mut profile.axes, self.axes);
        replace(&mut profile.scalar_lag_s, self.scalar_lag);
        replace(&mut profile.part, self.part.clone());
        replace(&mut profile.text.delimiter, self.delimiter.clone());
        replace(&mut profile.text.decimal, self.decimal.clone());
        replace(&mut profile.text.encoding, self.encoding.clone());
        profile.dummies.extend(&self.dummies);
        let (scalar, flux, units, map) = (self.scalar.clone(), self.flux.clone(), self.units.clone(), self.map.clone());
        Ok(Options { profile, scalar, flux, units, flux_factor: self.flux_factor, map })
    }
}

fn replace<T>(value: &mut Option<T>, asked: Option<T>) {
    if asked.is_some() {
        *value = asked;
    }
}

fn read(path: &Path) -> Result<Profile, HostError> {
    let name = path.display().to_string();
    let text =
        std::fs::read_to_string(path).map_err(|error| HostError::Usage(format!("{name}: cannot be read: {error}")))?;
    Ok(Profile::from_toml(&name, &text)?)
}
