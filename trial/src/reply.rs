//! What came back of a recording.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use serde_json::value::RawValue;

use crate::error::TrialError;
use crate::said::Said;

/// What was said of a recording.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TrialResult {
    /// Without the withheld effect, or with all.
    pub diagnosis: Reply,
    /// With the withheld effect back in the library; of recordings that have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub put_back: Option<Reply>,
}

/// One `diagnosis.json`: the text that came, and what it says. Written out, it is the text again.
#[derive(Clone, Debug)]
pub struct Reply {
    json: String,
    said: Said,
}

impl Reply {
    /// Read a `diagnosis.json`; errors call the recording `name`.
    ///
    /// # Errors
    ///
    /// When it is none.
    pub fn read(name: &str, json: String) -> Result<Self, TrialError> {
        match serde_json::from_str(&json) {
            Ok(said) => Ok(Self { json, said }),
            Err(source) => Err(TrialError::Reply { name: name.into(), source }),
        }
    }

    /// The text, as it came.
    pub fn json(&self) -> &str {
        &self.json
    }

    /// What it says.
    pub fn said(&self) -> &Said {
        &self.said
    }
}

impl Serialize for Reply {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        serde_transcode::transcode(&mut serde_json::Deserializer::from_str(&self.json), to)
    }
}

/// What a part of a trial has kept, to be written out again with the same digits.
impl<'de> Deserialize<'de> for Reply {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let text = <&RawValue>::deserialize(from)?.get();
        Self::read("a recording", text.into()).map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reply_is_written_out_with_all_its_keys_in_their_order_and_all_digits() {
        let json = r#"{"z":[],"verdict":"no_gap","p_value":1.2345678901234568e-300,"third":0.3333333333333333,"none":null,"effects":[],"candidates":[],"a":{"x":18446744073709551615,"y":-1}}"#;
        let reply = Reply::read("recording 1", json.into()).unwrap();
        assert_eq!(serde_json::to_string(&reply).unwrap(), json);
        let error = Reply::read("recording 1", "{}".into()).unwrap_err();
        assert!(
            error.to_string().starts_with("recording 1: its diagnosis.json cannot be read: missing field"),
            "{error}"
        );
    }
}
