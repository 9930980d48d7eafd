//! A contact's profile: what was measured around it, and the dipole that was fitted.

use towmag_survey::{Contact, Survey, SurveyedTow};

use crate::report::svg::{Axis, Line, Plot, path};

/// Half the window where there is no fit, in widths of the lobe, and at least so many seconds.
const WIDTHS: f64 = 5.0;
const LEAST_S: f64 = 5.0;

/// How much of the fit's window is shown on either side of it, so that the background is seen.
const BESIDE: f64 = 0.25;

/// A line breaks where no value follows for this long, s.
const GAP_S: f64 = 0.35;

/// Points across a card.
const COLUMNS: usize = 300;

/// What the profiles are drawn over.
pub(super) fn note(survey: &Survey) -> &'static str {
    match survey.tows.iter().any(|tow| tow.track.is_some()) {
        true => "Over the way along the track, m, from the closest approach.",
        false => "Over time, s, from the closest approach.",
    }
}

/// Of `contact` on `tow`; `None` where the recording has nothing there.
pub(super) fn profile(contact: &Contact, tow: &SurveyedTow) -> Option<Plot> {
    let (low_s, high_s) = window_s(contact);
    let rows: Vec<usize> = (0..tow.time_s.len()).filter(|&row| (low_s..=high_s).contains(&tow.time_s[row])).collect();
    let way = Way::new(contact, tow, &rows);
    let measured: Vec<(f64, f64)> = rows.iter().map(|&row| (way.of(tow.time_s[row]), tow.anomaly_nt[row])).collect();
    let fit: Vec<(f64, f64)> = contact.fit.iter().map(|&(time_s, nt)| (way.of(time_s), nt)).collect();
    let x = Axis::numbers(way.of(low_s), way.of(high_s), way.unit(), 6);
    let y = Axis::around(measured.iter().chain(&fit).map(|point| point.1), "nT", 4)?;
    let gap = GAP_S * (x.high - x.low) / (high_s - low_s).max(f64::MIN_POSITIVE);
    let line = |name, class, points: Vec<(f64, f64)>, gap| Line {
        name,
        class,
        d: path(points.into_iter(), gap, [&x, &y], COLUMNS),
    };
    let lines = vec![line("fit", "fit", fit, f64::INFINITY), line("measured", "anomaly", measured, gap)];
    let label = format!("Profile of contact {}: anomaly and fit", contact.number);
    let title = if way.is_metres() { "nT over m" } else { "nT over s" };
    Some(Plot { label, title, class: "profile", x, y, lines, marks: Vec::new() })
}

fn window_s(contact: &Contact) -> (f64, f64) {
    let span = contact.fit.first().zip(contact.fit.last()).map(|(first, last)| (first.0, last.0));
    let half_s = (WIDTHS * contact.width_s).max(LEAST_S);
    let (low_s, high_s) = span.filter(|(a, b)| b > a).unwrap_or((contact.time_s - half_s, contact.time_s + half_s));
    let more_s = BESIDE * (high_s - low_s);
    (low_s - more_s, high_s + more_s)
}

/// From time to what is across the chart: metres along the track where all of them are known, else seconds.
struct Way {
    at_s: f64,
    /// Time, s, and way, m.
    along: Vec<(f64, f64)>,
    at_m: f64,
}

impl Way {
    fn new(contact: &Contact, tow: &SurveyedTow, rows: &[usize]) -> Self {
        let along_m = tow.track.iter().flat_map(|track| rows.iter().map(|&row| (tow.time_s[row], track.along_m[row])));
        let mut along: Vec<(f64, f64)> = along_m.filter(|(_, m)| m.is_finite()).collect();
        // A body that stands still, or a window without a track, is shown over time.
        if along.len() < 2 || along.len() < rows.len() / 2 || along[along.len() - 1].1 <= along[0].1 {
            along.clear();
        }
        let mut way = Self { at_s: contact.time_s, along, at_m: 0.0 };
        way.at_m = way.interpolated(contact.time_s);
        way
    }

    fn is_metres(&self) -> bool {
        !self.along.is_empty()
    }

    fn unit(&self) -> &'static str {
        if self.is_metres() { "m" } else { "s" }
    }

    fn of(&self, time_s: f64) -> f64 {
        if self.is_metres() { self.interpolated(time_s) - self.at_m } else { time_s - self.at_s }
    }

    /// Linear between rows, and beyond the ends at the mean speed.
    fn interpolated(&self, time_s: f64) -> f64 {
        let (Some(&first), Some(&last)) = (self.along.first(), self.along.last()) else { return 0.0 };
        let after = self.along.partition_point(|(at, _)| *at < time_s);
        let (from, to) = match after {
            after if after > 0 && after < self.along.len() => (self.along[after - 1], self.along[after]),
            _ => (first, last),
        };
        let base = if after == 0 { first } else { from };
        base.1 + (to.1 - from.1) / (to.0 - from.0) * (time_s - base.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn way_is_linear_between_rows_and_goes_on_beyond() {
        let way = Way { at_s: 11.0, along: vec![(10.0, 100.0), (11.0, 102.0), (12.0, 106.0)], at_m: 102.0 };
        assert_eq!([9.0, 10.5, 11.5, 13.0].map(|s| way.of(s)), [-5.0, -1.0, 2.0, 7.0]);
        let still = Way { at_s: 11.0, along: vec![], at_m: 0.0 };
        assert_eq!(still.of(12.5), 1.5);
    }
}
