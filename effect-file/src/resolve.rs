//! What each name of a formula or an input means.

use crate::error::quoted;
use crate::formula::Source;
use crate::parts::{Input, Parameter};
use crate::variable::Variable;

/// Columns that are what an effect is to explain: a formula of them would explain it by itself.
const READINGS: [&str; 4] = ["scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];

/// What names may mean at some place of a file.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) parameters: &'a [Parameter],
    pub(crate) inputs: &'a [Input],
}

impl Scope<'_> {
    pub(crate) fn source(&self, name: &str) -> Result<Source, String> {
        if let Some(index) = self.parameters.iter().position(|parameter| parameter.name == name) {
            return Ok(Source::Parameter(index));
        }
        if let Some(index) = self.inputs.iter().position(|input| input.name == name) {
            return Ok(Source::Input(index));
        }
        if let Some(variable) = Variable::named(name) {
            return Ok(Source::Variable(variable));
        }
        match READINGS.contains(&name) {
            true => Err(format!(
                "{} is the reading itself, which an effect of it would always explain: s and fx, fy, fz are the clean ones",
                quoted(name)
            )),
            false => Ok(Source::Column(name.into())),
        }
    }
}
