//! Which way the axes of a file's fluxgate point.

use serde::{Deserialize, Serialize};

use crate::error::ImportError;

/// An axis of the file, with its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Axis {
    /// 0 to 2.
    pub of: usize,
    /// Whether its sign is turned.
    pub is_turned: bool,
}

/// Three axes of a text: `x,-y,-z`.
///
/// # Errors
///
/// When it is not each of the three once.
pub fn parse_axes(text: &str) -> Result<[Axis; 3], ImportError> {
    let wrong = || {
        let what = format!(
            "--axes \"{text}\": give forward, starboard and down in terms of the file's own axes, each once, as in y,x,-z"
        );
        ImportError::Usage(what)
    };
    let axes: Vec<Axis> = text
        .split(',')
        .map(|axis| Axis::try_from(axis.trim().to_string()))
        .collect::<Result<_, _>>()
        .map_err(|_| wrong())?;
    let axes: [Axis; 3] = axes.try_into().map_err(|_| wrong())?;
    let each_once = (0..3).all(|axis| axes.iter().any(|there| there.of == axis));
    if each_once { Ok(axes) } else { Err(wrong()) }
}

impl TryFrom<String> for Axis {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let (is_turned, letter) = match text.strip_prefix('-') {
            Some(letter) => (true, letter),
            None => (false, text.strip_prefix('+').unwrap_or(&text)),
        };
        let of = ["x", "y", "z"].iter().position(|axis| axis.eq_ignore_ascii_case(letter));
        of.map(|of| Self { of, is_turned }).ok_or_else(|| format!("\"{text}\" is no axis: x, y, z or -x, -y, -z"))
    }
}

impl From<Axis> for String {
    fn from(axis: Axis) -> Self {
        let sign = if axis.is_turned { "-" } else { "" };
        format!("{sign}{}", ["x", "y", "z"][axis.of])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_axis_stands_once() {
        let [forward, starboard, down] = parse_axes("y, X,-z").unwrap();
        assert_eq!([forward.of, starboard.of, down.of], [1, 0, 2]);
        assert_eq!([forward.is_turned, starboard.is_turned, down.is_turned], [false, false, true]);
        for axes in ["x,y", "x,x,z", "a,b,c", "", "x,y,z,x"] {
            assert!(parse_axes(axes).unwrap_err().to_string().contains("each once"), "{axes}");
        }
    }
}
