//! The file as TOML has it.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileText {
    pub(crate) name: Spanned<String>,
    pub(crate) title: Option<Spanned<String>>,
    pub(crate) channel: ChannelText,
    pub(crate) kind: KindText,
    pub(crate) formula: Spanned<toml::Value>,
    #[serde(default)]
    pub(crate) parameters: BTreeMap<String, Spanned<ParameterText>>,
    #[serde(default)]
    pub(crate) inputs: BTreeMap<String, Spanned<InputText>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ChannelText {
    Scalar,
    Fluxgate,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum KindText {
    Additive,
    Multiplicative,
    Delay,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ParameterText {
    #[serde(default)]
    pub(crate) unit: String,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) default: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct InputText {
    pub(crate) of: Option<String>,
    pub(crate) formula: Option<String>,
    pub(crate) filter: FilterText,
    pub(crate) time_s: Option<toml::Value>,
    pub(crate) width: Option<f64>,
}

#[derive(Clone, Copy, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum FilterText {
    Lowpass,
    Delay,
    Mean,
    Rate,
    Hilbert,
    Play,
    Hold,
}
