//! What a `diagnosis.json` says, as far as it is scored: read as any script outside would read it.

use serde::{Deserialize, Deserializer};

/// What the recording is said to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It looks like the simulator.
    NoGap,
    /// With the named effects it does.
    Explained,
    /// They help, but a significant gap is left.
    PartlyExplained,
    /// A gap, and none of the known effects causes it.
    Unknown,
}

/// A diagnosis. All other keys are passed over.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Said {
    /// In a word.
    pub verdict: Verdict,
    /// In a sentence, for a reader; empty where there is none.
    #[serde(default)]
    pub summary: String,
    /// The effects that are said to be at work, most probable first.
    pub effects: Vec<SaidEffect>,
    /// Every effect, `none` and `unknown`, as possible main causes.
    pub candidates: Vec<Candidate>,
    /// What is left without a name, where something is.
    #[serde(default)]
    pub unexplained: Option<SaidRest>,
    /// The iron that the body is said to have passed.
    #[serde(default)]
    pub targets: Vec<SaidTarget>,
}

/// What is said of what is left.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct SaidRest {
    /// Inputs that may drive it, most probable first; empty where that was not asked.
    #[serde(default)]
    pub drivers: Vec<SaidDriver>,
    /// Share of the excess that a proposed effect closes; none where nothing is proposed.
    #[serde(default)]
    pub gap_closed: Option<GapClosed>,
}

/// An input that may drive what is left.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct SaidDriver {
    /// Its name.
    pub input: String,
    /// That it does.
    pub probability: f64,
}

/// A target that is said to be there.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct SaidTarget {
    /// On the time axis of the recording, s.
    pub time_s: f64,
}

/// An effect that is said to be at work.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct SaidEffect {
    /// Its name.
    pub name: String,
    /// That it is at work; a diagnosis that does not say is sure.
    #[serde(default = "sure")]
    pub probability: f64,
    /// The load whose recorded current drives it.
    #[serde(default)]
    pub load: Option<String>,
    /// Its parameters, in the units of their names.
    pub parameters: Vec<SaidParameter>,
    /// Share of the excess that goes with it.
    pub gap_closed: GapClosed,
    /// The same on a second recording, parameters frozen.
    #[serde(default)]
    pub confirmed: Option<GapClosed>,
    /// Effects that would do nearly as well.
    pub indistinguishable_from: Vec<String>,
}

/// A parameter of an effect.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct SaidParameter {
    /// With its unit.
    pub name: String,
    /// None where the recording does not tell it.
    pub value: Option<f64>,
    /// 95 % interval.
    #[serde(default, deserialize_with = "interval_if_any")]
    pub ci95: Option<[f64; 2]>,
}

/// A share of the gap that goes with an effect.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct GapClosed {
    /// The share.
    #[serde(deserialize_with = "number")]
    pub fraction: f64,
    /// Its 95 % interval.
    #[serde(deserialize_with = "interval")]
    pub ci95: [f64; 2],
}

/// A possible main cause.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Candidate {
    /// An effect, `none` or `unknown`.
    pub name: String,
    /// Of being the main cause.
    #[serde(deserialize_with = "number")]
    pub probability: f64,
}

fn sure() -> f64 {
    1.0
}

/// JSON has no way to say that a number is none but `null`.
fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

fn interval<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
    Ok(<[Option<f64>; 2]>::deserialize(from)?.map(|end| end.unwrap_or(f64::NAN)))
}

fn interval_if_any<'de, D: Deserializer<'de>>(from: D) -> Result<Option<[f64; 2]>, D::Error> {
    let ends = Option::<[Option<f64>; 2]>::deserialize(from)?;
    Ok(ends.map(|ends| ends.map(|end| end.unwrap_or(f64::NAN))))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the project's contract, shortened.
    const EXAMPLE: &str = r#"{
        "schema": 1, "verdict": "partly_explained", "gap": {"residual_rms_nT": 0.41}, "where": [],
        "effects": [{
            "name": "scalar_lag", "probability": 0.97,
            "parameters": [
                {"name": "lag_s", "value": 0.051, "ci95": [0.048, 0.054]}, {"name": "none_s", "value": null}
            ],
            "gap_closed": {"fraction": 0.94, "ci95": [0.91, null], "held_out": true},
            "indistinguishable_from": ["scalar_lowpass"]
        }],
        "candidates": [{"name": "scalar_lag", "probability": 0.97, "identifiable_fraction": 0.06}],
        "targets": [{"time_s": 520.1, "peak_nT": 8.0, "width_s": 2.1, "probability": 0.99}],
        "next_manoeuvre": null
    }"#;

    #[test]
    fn what_is_scored_is_read_and_all_else_is_passed_over() {
        let said: Said = serde_json::from_str(EXAMPLE).unwrap();
        assert_eq!((said.verdict, said.summary.as_str()), (Verdict::PartlyExplained, ""));
        let [effect] = &said.effects[..] else { panic!("{said:?}") };
        assert_eq!((effect.name.as_str(), effect.confirmed), ("scalar_lag", None));
        assert_eq!((effect.parameters[0].value, effect.parameters[0].ci95), (Some(0.051), Some([0.048, 0.054])));
        assert_eq!((effect.parameters[1].value, effect.parameters[1].ci95), (None, None));
        assert!(effect.gap_closed.ci95[0] == 0.91 && effect.gap_closed.ci95[1].is_nan());
        assert_eq!(effect.indistinguishable_from, ["scalar_lowpass"]);
        assert_eq!((said.candidates[0].probability, effect.probability, &effect.load), (0.97, 0.97, &None));
        assert_eq!(said.targets, [SaidTarget { time_s: 520.1 }]);
        let without = EXAMPLE.replace("targets", "others").replace("\"probability\": 0.97,\n", "\n");
        let said: Said = serde_json::from_str(&without).unwrap();
        assert_eq!((said.targets.len(), said.effects[0].probability), (0, 1.0));
    }

    #[test]
    fn what_is_no_diagnosis_is_refused() {
        for text in ["{}", "[]", r#"{"verdict": "perhaps", "effects": [], "candidates": []}"#] {
            assert!(serde_json::from_str::<Said>(text).is_err(), "{text}");
        }
    }
}
