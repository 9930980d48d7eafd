//! What a survey gives: for each recording the field at its level, and for all of them the contacts.

use std::sync::Arc;

use crate::navigation::{Faults, Grid, ReceiverFault, Track};
use crate::second::SecondScalar;

/// Everything that a survey says.
#[derive(Clone, Debug)]
pub struct Survey {
    /// One entry a recording, in the order given.
    pub tows: Vec<SurveyedTow>,
    /// The contacts of all recordings, the largest signal to noise first.
    pub contacts: Vec<Contact>,
    /// False contacts an hour that the threshold stands for.
    pub false_alarms_per_hour: f64,
    /// Standard deviation of `anomaly_nt` from row to row in the band 0.1 to 0.9 Hz beside the contacts, median over time, nT.
    pub noise_floor_nt: f64,
    /// Median along the track of the smallest moment that is found with a probability of 0.9, A m^2; `None` without a track.
    pub smallest_moment_am2: Option<f64>,
    /// Coefficients in the units of eq. (4), the mean over all rows.
    pub coefficients: [f64; 18],
    /// Their standard deviations.
    pub coefficient_std: [f64; 18],
    /// The grid of all eastings and northings; `None` without positions.
    pub grid: Option<Grid>,
}

/// A recording after the survey; a value a row each, NaN where a row is not valid.
#[derive(Clone, Debug, Default)]
pub struct SurveyedTow {
    /// How the user named the recording.
    pub name: String,
    /// Time, s, as recorded.
    pub time_s: Vec<f64>,
    /// Rows whose field is known.
    pub is_valid: Vec<bool>,
    /// Compensated total field at its level, nT.
    pub field_nt: Vec<f64>,
    /// Its standard deviation, of the level too, nT.
    pub field_std_nt: Vec<f64>,
    /// The field less the background slower than 100 s, targets untouched, nT.
    pub anomaly_nt: Vec<f64>,
    /// Its standard deviation, nT.
    pub anomaly_std_nt: Vec<f64>,
    /// Where the body was, if that is known.
    pub track: Option<Track>,
    /// Line of each row; empty where there is none.
    pub line: Vec<Arc<str>>,
    /// Height above the bottom, m, where it is known.
    pub altitude_m: Option<Vec<f64>>,
    /// The smallest moment below the track that is found with a probability of 0.9, A m^2; empty without a track.
    pub smallest_moment_am2: Vec<f64>,
    /// Positions that were used: a receiver's own, not what a recorder repeats of them.
    pub fixes: usize,
    /// Positions that were not used: zeros, not on Earth, far off their neighbours, or the same to the last digit for half a minute.
    pub dropped_fixes: usize,
    /// What the receiver did that no body can.
    pub receiver_faults: Vec<ReceiverFault>,
    /// What its base station told; `None` without one.
    pub base: Option<Base>,
    /// What a second scalar sensor adds, where all recordings have one.
    pub second: Option<SecondScalar>,
}

/// A base station, as far as a recording can judge it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Base {
    /// Whether the field's change with the day was taken away.
    pub is_taken_off: bool,
    /// What is wrong with its readings.
    pub faults: Faults,
    /// The share of its changes that the recording's field shows; `None` where nothing can be said.
    pub share: Option<Estimate>,
}

/// A value and the interval that holds the truth in 95 of 100 cases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// An object that one or several passes saw. All but `passes` is of the pass with the largest signal to noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Number, from 1 on, by signal to noise.
    pub number: usize,
    /// How many lines saw it.
    pub passes: usize,
    /// Index of the recording of the best pass.
    pub tow: usize,
    /// Closest approach, s, in that recording's time.
    pub time_s: f64,
    /// Survey line of the best pass; empty where there is none.
    pub line: Arc<str>,
    /// Where it is, as estimated; abeam on the track where the side is not known. `None` without a track.
    pub place: Option<Place>,
    /// Largest of the anomaly by size, with its sign, nT.
    pub peak_nt: f64,
    /// Between the half heights of the largest lobe, s.
    pub width_s: f64,
    /// Matched, with the measured noise spectrum.
    pub snr: f64,
    /// That it is no target.
    pub false_alarm_probability: f64,
    /// Closest distance to the sensor, m; `None` where no speed is known.
    pub distance_m: Option<Estimate>,
    /// Magnetic moment, A m^2; `None` where no speed is known.
    pub moment_am2: Option<Estimate>,
    /// The fitted anomaly around it: time, s, and nT.
    pub fit: Vec<(f64, f64)>,
}

/// Where a contact is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// WGS 84, degrees.
    pub latitude_deg: f64,
    /// WGS 84, degrees.
    pub longitude_deg: f64,
    /// Local, m.
    pub easting_m: f64,
    /// Local, m.
    pub northing_m: f64,
}
