//! The answers, sealed.

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::answer::Answer;
use crate::error::TrialError;

/// The answers, as text, and the seal on them.
#[derive(Clone, Debug)]
pub(crate) struct Sealed {
    /// What `answers.json` holds.
    pub(crate) answers: String,
    /// SHA-256 of it, hexadecimal.
    pub(crate) sha256: String,
}

impl Sealed {
    pub(crate) fn of(answers: &[Answer]) -> Self {
        let answers = to_json(&answers);
        Self { sha256: seal(&answers), answers }
    }

    /// The answers, if they still are those that were sealed.
    pub(crate) fn open(&self) -> Result<Vec<Answer>, TrialError> {
        if seal(&self.answers) != self.sha256 {
            return Err(TrialError::SealBroken);
        }
        serde_json::from_str(&self.answers).map_err(TrialError::Answers)
    }
}

/// SHA-256 of a text, hexadecimal.
pub fn seal(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Indented, with a newline at the end.
fn to_json(answers: &impl Serialize) -> String {
    let mut json = serde_json::to_string_pretty(answers).expect("numbers and strings are always JSON");
    json.push('\n');
    json
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_that_were_changed_are_refused() {
        let sealed = Sealed::of(&[]);
        assert_eq!(sealed.open().unwrap(), []);
        let changed = Sealed { answers: "[ ]\n".into(), ..sealed };
        assert!(matches!(changed.open(), Err(TrialError::SealBroken)));
    }

    #[test]
    fn the_seal_is_sha_256() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(seal("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
