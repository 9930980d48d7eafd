//! The variables of a recording, as effect files name them.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::diagnosis::numerics::median;
use crate::diagnosis::reconstruct::prepared::{Prepared, is_beside};
use crate::simulator::signals::Signals;

/// Courses over the rows, by name.
pub(crate) struct Scene {
    courses: BTreeMap<String, Vec<f64>>,
    segments: Vec<Range<usize>>,
    rows: usize,
    /// Recorded columns that are neither a sensor's nor depth and temperature.
    pub(crate) columns: Vec<String>,
}

impl Scene {
    /// Of the clean signals of a channel, and the columns that were recorded beside them.
    pub(crate) fn of(signals: &Signals, table: &Prepared) -> Self {
        let rows = signals.rows();
        let axis = |vectors: &[[f64; 3]], k: usize| vectors.iter().map(|v| v[k]).collect::<Vec<f64>>();
        let mut courses: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for (k, letter) in ["x", "y", "z"].into_iter().enumerate() {
            courses.insert(format!("c{letter}"), axis(&rows.direction, k));
            courses.insert(format!("dc{letter}"), axis(&rows.direction_rate, k));
            courses.insert(format!("f{letter}"), axis(&rows.flux_nt, k));
        }
        courses.insert("F".into(), rows.field_nt.clone());
        courses.insert("s".into(), signals.scalar_at_rows_nt().to_vec());
        courses.insert("t".into(), signals.epochs_s().to_vec());
        let trajectory = signals.trajectory();
        courses.extend(trajectory.depth_m.iter().map(|depth_m| ("depth".into(), depth_m.clone())));
        courses.extend(trajectory.temperature_deg_c.iter().map(|deg_c| ("temperature".into(), deg_c.clone())));
        let currents = trajectory.currents_a.iter().map(|(load, a)| (format!("current_{load}_A"), a.clone()));
        let mut others: Vec<(String, Vec<f64>)> = currents.collect();
        for column in table.columns.iter().filter(|(name, _)| is_beside(name)) {
            if others.iter().all(|(known, _)| *known != column.0) {
                others.push(column.clone());
            }
        }
        let columns = others.iter().map(|(name, _)| name.clone()).collect();
        courses.extend(others);
        courses.extend(table.tilt_deg.iter().map(|(name, deg)| ((*name).into(), deg.clone())));
        courses.extend(table.heading_deg.iter().map(|deg| ("heading_deg".into(), deg.clone())));
        let segments = signals.segments().iter().map(|segment| segment.epochs.clone()).collect();
        Self { courses, segments, rows: signals.len(), columns }
    }

    /// Of courses that are known.
    #[cfg(test)]
    pub(crate) fn with<const N: usize>(courses: [(&str, Vec<f64>); N], segments: Vec<Range<usize>>) -> Self {
        let rows = segments.last().map_or(0, |last| last.end);
        let courses = courses.into_iter().map(|(name, course)| (name.to_string(), course)).collect();
        Self { courses, segments, rows, columns: Vec::new() }
    }

    /// A variable, one value a row.
    pub(crate) fn variable(&self, name: &str) -> Option<&[f64]> {
        self.courses.get(name).map(Vec::as_slice)
    }

    /// Rows without gaps between them.
    pub(crate) fn segments(&self) -> &[Range<usize>] {
        &self.segments
    }

    /// How many rows.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }
}

/// Middle and spread of a course: the median, and the rms about it of the inner nine tenths.
pub(crate) fn middle_and_width(values: &[f64]) -> (f64, f64) {
    let middle = median(values.to_vec());
    let mut away: Vec<f64> = values.iter().map(|x| (x - middle).powi(2)).collect();
    away.sort_unstable_by(f64::total_cmp);
    let inner = &away[..(away.len() * 9 / 10).max(1)];
    let rms = (inner.iter().sum::<f64>() / inner.len() as f64).sqrt();
    (middle, rms)
}

/// Some quantiles of a course, evenly spread, without those that come twice.
pub(crate) fn knots(values: &[f64], count: usize) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let mut knots: Vec<f64> = (1..=count).map(|k| sorted[k * (sorted.len() - 1) / (count + 1)]).collect();
    knots.dedup();
    knots
}
