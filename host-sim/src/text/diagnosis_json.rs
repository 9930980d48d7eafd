//! `diagnosis.json`: the diagnosis with its sentences, in the order of the keys in which it is read.

use serde::Serialize;

use super::diagnosis::{consequence, sentence};
use super::manoeuvre;
use super::unexplained;
use crate::diagnosis::{
    CandidateShare, Cell, ChannelGap, ColumnMatch, Curve, Diagnosis, DriverForm, DriverShare, EffectFound, Gap,
    GapClosed, Map, RoundingFound, SessionReplay, TargetFound, Unexplained, Verdict,
};
use crate::provenance::Provenance;
use crate::recording::BadRows;
use crate::summary::to_json;

/// Version of the format.
const SCHEMA: u32 = 1;

/// The file that a proposed effect is written to.
pub const PROPOSED_EFFECT: &str = "proposed_effect.toml";

/// The file.
#[derive(Serialize)]
struct File<'a> {
    schema: u32,
    verdict: Verdict,
    summary: String,
    gap: &'a Gap,
    #[serde(rename = "where")]
    cells: &'a [Cell],
    effects: &'a [EffectFound],
    candidates: &'a [CandidateShare],
    next_manoeuvre: Option<Next<'a>>,
    targets: &'a [TargetFound],
    #[serde(skip_serializing_if = "Option::is_none")]
    unexplained: Option<Rest<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rounding: Option<&'a RoundingFound>,
    channels: &'a [ChannelGap],
    #[serde(skip_serializing_if = "Option::is_none")]
    consequence: Option<Meaning>,
    #[serde(skip_serializing_if = "Option::is_none")]
    simulation: Option<Simulation<'a>>,
    /// Whether the search ended with what it had.
    is_cut_short: bool,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    exact_replay: &'a [SessionReplay],
    #[serde(skip_serializing_if = "BadRows::is_empty")]
    bad_rows: &'a BadRows,
    #[serde(skip_serializing_if = "Option::is_none")]
    provenance: Option<&'a Provenance>,
}

/// What the gap means for whoever looks for iron.
#[derive(Serialize)]
struct Meaning {
    distance_m: f64,
    speed_m_per_s: f64,
    #[serde(rename = "smallest_moment_Am2")]
    smallest_am2: Three,
    place_m: Three,
    text: String,
}

#[derive(Serialize)]
struct Three {
    noise: f64,
    with_gap: f64,
    with_effects: f64,
}

impl From<[f64; 3]> for Three {
    fn from([noise, with_gap, with_effects]: [f64; 3]) -> Self {
        Self { noise, with_gap, with_effects }
    }
}

/// The simulation of the user's own that it was held against.
#[derive(Serialize)]
struct Simulation<'a> {
    file: &'a str,
    offset_s: f64,
    track_explained: f64,
    rate_hz: f64,
    terms: &'a str,
    #[serde(rename = "beyond_nT")]
    beyond_nt: Option<f64>,
}

#[derive(Serialize)]
struct Next<'a> {
    separates: &'a [&'static str],
    text: String,
    minutes: f64,
}

/// What is left without a name.
#[derive(Serialize)]
struct Rest<'a> {
    drivers: &'a [DriverShare],
    form: Option<DriverForm>,
    delay_s: Option<f64>,
    gap_closed: Option<GapClosed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    confirmed: Option<GapClosed>,
    effect_file: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    looks_like: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    matched: Option<&'a ColumnMatch>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<&'a Curve>,
    #[serde(skip_serializing_if = "Option::is_none")]
    map: Option<&'a Map>,
    text: String,
    tests: &'a [Unexplained],
}

/// None where nothing is left.
fn rest(diagnosis: &Diagnosis) -> Option<Rest<'_>> {
    let tests = &diagnosis.unexplained[..];
    let Some(found) = &diagnosis.description else {
        return (!tests.is_empty()).then(|| Rest {
            drivers: &[],
            form: None,
            delay_s: None,
            gap_closed: None,
            confirmed: None,
            effect_file: None,
            looks_like: None,
            matched: None,
            curve: None,
            map: None,
            text: unexplained::small(),
            tests,
        });
    };
    Some(Rest {
        drivers: &found.drivers,
        form: found.form,
        delay_s: found.delay_s,
        gap_closed: found.gap_closed,
        confirmed: found.confirmed,
        effect_file: found.effect_file.is_some().then_some(PROPOSED_EFFECT),
        looks_like: found.looks_like,
        matched: found.matched.as_ref(),
        curve: found.curve.as_ref(),
        map: found.map.as_ref(),
        text: unexplained::text(found),
        tests,
    })
}

/// The text of the file, with a newline at its end.
pub fn json(diagnosis: &Diagnosis) -> String {
    to_json(&File {
        schema: SCHEMA,
        verdict: diagnosis.verdict,
        summary: sentence(diagnosis),
        gap: &diagnosis.gap,
        cells: &diagnosis.cells,
        effects: &diagnosis.effects,
        candidates: &diagnosis.candidates,
        next_manoeuvre: diagnosis.next_manoeuvre.as_ref().map(|next| Next {
            separates: &next.separates,
            text: manoeuvre::next(next),
            minutes: next.minutes,
        }),
        targets: &diagnosis.targets,
        unexplained: rest(diagnosis),
        rounding: diagnosis.rounding.as_ref(),
        channels: &diagnosis.channels,
        consequence: diagnosis.consequence.as_ref().map(|meaning| Meaning {
            distance_m: meaning.distance_m,
            speed_m_per_s: meaning.speed_m_per_s,
            smallest_am2: meaning.smallest_moment_Am2.into(),
            place_m: meaning.place_m.into(),
            text: consequence(diagnosis, meaning),
        }),
        simulation: diagnosis.simulation.as_ref().map(|used| Simulation {
            file: &used.file,
            offset_s: used.offset_s,
            track_explained: used.track_explained,
            rate_hz: used.rate_hz,
            terms: if used.holds_terms { "held" } else { "refitted" },
            beyond_nt: used.beyond_nt,
        }),
        is_cut_short: diagnosis.is_cut_short,
        exact_replay: &diagnosis.exact_replay,
        bad_rows: &diagnosis.bad_rows,
        provenance: diagnosis.provenance.as_ref(),
    })
}
