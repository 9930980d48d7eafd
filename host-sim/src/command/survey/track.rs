//! `track.geojson`: where the body was, a line a leg, and the anomaly in points along it.

use std::ops::Range;

use geojson::{Feature, Geometry};
use towmag_export::cut_at_the_antimeridian;
use towmag_survey::navigation::Track;
use towmag_survey::{Survey, SurveyedTow};

use super::digits::rounded;
use super::geojson::{feature, place, text};
use super::levelled::RECORDING;
use crate::error::HostError;
use crate::output::OutputDir;

/// A longer step between rows ends a stretch, s: the track bridges as much.
const LONGEST_STEP_S: f64 = 10.0;
/// A point, and a corner of a line, every so many seconds.
const EVERY_S: f64 = 1.0;
/// Significant digits of an anomaly: a thousandth of a nanotesla of one of 1,000 nT.
const DIGITS: usize = 7;

/// Write it: without positions a file without features.
pub(super) fn write(output: &OutputDir, survey: &Survey) -> Result<(), HostError> {
    let is_several = survey.tows.len() > 1;
    let mut features = Vec::new();
    for tow in &survey.tows {
        let Some(track) = &tow.track else { continue };
        for stretch in stretches(tow, track) {
            features.push(course(tow, track, &stretch, is_several));
            features.extend(seconds(tow, &stretch).filter_map(|row| point(tow, track, row, is_several)));
        }
    }
    Ok(output.write("track.geojson", text(features))?)
}

/// Rows one after the other with a place, on the same line, without a gap.
fn stretches(tow: &SurveyedTow, track: &Track) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for row in (0..tow.time_s.len()).filter(|&row| track.longitude_deg[row].is_finite()) {
        match stretches.last_mut() {
            Some(last)
                if tow.line[row] == tow.line[last.start]
                    && tow.time_s[row] - tow.time_s[last.end - 1] <= LONGEST_STEP_S =>
            {
                last.end = row + 1;
            }
            _ => stretches.push(row..row + 1),
        }
    }
    stretches
}

fn course(tow: &SurveyedTow, track: &Track, rows: &Range<usize>, is_several: bool) -> Feature {
    let last = rows.end - 1;
    let mut due_s = f64::NEG_INFINITY;
    let corners = rows.clone().filter(|&row| {
        let is_corner = row == last || tow.time_s[row] >= due_s;
        if is_corner {
            due_s = tow.time_s[row] + EVERY_S;
        }
        is_corner
    });
    let places: Vec<[f64; 2]> =
        corners.filter_map(|row| place(track.longitude_deg[row], track.latitude_deg[row])).collect();
    let geometry = match places.as_slice() {
        [only] => Geometry::new_point(*only),
        places => match cut_at_the_antimeridian(places).as_slice() {
            [one] => Geometry::new_line_string(one.iter().copied()),
            parts => Geometry::new_multi_line_string(parts.iter().map(|part| part.iter().copied())),
        },
    };
    let mut properties = of(tow, rows.start, is_several);
    properties.extend([
        ("start_time_s", tow.time_s[rows.start].into()),
        ("end_time_s", tow.time_s[last].into()),
        ("rows", rows.len().into()),
    ]);
    feature(Some(geometry), properties)
}

/// Of each second the row whose anomaly is the largest: a peak is not lost between two points.
fn seconds(tow: &SurveyedTow, rows: &Range<usize>) -> impl Iterator<Item = usize> {
    let mut points: Vec<usize> = Vec::new();
    let mut until_s = f64::NEG_INFINITY;
    for row in rows.clone().filter(|&row| tow.is_valid[row]) {
        let size_nt = |row: usize| tow.anomaly_nt[row].abs();
        match points.last_mut() {
            Some(point) if tow.time_s[row] < until_s => {
                if size_nt(row) > size_nt(*point) {
                    *point = row;
                }
            }
            _ => {
                points.push(row);
                until_s = tow.time_s[row] + EVERY_S;
            }
        }
    }
    points.into_iter()
}

fn point(tow: &SurveyedTow, track: &Track, row: usize, is_several: bool) -> Option<Feature> {
    let there = place(track.longitude_deg[row], track.latitude_deg[row])?;
    let mut properties = of(tow, row, is_several);
    properties.extend([
        ("time_s", tow.time_s[row].into()),
        ("anomaly_nT", rounded(tow.anomaly_nt[row], DIGITS).into()),
        ("field_nT", rounded(tow.field_nt[row], DIGITS + 1).into()),
    ]);
    Some(feature(Some(Geometry::new_point(there)), properties))
}

fn of(tow: &SurveyedTow, row: usize, is_several: bool) -> Vec<(&'static str, serde_json::Value)> {
    let recording = is_several.then(|| (RECORDING, tow.name.as_str().into()));
    recording.into_iter().chain([("line", (*tow.line[row]).into())]).collect()
}
