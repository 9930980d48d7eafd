//! A survey made by formula: lines up and down a lake with iron below them, in two recordings.

use std::sync::Arc;

use towmag_survey::navigation::Track;
use towmag_survey::{Contact, Estimate, Place, Survey, SurveyedTow};

const SPEED_M_PER_S: f64 = 2.0;
const LINE_M: f64 = 400.0;
const SPACING_M: f64 = 20.0;
/// One degree of latitude, and of longitude at 54 degrees north, m.
const DEGREE_M: [f64; 2] = [111_290.0, 65_570.0];

/// Iron: which line, how far along it, distance, m, moment, A m^2, and how it lies.
pub(crate) struct Iron {
    line: usize,
    along_m: f64,
    distance_m: f64,
    moment_am2: f64,
    lies: f64,
}

const IRON: [Iron; 8] = [
    Iron { line: 0, along_m: 90.0, distance_m: 5.0, moment_am2: 12.0, lies: 0.3 },
    Iron { line: 1, along_m: 310.0, distance_m: 7.5, moment_am2: 160.0, lies: 1.2 },
    Iron { line: 2, along_m: 200.0, distance_m: 4.0, moment_am2: 2.2, lies: 2.0 },
    Iron { line: 3, along_m: 60.0, distance_m: 11.0, moment_am2: 300.0, lies: 0.8 },
    Iron { line: 4, along_m: 350.0, distance_m: 3.5, moment_am2: 0.25, lies: 1.9 },
    Iron { line: 5, along_m: 150.0, distance_m: 6.0, moment_am2: 25.0, lies: 0.1 },
    Iron { line: 6, along_m: 222.0, distance_m: 4.4, moment_am2: 5.0, lies: 2.6 },
    Iron { line: 8, along_m: 120.0, distance_m: 8.0, moment_am2: 75.0, lies: 1.5 },
];

/// Of a dipole that is passed at `u` distances from the closest approach, nT.
fn anomaly_nt(iron: &Iron, u: f64) -> f64 {
    let (c, s) = (iron.lies.cos(), iron.lies.sin());
    let shape = (2.0 * u * u - 1.0) * c * c + (2.0 - u * u) * s * s + 6.0 * u * s * c;
    100.0 * iron.moment_am2 / iron.distance_m.powi(3) * shape / (1.0 + u * u).powf(2.5)
}

/// Uniform in -1 to 1, the same on every run.
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}

fn line_s() -> f64 {
    LINE_M / SPEED_M_PER_S
}

/// East, north, line and course after `time_s`; between lines there is half a circle.
fn at(time_s: f64, first_line: usize) -> (f64, f64, Option<usize>, f64) {
    let turn_s = std::f64::consts::PI * 0.5 * SPACING_M / SPEED_M_PER_S;
    let line = (time_s / (line_s() + turn_s)).floor();
    let into_s = time_s - line * (line_s() + turn_s);
    let up = if (line as usize).is_multiple_of(2) { 1.0 } else { -1.0 };
    let east = (line + first_line as f64) * SPACING_M;
    let along = |s: f64| 0.5 * LINE_M + up * (s * SPEED_M_PER_S - 0.5 * LINE_M);
    if into_s <= line_s() {
        let sway = 1.2 * (0.05 * time_s).sin();
        return (east + sway, along(into_s), Some(line as usize + first_line), if up > 0.0 { 0.0 } else { 180.0 });
    }
    let angle = (into_s - line_s()) / turn_s * std::f64::consts::PI;
    let radius = 0.5 * SPACING_M;
    (east + radius * (1.0 - angle.cos()), along(line_s()) + up * radius * angle.sin(), None, 90.0)
}

fn place(easting_m: f64, northing_m: f64) -> Place {
    let (latitude_deg, longitude_deg) = (54.168 + northing_m / DEGREE_M[0], 7.884 + easting_m / DEGREE_M[1]);
    Place { latitude_deg, longitude_deg, easting_m, northing_m }
}

fn tow(name: &str, first_line: usize, lines: usize, has_track: bool) -> SurveyedTow {
    let turn_s = std::f64::consts::PI * 0.5 * SPACING_M / SPEED_M_PER_S;
    let rows = (10.0 * (lines as f64 * (line_s() + turn_s) - turn_s)) as usize;
    let mut noise = Noise(7 + first_line as u32);
    let mut tow = SurveyedTow { name: name.into(), ..SurveyedTow::default() };
    let mut track = Track::default();
    let mut altitude_m = Vec::new();
    for row in 0..rows {
        let time_s = 0.1 * row as f64;
        let (east, north, line, course) = at(time_s, first_line);
        let is_valid = !(3_000..3_040).contains(&row);
        let quiet_nt = 0.03 * (1.0 + 0.8 * (0.004 * time_s).sin());
        let mut nt = quiet_nt * (noise.next() + noise.next());
        for iron in &IRON {
            let (dx, dy) = (east - iron.line as f64 * SPACING_M, north - iron.along_m);
            let far = (iron.distance_m.powi(2) + dx * dx).sqrt();
            nt += anomaly_nt(&Iron { distance_m: far, ..*iron }, dy / far);
        }
        let or_nan = |value: f64| if is_valid { value } else { f64::NAN };
        tow.time_s.push(time_s);
        tow.is_valid.push(is_valid);
        tow.field_nt.push(or_nan(49_812.0 + 6.0 * (0.003 * time_s).sin() + 0.04 * north + nt));
        tow.field_std_nt.push(or_nan(0.18));
        tow.anomaly_nt.push(or_nan(nt));
        tow.anomaly_std_nt.push(or_nan(quiet_nt));
        tow.line.push(line.map_or(Arc::from(""), |line| Arc::from(format!("L{line}"))));
        let altitude = 4.0 + 0.8 * (0.01 * time_s).cos();
        altitude_m.push(altitude);
        if has_track {
            let Place { latitude_deg, longitude_deg, .. } = place(east, north);
            track.easting_m.push(east);
            track.northing_m.push(north);
            track.along_m.push(SPEED_M_PER_S * time_s);
            track.speed_m_per_s.push(SPEED_M_PER_S);
            track.course_deg.push(course);
            track.latitude_deg.push(latitude_deg);
            track.longitude_deg.push(longitude_deg);
            tow.smallest_moment_am2.push(or_nan(0.1 * quiet_nt * altitude.powi(3)));
        }
    }
    tow.altitude_m = Some(altitude_m);
    tow.track = has_track.then_some(track);
    tow
}

fn contact(number: usize, iron: &Iron, tow: usize, first_line: usize, has_track: bool) -> Contact {
    let turn_s = std::f64::consts::PI * 0.5 * SPACING_M / SPEED_M_PER_S;
    let line = iron.line - first_line;
    let along_m = if line.is_multiple_of(2) { iron.along_m } else { LINE_M - iron.along_m };
    let time_s = line as f64 * (line_s() + turn_s) + along_m / SPEED_M_PER_S;
    let up = if line.is_multiple_of(2) { 1.0 } else { -1.0 };
    let of = |time: f64| anomaly_nt(iron, up * SPEED_M_PER_S * (time - time_s) / iron.distance_m);
    let half_s = 3.0 * iron.distance_m / SPEED_M_PER_S;
    let fit: Vec<(f64, f64)> =
        (-60..=60).map(|k| time_s + half_s * f64::from(k) / 60.0).map(|time| (time, of(time))).collect();
    let peak_nt = fit.iter().map(|point| point.1).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap();
    let estimate = |value: f64, wide: f64| Estimate { value, low: value / wide, high: value * wide };
    let snr = peak_nt.abs() / 0.03;
    Contact {
        number,
        passes: 1 + usize::from(snr > 100.0),
        tow,
        time_s,
        line: Arc::from(format!("L{}", iron.line)),
        place: has_track.then(|| place(iron.line as f64 * SPACING_M + 1.5, iron.along_m)),
        peak_nt,
        width_s: iron.distance_m / SPEED_M_PER_S,
        snr,
        false_alarm_probability: (-(snr * snr) / 300.0).exp(),
        distance_m: has_track.then(|| estimate(iron.distance_m, 1.12)),
        moment_am2: has_track.then(|| estimate(iron.moment_am2, 1.4)),
        fit,
    }
}

/// Two recordings, eight contacts.
pub(crate) fn survey(has_track: bool) -> Survey {
    let tows = vec![tow("lake_1 <north & south>.csv", 0, 7, has_track), tow("lake_2.csv", 7, 3, has_track)];
    let mut contacts: Vec<Contact> = IRON
        .iter()
        .map(|iron| if iron.line < 7 { contact(0, iron, 0, 0, has_track) } else { contact(0, iron, 1, 7, has_track) })
        .collect();
    contacts.sort_by(|a, b| b.snr.total_cmp(&a.snr));
    contacts.iter_mut().enumerate().for_each(|(i, contact)| contact.number = i + 1);
    Survey {
        tows,
        contacts,
        false_alarms_per_hour: 1.0,
        noise_floor_nt: 0.021,
        smallest_moment_am2: has_track.then_some(0.19),
        coefficients: [0.0; 18],
        coefficient_std: [0.0; 18],
        grid: None,
    }
}

/// An hour and more on sixteen lines with sixty contacts: what a page must still be small for.
pub(crate) fn long_survey() -> Survey {
    let mut long = survey(true);
    long.tows = vec![tow("lake_1.csv", 0, 17, true)];
    long.contacts = (0..60)
        .map(|k| {
            let iron = Iron { line: k % 16, along_m: 20.0 + 6.0 * k as f64, ..IRON[k % 8] };
            contact(k + 1, &iron, 0, 0, true)
        })
        .collect();
    long
}
