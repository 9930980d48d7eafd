//! Passes of one object made one contact, and the side where it lies.

use crate::contacts::pass::Pass;
use crate::navigation::Track;
use crate::result::{Contact, Estimate, Place, SurveyedTow};

/// Standard deviation of a position of the body, m: satellite navigation and layback.
const POSITION_M: f64 = 1.5;
/// What a further pass of the same object may add to the sum of squares: 0.99 of cases of two degrees of freedom.
const MOST_A_PASS: f64 = 9.2;
/// Beyond this difference of the sum of squares the other side is ruled out: 0.95 of cases.
const OTHER_SIDE: f64 = 3.84;
/// Passes of one recording nearer than this in time, s, and in widths, are not of one object: it was there once.
const APART_S: f64 = 30.0;
const APART_WIDTHS: f64 = 10.0;
/// Places abeam, and distances between the ends of the interval, that are tried.
const ABEAM: i32 = 60;
const DISTANCES: i32 = 4;
/// Moments of one object agree within their intervals, and this factor for what is no dipole.
const MOMENTS: f64 = 1.5;

/// A pass where it was.
#[derive(Clone, Copy)]
struct Seen<'a> {
    tow: usize,
    pass: &'a Pass,
    /// Of the closest approach, m, east and north; `None` without a track.
    from: Option<Fix>,
}

#[derive(Clone, Copy)]
struct Fix {
    place_m: [f64; 2],
    /// Unit vector of the course, east and north.
    course: [f64; 2],
    altitude_m: Option<f64>,
}

/// Where an object is abeam of its best pass.
#[derive(Clone, Copy)]
struct Abeam {
    squares: f64,
    starboard_m: f64,
}

/// The contacts of all recordings, the largest signal to noise first, numbered from 1.
pub fn merge(tows: &[(&SurveyedTow, &[Pass])]) -> Vec<Contact> {
    let mut all: Vec<Seen<'_>> = Vec::new();
    for (index, (tow, passes)) in tows.iter().enumerate() {
        all.extend(passes.iter().map(|pass| Seen { tow: index, pass, from: fix(tow, pass) }));
    }
    all.sort_by(|a, b| b.pass.snr.total_cmp(&a.pass.snr));
    let mut objects: Vec<Vec<Seen<'_>>> = Vec::new();
    for seen in all {
        let with = |object: &Vec<Seen<'_>>| {
            let mut joined = object.clone();
            joined.push(seen);
            let squares = sides(&joined).map(|side| side.squares).fold(f64::INFINITY, f64::min);
            (can_join(object, &seen) && squares < MOST_A_PASS * object.len() as f64).then_some(squares)
        };
        let fits = objects.iter().enumerate().filter_map(|(k, object)| Some((k, with(object)?)));
        match fits.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((k, _)) => objects[k].push(seen),
            None => objects.push(vec![seen]),
        }
    }
    objects.iter().enumerate().map(|(k, object)| contact(k + 1, object, tows)).collect()
}

fn fix(tow: &SurveyedTow, pass: &Pass) -> Option<Fix> {
    let track = tow.track.as_ref().filter(|_| pass.is_metres)?;
    let (sin, cos) = track.course_deg[pass.row].to_radians().sin_cos();
    // Between the rows: the way from the row to the closest approach.
    let on_m = pass.at.value - pass.way[pass.row - pass.rows.start];
    let place_m = [track.easting_m[pass.row] + on_m * sin, track.northing_m[pass.row] + on_m * cos];
    let altitude_m = tow.altitude_m.as_ref().map(|altitude_m| altitude_m[pass.row]).filter(|m| m.is_finite());
    place_m.iter().all(|m| m.is_finite()).then_some(Fix { place_m, course: [sin, cos], altitude_m })
}

fn can_join(object: &[Seen<'_>], seen: &Seen<'_>) -> bool {
    object.iter().all(|other| {
        let apart_s = (other.pass.time_s - seen.pass.time_s).abs();
        let is_other_pass =
            other.tow != seen.tow || apart_s > APART_S.max(APART_WIDTHS * other.pass.width_s.max(seen.pass.width_s));
        let moments = other.pass.moment_am2.zip(seen.pass.moment_am2);
        let agree = |(a, b): (Estimate, Estimate)| a.low < MOMENTS * b.high && b.low < MOMENTS * a.high;
        is_other_pass && seen.from.is_some() && other.from.is_some() && moments.is_none_or(agree)
    })
}

/// The best place to port, and to starboard, of the first pass.
fn sides(object: &[Seen<'_>]) -> impl Iterator<Item = Abeam> {
    let first = object[0];
    [-1, 1].into_iter().filter_map(move |side| {
        let Estimate { value, low, high } = first.pass.distance;
        let std = ((high - low) / 4.0).max(f64::MIN_POSITIVE);
        let tries = (-DISTANCES..=DISTANCES).flat_map(|k| (0..=ABEAM).map(move |j| (k, j)));
        let at = |(k, j): (i32, i32)| {
            let distance_m = value + 2.0 * std * f64::from(k) / f64::from(DISTANCES);
            let starboard_m = distance_m * f64::from(side * j) / f64::from(ABEAM);
            let below_m = (distance_m * distance_m - starboard_m * starboard_m).max(0.0).sqrt();
            let own = ((distance_m - value) / std).powi(2);
            let others = object[1..].iter().map(|other| squares(&first, other, starboard_m, below_m));
            Abeam { squares: own + others.sum::<f64>(), starboard_m }
        };
        tries.map(at).min_by(|a, b| a.squares.total_cmp(&b.squares))
    })
}

/// By how much another pass disagrees with a place abeam of the first, that far below.
fn squares(first: &Seen<'_>, other: &Seen<'_>, starboard_m: f64, below_m: f64) -> f64 {
    let (Some(from), Some(to)) = (first.from, other.from) else { return f64::INFINITY };
    let place = abeam(&from, starboard_m);
    let off = [place[0] - to.place_m[0], place[1] - to.place_m[1]];
    let along_m = off[0] * to.course[0] + off[1] * to.course[1];
    let across_m = off[0] * to.course[1] - off[1] * to.course[0];
    // An object keeps its height over the bottom; the body does not.
    let higher_m = to.altitude_m.zip(from.altitude_m).map_or(0.0, |(to, from)| to - from);
    let distance_m = across_m.hypot(below_m + higher_m);
    let along_std = (first.pass.at_std.powi(2) + other.pass.at_std.powi(2) + 2.0 * POSITION_M * POSITION_M).sqrt();
    // What the positions lack moves the object abeam, by as much as it is to the side.
    let beside_std = 2.0_f64.sqrt() * POSITION_M * across_m.abs() / distance_m.max(f64::MIN_POSITIVE);
    let distance_std = ((other.pass.distance.high - other.pass.distance.low) / 4.0).hypot(beside_std);
    (along_m / along_std).powi(2) + ((distance_m - other.pass.distance.value) / distance_std).powi(2)
}

fn abeam(fix: &Fix, starboard_m: f64) -> [f64; 2] {
    [fix.place_m[0] + starboard_m * fix.course[1], fix.place_m[1] - starboard_m * fix.course[0]]
}

fn contact(number: usize, object: &[Seen<'_>], tows: &[(&SurveyedTow, &[Pass])]) -> Contact {
    let Seen { tow: index, pass, from } = object[0];
    let tow = tows[index].0;
    let sides: Vec<Abeam> = if object.len() > 1 { sides(object).collect() } else { Vec::new() };
    let starboard_m = match sides[..] {
        [port, starboard] if port.squares > starboard.squares + OTHER_SIDE => starboard.starboard_m,
        [port, starboard] if starboard.squares > port.squares + OTHER_SIDE => port.starboard_m,
        _ => 0.0,
    };
    let place = from.zip(tow.track.as_ref()).map(|(fix, track)| place(track, pass.row, abeam(&fix, starboard_m)));
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

/// Metres a radian on the WGS 84 ellipsoid, north and east.
fn metres_a_radian(latitude_deg: f64) -> [f64; 2] {
    const EQUATOR_M: f64 = 6_378_137.0;
    const SQUARE_OF_ECCENTRICITY: f64 = 0.006_694_379_990_14;
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    let shrunk = 1.0 - SQUARE_OF_ECCENTRICITY * sin * sin;
    [EQUATOR_M * (1.0 - SQUARE_OF_ECCENTRICITY) / shrunk.powf(1.5), EQUATOR_M * cos / shrunk.sqrt()]
}

/// A place a few metres from a row of the track: over so little way the grid's north is true north.
fn place(track: &Track, row: usize, [easting_m, northing_m]: [f64; 2]) -> Place {
    let (latitude_deg, longitude_deg) = (track.latitude_deg[row], track.longitude_deg[row]);
    let [north, east] = metres_a_radian(latitude_deg);
    Place {
        latitude_deg: latitude_deg + ((northing_m - track.northing_m[row]) / north).to_degrees(),
        longitude_deg: longitude_deg + ((easting_m - track.easting_m[row]) / east).to_degrees(),
        easting_m,
        northing_m,
    }
}
