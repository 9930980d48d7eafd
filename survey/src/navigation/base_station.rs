//! A base station's own file, brought to the rows of a recording.

use super::base_outliers::without_outliers;
use super::error::NavigationError;
use crate::tow::Tow;

/// The total field at a place that does not move.
#[derive(Clone, Debug, Default)]
pub struct BaseStation {
    /// Times, increasing.
    pub times: BaseTimes,
    /// Total field, nT; as many as times.
    pub field_nt: Vec<f64>,
}

/// By which clock a base station is joined to a recording.
#[derive(Clone, Debug)]
pub enum BaseTimes {
    /// Seconds since 1970-01-01 UTC: joined by `utc_s`.
    Utc(Vec<f64>),
    /// The recording's own time, s: joined by `time_s`.
    Recording(Vec<f64>),
}

impl Default for BaseTimes {
    fn default() -> Self {
        Self::Recording(Vec::new())
    }
}

/// A row is covered by a base station with readings no further apart than this, s: one missing of an observatory's minutes.
const LONGEST_STEP_S: f64 = 150.0;
/// Share of a recording's rows that a base station must cover.
const LEAST_COVERED: f64 = 0.9;

impl BaseStation {
    /// The base station without readings that are not the Earth's field (spikes, dummies, cars that pass it), and how many
    /// those were.
    pub fn without_outliers(self) -> (Self, usize) {
        let known = self.readings();
        let kept = without_outliers(known.clone());
        let left_out = known.len() - kept.len();
        let (times_s, field_nt): (Vec<f64>, Vec<f64>) = kept.into_iter().unzip();
        let times = match self.times {
            BaseTimes::Utc(_) => BaseTimes::Utc(times_s),
            BaseTimes::Recording(_) => BaseTimes::Recording(times_s),
        };
        (Self { times, field_nt }, left_out)
    }

    /// Time, s, by its own clock, and field, nT, where both are known.
    fn readings(&self) -> Vec<(f64, f64)> {
        let (BaseTimes::Utc(times_s) | BaseTimes::Recording(times_s)) = &self.times;
        let all = times_s.iter().copied().zip(self.field_nt.iter().copied());
        all.filter(|(s, nt)| s.is_finite() && nt.is_finite()).collect()
    }

    /// The longest time between the first and the last of readings that are the same, s.
    pub(crate) fn stood_s(&self) -> f64 {
        let readings = self.readings();
        let stands = readings.chunk_by(|a, b| a.1 == b.1).map(|same| same[same.len() - 1].0 - same[0].0);
        stands.fold(0.0, f64::max)
    }

    /// Its readings at the rows of a recording, as [`Tow::base_nt`] holds them: straight between readings, NaN where there
    /// are none.
    ///
    /// # Errors
    ///
    /// When the recording does not tell the time that they are joined by, or a tenth of it is not covered.
    pub fn join(&self, tow: &Tow) -> Result<Vec<f64>, NavigationError> {
        let row_s = match &self.times {
            BaseTimes::Recording(_) => &tow.time_s,
            BaseTimes::Utc(_) => {
                let no_utc = || NavigationError::NoUtc { recording: tow.name.clone() };
                tow.utc_s.as_ref().ok_or_else(no_utc)?
            }
        };
        let readings = self.readings();
        let joined: Vec<f64> = row_s.iter().map(|&time_s| at(&readings, time_s)).collect();
        let timed = row_s.iter().filter(|time_s| time_s.is_finite()).count();
        let covered = joined.iter().filter(|field| field.is_finite()).count() as f64 / timed.max(1) as f64;
        if covered < LEAST_COVERED {
            return Err(NavigationError::BaseTooShort {
                recording: tow.name.clone(),
                covered_percent: 100.0 * covered,
            });
        }
        Ok(joined)
    }
}

fn at(readings: &[(f64, f64)], time_s: f64) -> f64 {
    let next = readings.partition_point(|(reading_s, _)| *reading_s < time_s);
    let Some(&(to_s, to_nt)) = readings.get(next) else { return f64::NAN };
    if to_s == time_s {
        return to_nt;
    }
    match next.checked_sub(1).map(|before| readings[before]) {
        Some((from_s, from_nt)) if to_s - from_s <= LONGEST_STEP_S => {
            from_nt + (to_nt - from_nt) * (time_s - from_s) / (to_s - from_s)
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tow() -> Tow {
        let time_s: Vec<f64> = (0..1000).map(|row| f64::from(row) / 10.0).collect();
        let utc_s = Some(time_s.iter().map(|time_s| time_s + 1.7e9).collect());
        Tow { name: "rec.csv".into(), time_s, utc_s, ..Tow::default() }
    }

    #[test]
    fn it_is_joined_by_its_clock() {
        let minutes: Vec<f64> = (0..4).map(|minute| 60.0 * f64::from(minute) - 60.0).collect();
        let field_nt = vec![50_000.0, 50_006.0, 50_012.0, 50_000.0];
        let own = BaseStation { times: BaseTimes::Recording(minutes.clone()), field_nt: field_nt.clone() };
        let utc = minutes.iter().map(|time_s| time_s + 1.7e9).collect();
        let base = BaseStation { times: BaseTimes::Utc(utc), field_nt };
        for joined in [own.join(&tow()).unwrap(), base.join(&tow()).unwrap()] {
            for (row, field_nt) in [(0, 50_006.0), (300, 50_009.0), (600, 50_012.0), (900, 50_006.0)] {
                assert!((joined[row] - field_nt).abs() < 1e-6, "{row}: {}", joined[row]);
            }
        }
    }

    #[test]
    fn what_cannot_be_joined_is_refused() {
        let short = BaseStation { times: BaseTimes::Recording(vec![0.0, 60.0]), field_nt: vec![50_000.0; 2] };
        let said = short.join(&tow()).unwrap_err().to_string();
        assert_eq!(said, "rec.csv: the base station covers 60 % of its rows, at least 90 % are needed");
        let utc = BaseStation { times: BaseTimes::Utc(vec![0.0, 60.0]), field_nt: vec![50_000.0; 2] };
        let said = utc.join(&Tow { utc_s: None, ..tow() }).unwrap_err();
        assert_eq!(said, NavigationError::NoUtc { recording: "rec.csv".into() });
    }
}
