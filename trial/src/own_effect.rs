//! Effects that users write, in a trial.

use serde::{Deserialize, Serialize};
use towmag_effect_file::EffectFile;

use crate::error::TrialError;
use crate::world::effects::{self, Effect};

/// An effect that a user wrote. Of the trial's files it is read as text: then it says what was tried, and cannot be tried again.
#[derive(Clone, Serialize, Deserialize)]
pub struct OwnEffect {
    /// The file, as the user named it.
    pub file: String,
    /// What is in it.
    pub text: String,
    #[serde(skip)]
    effect: Option<&'static Effect>,
}

impl OwnEffect {
    /// From the text of a file. What it says is kept until the program ends, as the trial's own effects are.
    ///
    /// # Errors
    ///
    /// When it is no effect file, has the name of an effect of the trial, or needs what no recording of a trial has.
    pub fn read(file: &str, text: String) -> Result<Self, TrialError> {
        let parsed = EffectFile::parse(&text, file).map_err(|error| TrialError::OwnEffect(error.to_string()))?;
        if effects::named(&parsed.name, &[]).is_some() {
            return Err(TrialError::OwnEffect(format!("{file}: the name {} is taken", parsed.name)));
        }
        let effect = effects::of_file(parsed).map_err(|what| TrialError::OwnEffect(format!("{file}: {what}")))?;
        Ok(Self { file: file.into(), text, effect: Some(Box::leak(Box::new(effect))) })
    }

    /// What it does.
    pub(crate) fn effect(&self) -> Option<&'static Effect> {
        self.effect
    }
}

impl PartialEq for OwnEffect {
    fn eq(&self, other: &Self) -> bool {
        (&self.file, &self.text) == (&other.file, &other.text)
    }
}

impl std::fmt::Debug for OwnEffect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OwnEffect").field("file", &self.file).finish_non_exhaustive()
    }
}
