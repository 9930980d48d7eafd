//! What several commands take.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use host_sim::recording::Input;
use towmag::estimate::ElasticNet;
use towmag::filter::BandPassDesign;
use towmag::sensors::scalar::{FORMATS, Format, ScalarSettings};
use towmag::{Method, Settings};

#[derive(Args)]
pub(super) struct ReadingArgs {
    /// End at the first bad row with exit code 2. Otherwise up to a tenth of the rows may be bad: they are carried through,
    /// not used, and counted.
    #[arg(long)]
    pub(super) strict: bool,
}

impl ReadingArgs {
    /// A recording that is read so.
    pub(super) fn input(&self, path: PathBuf) -> Input {
        Input::new(path, self.strict)
    }
}

#[derive(Args)]
pub(super) struct ResultArgs {
    /// Folder for the results; made if absent. Results that are there are replaced, but only once all new ones are whole.
    #[arg(long, value_name = "DIR")]
    pub(super) out: PathBuf,
    /// Print summary.json instead of a table.
    #[arg(long)]
    pub(super) json: bool,
}

/// Defaults are the published ones: Yan, Zhao, Liu, Wu 2025, doi:10.19306/j.cnki.2095-8110.2025.02.005, section 3.1.
#[derive(Args)]
#[command(
    next_help_heading = "Settings of the estimators (defaults as published, doi:10.19306/j.cnki.2095-8110.2025.02.005)"
)]
pub(super) struct SettingsArgs {
    /// Weight of the coefficients' magnitudes, eq. (7); coefficients in nT, nT/nT and s.
    #[arg(long, value_name = "WEIGHT", default_value_t = ElasticNet::default().lambda1)]
    pub(super) lambda1: f64,
    /// Weight of half the coefficients' squares, eq. (7); above 0.
    #[arg(long, value_name = "WEIGHT", default_value_t = ElasticNet::default().lambda2)]
    pub(super) lambda2: f64,
    /// Forgetting per epoch, gamma of eq. (8): above 0.9, at most 1. 0.9999 remembers 1,000 s.
    #[arg(long, value_name = "FACTOR", default_value_t = Settings::default().forgetting)]
    pub(super) forgetting: f64,
    /// Step of the dual variable, nu of eq. (14).
    #[arg(long, value_name = "STEP", default_value_t = Settings::default().dual_step)]
    pub(super) dual_step: f64,
    /// Lower edge of the band-pass, Hz.
    #[arg(long, value_name = "HZ", default_value_t = BandPassDesign::default().low_hz)]
    pub(super) band_low_hz: f64,
    /// Upper edge of the band-pass, Hz; below 5.
    #[arg(long, value_name = "HZ", default_value_t = BandPassDesign::default().high_hz)]
    pub(super) band_high_hz: f64,
    /// Poles of the band-pass on each side, 1 to 8.
    #[arg(long, value_name = "POLES", default_value_t = BandPassDesign::default().order)]
    pub(super) band_order: usize,
}

/// Every format of a scalar sensor that the body can be set to, by its name on the console.
pub(super) fn scalar_sensor() -> impl TypedValueParser<Value = ScalarSettings> {
    let names = FORMATS.map(|format| PossibleValue::new(format.name).help(format.title));
    PossibleValuesParser::new(names)
        .try_map(|name| Format::named(&name).map(ScalarSettings::of).ok_or("no format of this name"))
}

/// Every format of an export.
pub(super) fn export_format() -> impl TypedValueParser<Value = towmag_export::Format> {
    let names = towmag_export::Format::ALL.map(|format| PossibleValue::new(format.name()).help(format.title()));
    PossibleValuesParser::new(names).try_map(|name| name.parse::<towmag_export::Format>())
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum MethodArg {
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
    pub(super) fn settings(&self, method: Method) -> Settings {
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
