//! What comes from a page: small, of a known form, or nothing.

use serde::Deserialize;

use crate::notice::LONGEST_LABEL;

/// Longest message of a page, bytes: the longest form of the longest wish is a third of it.
pub(crate) const LONGEST_MESSAGE: usize = 2_048;

/// Longest command, bytes: the body takes no longer line.
pub(crate) const LONGEST_COMMAND: usize = 100;

/// What a page wants.
#[derive(Debug, PartialEq, Deserialize)]
#[serde(tag = "want", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Wish {
    /// What was in the last so many seconds, or what of it is later than a time.
    History { window_s: f64, since_s: Option<f64> },
    /// A mark at a time, or now.
    Mark { time_s: Option<f64>, label: String },
    /// A person has seen an alarm.
    Acknowledge { alarm: String },
    /// A line for the body.
    Command { line: String },
}

impl Wish {
    /// Read a message; `None` when it is none.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        if text.len() > LONGEST_MESSAGE {
            return None;
        }
        Some(match serde_json::from_str(text).ok()? {
            Self::History { window_s, .. } if !window_s.is_finite() => return None,
            Self::Mark { time_s, label } => Self::Mark { time_s, label: plain(&label, LONGEST_LABEL) },
            Self::Command { line } if line.len() > LONGEST_COMMAND => return None,
            Self::Command { line } => Self::Command { line: plain(&line, LONGEST_COMMAND) },
            wish => wish,
        })
    }
}

/// A line of text without control characters, at most so many bytes.
fn plain(text: &str, longest: usize) -> String {
    let mut plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    plain.truncate(plain.floor_char_boundary(longest));
    plain.trim().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wishes_are_read_and_cleaned() {
        let parse = |text: &str| Wish::parse(text);
        assert_eq!(
            parse(r#"{"want":"history","window_s":600,"since_s":null}"#),
            Some(Wish::History { window_s: 600.0, since_s: None })
        );
        assert_eq!(
            parse(r#"{"want":"mark","time_s":5,"label":" a\u001b[2J\nwreck "}"#),
            Some(Wish::Mark { time_s: Some(5.0), label: "a [2J wreck".into() })
        );
        let long = format!(r#"{{"want":"mark","label":"{}"}}"#, "ä".repeat(200));
        assert!(matches!(parse(&long), Some(Wish::Mark { label, .. }) if label.len() == LONGEST_LABEL));
        assert_eq!(
            parse(r#"{"want":"command","line":"status\r\nreset"}"#),
            Some(Wish::Command { line: "status  reset".into() })
        );
    }

    #[test]
    fn anything_else_is_nothing() {
        let long = format!(r#"{{"want":"command","line":"{}"}}"#, "x".repeat(101));
        let longer = format!(r#"{{"want":"mark","label":"{}"}}"#, "x".repeat(LONGEST_MESSAGE));
        for text in [
            "",
            "null",
            "[]",
            "{}",
            r#"{"want":"rum"}"#,
            r#"{"want":"history"}"#,
            r#"{"want":"history","window_s":"600"}"#,
            r#"{"want":"history","window_s":1e999}"#,
            r#"{"want":"mark","label":"a","extra":1}"#,
            &"[".repeat(1_000),
            &long,
            &longer,
        ] {
            assert_eq!(Wish::parse(text), None, "{text}");
        }
    }
}
