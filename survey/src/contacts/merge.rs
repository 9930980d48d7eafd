//! Passes of one object made one contact, and the side where it lies.

use crate::contacts::pass::Pass;
use crate::contacts::triangulation::{Object, View, either_side};
use crate::navigation::Grid;
use crate::result::{Contact, Place, SurveyedTow};
use crate::statistics::{NORMAL_MEDIAN, median};

/// Standard deviation of a position of the body, m, before anything tells it: satellite navigation and layback.
const POSITION_M: f64 = 1.5;
/// It is never better than this: courses are not headings, and a pass is not straight.
const LEAST_POSITION_M: f64 = 0.2;
/// Courses are along each other from this cosine of the angle between them on; one is another below the next.
const PARALLEL: f64 = 0.97;
const OTHER_COURSE: f64 = 0.5;
/// What a further pass of the same object may add to the sum of squares: twice the 15.1 of 0.99 of cases of the five numbers that it
/// tells, as a pass with other iron beside it is off by more than it says.
const MOST_A_PASS: f64 = 30.0;
/// Beyond this difference of the sum of squares the other side is ruled out: 0.95 of cases.
const OTHER_SIDE: f64 = 3.84;
/// An object nearer to the track than this, m, is below it: where that is the best of a side, there is no place of its own on it.
const BELOW_M: f64 = 0.1;
/// Passes of one recording nearer than this in time, s, and in widths, on one course, are not of one object: it was there once.
const APART_S: f64 = 30.0;
const APART_WIDTHS: f64 = 10.0;
/// Passes further apart along either course than this, in standard deviations of a position, are not looked at together.
const FURTHEST_STD: f64 = 5.0;

/// A pass where it was.
#[derive(Clone, Copy)]
struct Seen<'a> {
    tow: usize,
    pass: &'a Pass,
    /// `None` without a track.
    view: Option<View<'a>>,
}

/// The contacts of all recordings, whose tracks are on this grid, the largest signal to noise first, numbered from 1.
pub fn merge(tows: &[(&SurveyedTow, &[Pass])], grid: Option<Grid>) -> Vec<Contact> {
    let mut all: Vec<Seen<'_>> = Vec::new();
    for (index, (tow, passes)) in tows.iter().enumerate() {
        all.extend(passes.iter().map(|pass| Seen { tow: index, pass, view: view(tow, pass) }));
    }
    all.sort_by(|a, b| b.pass.snr.total_cmp(&a.pass.snr));
    let position_m = position_m(&joined(&all, POSITION_M));
    let objects = joined(&all, position_m);
    objects.iter().enumerate().map(|(k, object)| contact(k + 1, object, tows, (position_m, grid))).collect()
}

/// Passes of one object together, the strongest first.
fn joined<'a>(all: &[Seen<'a>], position_m: f64) -> Vec<Vec<Seen<'a>>> {
    let mut objects: Vec<Vec<Seen<'_>>> = Vec::new();
    for seen in all {
        let with = |object: &Vec<Seen<'_>>| {
            let joined: Vec<Seen<'_>> = object.iter().chain([seen]).copied().collect();
            let sides = can_join(object, seen).then(|| sides(&joined, position_m)).flatten()?;
            let squares = sides.map(|side| side.squares).into_iter().fold(f64::INFINITY, f64::min);
            (squares < MOST_A_PASS * object.len() as f64).then_some(squares)
        };
        let fits = objects.iter().enumerate().filter_map(|(k, object)| Some((k, with(object)?)));
        match fits.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((k, _)) => objects[k].push(*seen),
            None => objects.push(vec![*seen]),
        }
    }
    objects
}

/// How well positions agree, by the closest approaches of passes of one object on lines along each other. Nothing else is in that: neither
/// the side nor the distance. What was expected counts as one such pair.
fn position_m(objects: &[Vec<Seen<'_>>]) -> f64 {
    let apart_m = |(first, other): (&View<'_>, &View<'_>)| {
        let off_m2 = first.ahead_starboard_m(other.place_m)[0].powi(2);
        let known_m2 = first.told.covariance[(0, 0)] + other.told.covariance[(0, 0)];
        (first.along(other).abs() >= PARALLEL).then(|| (off_m2 - known_m2).max(0.0).sqrt())
    };
    let of_object = |object: &Vec<Seen<'_>>| {
        let views: Vec<View<'_>> = object.iter().filter_map(|seen| seen.view).collect();
        let pairs = views.iter().skip(1).filter_map(|other| apart_m((&views[0], other)));
        pairs.collect::<Vec<_>>()
    };
    let mut apart: Vec<f64> = objects.iter().flat_map(of_object).collect();
    let pairs = apart.len() as f64;
    let told_m2 = median(&mut apart).map_or(0.0, |m| (m / NORMAL_MEDIAN).powi(2) / 2.0);
    ((POSITION_M * POSITION_M + pairs * told_m2) / (1.0 + pairs)).sqrt().max(LEAST_POSITION_M)
}

fn view<'a>(tow: &SurveyedTow, pass: &'a Pass) -> Option<View<'a>> {
    let (track, told) = (tow.track.as_ref()?, pass.told.as_ref()?);
    let (sin, cos) = track.course_deg[pass.row].to_radians().sin_cos();
    // Between the rows: the way from the row to the closest approach.
    let on_m = told.mean[0] - pass.way[pass.row - pass.rows.start];
    let place_m = [track.easting_m[pass.row] + on_m * sin, track.northing_m[pass.row] + on_m * cos];
    let altitude_m = tow.altitude_m.as_ref().map(|altitude_m| altitude_m[pass.row]).filter(|m| m.is_finite());
    let is_known = place_m.iter().all(|m| m.is_finite());
    is_known.then_some(View { told, place_m, course: [sin, cos], altitude_m })
}

fn can_join(object: &[Seen<'_>], seen: &Seen<'_>) -> bool {
    object.iter().all(|other| {
        let apart_s = (other.pass.time_s - seen.pass.time_s).abs();
        let Some((a, b)) = seen.view.zip(other.view) else { return false };
        let is_other_pass = other.tow != seen.tow
            || a.along(&b) < OTHER_COURSE
            || apart_s > APART_S.max(APART_WIDTHS * other.pass.width_s.max(seen.pass.width_s));
        is_other_pass && may_meet(&a, &b) && may_meet(&b, &a)
    })
}

/// Whether an object of another pass may be abeam of this one: a first look.
fn may_meet(view: &View<'_>, other: &View<'_>) -> bool {
    let [ahead_m, _] = view.ahead_starboard_m(other.place_m);
    let cos = view.along(other);
    let beside_m = (1.0 - cos * cos).max(0.0).sqrt() * other.told.mean[1].exp();
    ahead_m.abs() < beside_m + FURTHEST_STD * POSITION_M
}

/// The object to port, and to starboard, of the first pass.
fn sides(object: &[Seen<'_>], position_m: f64) -> Option<[Object; 2]> {
    let views: Option<Vec<View<'_>>> = object.iter().map(|seen| seen.view).collect();
    Some(either_side(&views?, position_m))
}

/// How far to starboard of its best pass an object lies, m; 0 where it may be on either side. Along the track it is where that pass was
/// closest: others know less of that.
fn starboard_m(object: &[Seen<'_>], position_m: f64) -> f64 {
    let sides = if object.len() > 1 { sides(object, position_m) } else { None };
    let Some([port, starboard]) = sides else { return 0.0 };
    let (better, worse) = if port.squares < starboard.squares { (port, starboard) } else { (starboard, port) };
    let is_none = worse.starboard_m.abs() < BELOW_M;
    if is_none || worse.squares > better.squares + OTHER_SIDE { better.starboard_m } else { 0.0 }
}

fn contact(
    number: usize,
    object: &[Seen<'_>],
    tows: &[(&SurveyedTow, &[Pass])],
    (position_m, grid): (f64, Option<Grid>),
) -> Contact {
    let Seen { tow: index, pass, view } = object[0];
    let tow = tows[index].0;
    let place =
        view.zip(grid).and_then(|(view, grid)| place(grid, view.place_at([0.0, starboard_m(object, position_m)])));
    let times = pass.rows.clone().map(|row| tow.time_s[row]);
    Contact {
        number,
        passes: object.len(),
        tow: index,
        time_s: pass.time_s,
        line: tow.line.get(pass.row).cloned().unwrap_or_default(),
        place,
        peak_nt: pass.peak_nt,
        width_s: pass.width_s,
        snr: pass.snr,
        false_alarm_probability: object.iter().map(|seen| seen.pass.false_alarm_probability).product(),
        distance_m: pass.is_metres.then_some(pass.distance),
        moment_am2: pass.moment_am2,
        fit: times.zip(pass.anomaly_nt.iter().copied()).filter(|(time_s, _)| time_s.is_finite()).collect(),
    }
}

/// A place on the grid.
fn place(grid: Grid, [easting_m, northing_m]: [f64; 2]) -> Option<Place> {
    let [latitude_deg, longitude_deg] = grid.geographic(easting_m, northing_m)?;
    Some(Place { latitude_deg, longitude_deg, easting_m, northing_m })
}
