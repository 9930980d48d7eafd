//! What goes to a page, as JSON.

use serde::Serialize;

use crate::alarm::Alarm;
use crate::history::{Cell, Tier, Track, TrackPoint};
use crate::lamp::Lamps;
use crate::notice::{Contact, Mark};
use crate::sample::{SERIES, SERIES_NAMES, Sample};

/// One message.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum Message<'a> {
    /// To a new viewer: all but the history, which it asks for.
    Hello(Hello<'a>),
    Epochs(Epochs<'a>),
    History(HistoryCells<'a>),
    Lamps {
        lamps: &'a Lamps,
    },
    Alarms {
        alarms: &'a [Alarm],
    },
    Mark {
        mark: &'a Mark,
    },
    Contact {
        contact: &'a Contact,
    },
    Text {
        text: &'a str,
    },
    /// To a viewer that was too slow: it has missed so many messages, and should ask for the history.
    Lost {
        messages: u64,
    },
    /// To one viewer: why what it wants is not done.
    Refused {
        text: &'a str,
    },
    /// There is no more to come.
    End,
}

impl Message<'_> {
    /// As it goes over the wire.
    pub(crate) fn json(&self) -> String {
        // Numbers, texts and lists of them: nothing here can fail, and an empty message would be none to a page.
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// What a viewer is told first.
#[derive(Debug, Serialize)]
pub(crate) struct Hello<'a> {
    /// Another one after each start of the server.
    pub(crate) session: &'a str,
    pub(crate) title: &'a str,
    pub(crate) version: &'static str,
    pub(crate) is_live: bool,
    pub(crate) is_over: bool,
    pub(crate) may_mark: bool,
    pub(crate) may_command: bool,
    pub(crate) lowest_altitude_m: f64,
    pub(crate) now_s: Option<f64>,
    pub(crate) lamps: &'a Lamps,
    pub(crate) alarms: &'a [Alarm],
    pub(crate) marks: Vec<&'a Mark>,
    pub(crate) contacts: Vec<&'a Contact>,
    pub(crate) texts: Vec<&'a str>,
}

/// New epochs.
#[derive(Debug, Serialize)]
pub(crate) struct Epochs<'a> {
    pub(crate) rows: &'a [Row],
    /// Updates that the server itself was too slow for, since its start.
    pub(crate) lost: u64,
}

/// An epoch: its place on the strip, the sender's stamp, all series, latitude, longitude, battery, when it was read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Row(f64, Option<f64>, [Option<f64>; SERIES], Option<[f64; 2]>, Option<f64>, Option<f64>);

impl Row {
    pub(crate) fn new(sample: &Sample) -> Self {
        let Sample { time_s, sent_s, heard_s, battery_v, .. } = *sample;
        Self(
            time_s,
            sent_s,
            sample.series().map(|value| value.map(rounded)),
            sample.place_deg(),
            battery_v.map(rounded),
            heard_s.map(rounded),
        )
    }
}

/// A hundredth of a picotesla less is nothing that anybody can see, and takes room on the wire.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// What was, for one window.
#[derive(Debug, Serialize)]
pub(crate) struct HistoryCells<'a> {
    pub(crate) window_s: f64,
    pub(crate) cell_s: f64,
    /// As it was asked for: what is later is in here.
    pub(crate) since_s: Option<f64>,
    series: [&'static str; SERIES],
    time_s: Vec<f64>,
    low: Vec<[Option<f64>; SERIES]>,
    high: Vec<[Option<f64>; SERIES]>,
    track: &'a [TrackPoint],
}

impl<'a> HistoryCells<'a> {
    /// The cells of a tier, and the track, after a time.
    pub(crate) fn new(window_s: f64, since_s: Option<f64>, tier: &Tier, track: &'a Track) -> Self {
        let after_s = since_s.unwrap_or(f64::NEG_INFINITY);
        let cells: Vec<&Cell> = tier.cells_since(after_s).collect();
        let all = |which: usize| {
            let of =
                |cell: &&Cell| std::array::from_fn(|place| cell.bounds(place).map(|bounds| rounded(bounds[which])));
            cells.iter().map(of).collect()
        };
        Self {
            window_s,
            cell_s: tier.cell_s(),
            since_s,
            series: SERIES_NAMES,
            time_s: cells.iter().map(|cell| cell.time_s).collect(),
            low: all(0),
            high: all(1),
            track: track.points_since(after_s),
        }
    }
}
