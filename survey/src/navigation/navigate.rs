//! From the columns of recordings to tracks on one grid.

use std::sync::Arc;

use super::error::NavigationError;
use super::fixes::{Degrees, fixes, is_place};
use super::jumps::ReceiverFault;
use super::layback::{behind, layback_m};
use super::lines::lines;
use super::options::{NavigationOptions, PositionOf};
use super::path::{Motion, Path};
use super::projection::{Grid, Projection};
use super::track::Track;
use crate::statistics::median;
use crate::tow::Tow;

/// Where all recordings were.
#[derive(Clone, Debug, Default)]
pub struct Navigation {
    /// The grid of eastings and northings; `None` where there are no positions.
    pub grid: Option<Grid>,
    /// In the order of the recordings.
    pub tows: Vec<Navigated>,
}

/// Where one recording was.
#[derive(Clone, Debug, Default)]
pub struct Navigated {
    /// The body's way; without positions but with speeds only how far it is, with neither `None`.
    pub track: Option<Track>,
    /// The line of each row; empty where there is none.
    pub line: Vec<Arc<str>>,
    /// Positions that were used: a receiver's own, not what a recorder repeats of them.
    pub fixes: usize,
    /// Positions that were not: zeros, not on Earth, far off their neighbours, or the same to the last digit for half a minute.
    pub dropped_fixes: usize,
    /// What the receiver did that no body can.
    pub receiver_faults: Vec<ReceiverFault>,
}

/// Speeds may lack in one row in so many; the last one known holds.
const ONE_IN: usize = 10;

/// Tracks and lines of recordings, on the grid of the middle of all positions.
///
/// # Errors
///
/// When the layback is to be computed and the recording does not hold what that needs.
pub fn navigate(tows: &[Tow], options: &NavigationOptions) -> Result<Navigation, NavigationError> {
    let grid = grid_of(tows);
    let projection = grid.and_then(|grid| grid.projection());
    let mut found = 0;
    let one = |tow: &Tow| -> Result<Navigated, NavigationError> {
        let mut navigated = Navigated::default();
        if let (Some(projection), Some(columns)) = (&projection, columns(tow)) {
            let fixes = fixes(&columns, options.lag_s, projection);
            (navigated.fixes, navigated.dropped_fixes) = (fixes.used, fixes.dropped);
            navigated.receiver_faults = fixes.faults;
            let motion = body(tow, &Path::through(&fixes.kept), options)?;
            navigated.track = motion.map(|motion| track(&tow.time_s, &motion, projection));
        }
        navigated.track = navigated.track.or_else(|| by_speed(tow));
        navigated.line = lines(tow, navigated.track.as_ref(), &mut found);
        Ok(navigated)
    };
    Ok(Navigation { grid, tows: tows.iter().map(one).collect::<Result<_, _>>()? })
}

fn columns(tow: &Tow) -> Option<Degrees<'_>> {
    let (latitude_deg, longitude_deg) = (tow.latitude_deg.as_ref()?, tow.longitude_deg.as_ref()?);
    Some(Degrees { time_s: &tow.time_s, latitude_deg, longitude_deg })
}

/// The zone of the middle position of all: medians, so that no outlier chooses it.
fn grid_of(tows: &[Tow]) -> Option<Grid> {
    let positions =
        || tows.iter().filter_map(columns).flat_map(|columns| columns.latitude_deg.iter().zip(columns.longitude_deg));
    let places = || positions().filter(|(latitude, longitude)| is_place(**latitude, **longitude));
    let latitude_deg = median(&mut places().map(|(latitude, _)| *latitude).collect::<Vec<_>>())?;
    let longitude_deg = median(&mut places().map(|(_, longitude)| *longitude).collect::<Vec<_>>())?;
    Grid::of(latitude_deg, longitude_deg)
}

/// The body's motion in each row, `None` where there is none at all.
fn body(tow: &Tow, path: &Path, options: &NavigationOptions) -> Result<Option<Vec<Option<Motion>>>, NavigationError> {
    let seen = path.at(&tow.time_s);
    let motion = match options.position {
        PositionOf::Body => seen,
        PositionOf::Ship { layback, tow_point_m } => {
            let behind_m: Vec<f64> = layback_m(tow, layback)?.iter().map(|layback| layback + tow_point_m).collect();
            behind(&tow.time_s, &seen, &behind_m)
        }
    };
    Ok(motion.iter().any(Option::is_some).then_some(motion))
}

fn track(time_s: &[f64], motion: &[Option<Motion>], projection: &Projection) -> Track {
    let mut track = Track::default();
    let (mut way_m, mut before) = (0.0, None);
    for (&time_s, motion) in time_s.iter().zip(motion) {
        if let Some(motion) = motion {
            way_m += before.replace((time_s, *motion)).map_or(0.0, |before| step_m(before, (time_s, *motion)));
        }
        let unknown = Motion { place_m: [f64::NAN; 2], velocity_m_per_s: [f64::NAN; 2], stretch: 0 };
        let Motion { place_m: [east, north], velocity_m_per_s: [to_east, to_north], .. } = motion.unwrap_or(unknown);
        let [latitude_deg, longitude_deg] = projection.geographic(east, north).unwrap_or([f64::NAN; 2]);
        track.easting_m.push(east);
        track.northing_m.push(north);
        track.along_m.push(if motion.is_some() { way_m } else { f64::NAN });
        track.speed_m_per_s.push(to_east.hypot(to_north));
        track.course_deg.push(to_east.atan2(to_north).to_degrees().rem_euclid(360.0));
        track.latitude_deg.push(latitude_deg);
        track.longitude_deg.push(longitude_deg);
    }
    track
}

/// A step of the receiver within this is no way of the body, s.
const AT_ONCE_S: f64 = 1.0;

/// The way from one row to the next.
fn step_m((from_s, from): (f64, Motion), (to_s, to): (f64, Motion)) -> f64 {
    let [east, north] = [0, 1].map(|axis| to.place_m[axis] - from.place_m[axis]);
    let speed = to.velocity_m_per_s[0].hypot(to.velocity_m_per_s[1]);
    if from.stretch != to.stretch && to_s - from_s <= AT_ONCE_S { speed * (to_s - from_s) } else { east.hypot(north) }
}

/// Only how far the body is: its speed is known, and not where it is.
fn by_speed(tow: &Tow) -> Option<Track> {
    let speeds = tow.speed_m_per_s.as_ref()?;
    let lacking = speeds.iter().filter(|speed| !speed.is_finite()).count();
    let mut speed = speeds.iter().copied().find(|speed| speed.is_finite())?;
    if lacking * ONE_IN > tow.len() {
        return None;
    }
    let none = vec![f64::NAN; tow.len()];
    let mut track = Track { along_m: none.clone(), speed_m_per_s: none.clone(), ..Track::default() };
    let (mut way_m, mut before_s) = (0.0, None);
    for (row, &time_s) in tow.time_s.iter().enumerate().filter(|(_, time_s)| time_s.is_finite()) {
        speed = if speeds[row].is_finite() { speeds[row].abs() } else { speed };
        way_m += before_s.replace(time_s).map_or(0.0, |before_s| speed * (time_s - before_s).max(0.0));
        (track.along_m[row], track.speed_m_per_s[row]) = (way_m, speed);
    }
    let unknown = [
        &mut track.easting_m,
        &mut track.northing_m,
        &mut track.course_deg,
        &mut track.latitude_deg,
        &mut track.longitude_deg,
    ];
    unknown.into_iter().for_each(|column| column.clone_from(&none));
    Some(track)
}
