//! All of a survey: navigation, then level and contacts, which take turns.

use std::ops::Range;

use rayon::prelude::*;

use crate::contacts::{Found, Levelled, Options, find, find_again, merge, smallest_moments_am2};
use crate::level::{Coefficients, Level, direction, level};
use crate::navigation::{Diurnal, Navigated, Navigation, diurnal, share};
use crate::options::SurveyOptions;
use crate::result::{Base, Survey, SurveyedTow};
use crate::second::{as_second, together};
use crate::statistics::median;
use crate::tow::Tow;

/// Turns of level and contacts.
const TURNS: usize = 2;
/// Contacts are told from a level whose coefficients move where that leaves less noise than this share: 0.3 to 0.5 on flights but for
/// one of 0.8, 0.7 and more on tows whose coefficients stay, as iron that is not found yet is taken along.
const QUIETER: f64 = 0.6;

/// Strong iron is all along the track if one contact of so much signal to noise comes in so long, s: as a mean, in the time over which
/// noise is told where iron is slow (45 s above 0.2 Hz, 270 s at 0.03 Hz). Another search costs half as long again.
const STRONG_SNR: f64 = 20.0;
const CROWDED_S: f64 = 150.0;

/// Survey recordings of one body that were where `navigation` says, which is [`navigate`](crate::navigation::navigate)'s of them.
pub fn survey(tows: &[Tow], navigation: &Navigation, options: &SurveyOptions) -> Survey {
    let diurnal = diurnal(tows);
    let quiet: Vec<Tow> = tows.iter().zip(&diurnal.variation_nt).map(|(tow, nt)| without(tow, nt.as_deref())).collect();
    let surveyor = Surveyor::new(&quiet, &navigation.tows);
    let (level, found) = surveyor.level_and_contacts(options);
    let second = second_level(&quiet, &navigation.tows, options);
    let tow = |index: usize| SurveyedTow {
        base: surveyor.base(index, &diurnal, &level, &found[index]),
        second: second.as_ref().map(|second| together(&level, second, surveyor.rows[index].clone())),
        ..surveyor.tow(index, &level, &found[index])
    };
    let surveyed: Vec<SurveyedTow> = (0..tows.len()).map(tow).collect();
    let passes: Vec<_> = surveyed.iter().zip(&found).map(|(tow, found)| (tow, found.passes.as_slice())).collect();
    let moments = surveyed.iter().flat_map(|tow| tow.smallest_moment_am2.iter().copied());
    let mut moments: Vec<f64> = moments.filter(|moment| moment.is_finite()).collect();
    Survey {
        contacts: merge(&passes, navigation.grid),
        smallest_moment_am2: median(&mut moments),
        false_alarms_per_hour: options.false_alarms_per_hour,
        noise_floor_nt: floor_nt(&found),
        coefficients: level.coefficients,
        coefficient_std: level.coefficient_std,
        grid: navigation.grid,
        tows: surveyed,
    }
}

/// Whether strong iron is all along the track, as on laps past it: what a search finds first then decides what its noise hides from it,
/// and another search may find more.
fn is_crowded(found: &Found) -> bool {
    let strong = found.passes.iter().filter(|pass| pass.snr > STRONG_SNR).count();
    strong as f64 * CROWDED_S > found.noise.hours() * 3600.0
}

/// What describes a recording better.
fn likelier(a: Found, b: Found) -> Found {
    if b.criterion() < a.criterion() { b } else { a }
}

/// The fitted anomalies of everything found, nT a row; `None` while nothing was looked for.
fn anomalies_nt(found: &[Found]) -> Option<Vec<f64>> {
    (!found.is_empty()).then(|| found.iter().flat_map(|found| found.anomaly_nt.iter().copied()).collect())
}

/// Median noise floor of all recordings, nT.
fn floor_nt(found: &[Found]) -> f64 {
    let mut floors: Vec<f64> =
        found.iter().filter_map(|found| found.noise.median_floor_nt()).filter(|nt| nt.is_finite()).collect();
    median(&mut floors).unwrap_or(f64::NAN)
}

/// The second sensor sits elsewhere on the body: what a calibration says of the first is nothing to it.
fn second_level(tows: &[Tow], navigated: &[Navigated], options: &SurveyOptions) -> Option<Level> {
    let tows = as_second(tows)?;
    let options = SurveyOptions { calibration: None, ..options.clone() };
    Some(Surveyor::new(&tows, navigated).level_and_contacts(&options).0)
}

/// A recording without the field's change with the day.
fn without(tow: &Tow, variation_nt: Option<&[f64]>) -> Tow {
    let mut tow = tow.clone();
    if let Some(variation_nt) = variation_nt {
        tow.scalar_nt.iter_mut().zip(variation_nt).for_each(|(nt, variation_nt)| *nt -= variation_nt);
    }
    tow
}

/// Recordings of one body, whose rows are counted through.
struct Surveyor<'a> {
    tows: &'a [Tow],
    navigated: &'a [Navigated],
    /// Rows of each recording among all.
    rows: Vec<Range<usize>>,
    /// Of the field, in body axes.
    directions: Vec<[f64; 3]>,
}

impl<'a> Surveyor<'a> {
    fn new(tows: &'a [Tow], navigated: &'a [Navigated]) -> Self {
        let mut end = 0;
        let rows = tows.iter().map(|tow| {
            end += tow.len();
            end - tow.len()..end
        });
        let directions = tows.iter().flat_map(|tow| tow.flux_nt.iter().map(|flux_nt| direction(*flux_nt))).collect();
        Self { rows: rows.collect(), tows, navigated, directions }
    }

    /// Coefficients that do not move take least of a target that nobody has found; those that move leave less noise where a
    /// body asks for it. Contacts are told from whichever level is quiet, the level itself always moves.
    fn level_and_contacts(&self, options: &SurveyOptions) -> (Level, Vec<Found>) {
        let of = |coefficients| {
            let false_alarms_per_hour = options.false_alarms_per_hour;
            Options { false_alarms_per_hour, coefficients, ..Options::default() }
        };
        let [still, moving] = [Coefficients::Still, Coefficients::Moving].map(of);
        let (found, quieter) = rayon::join(
            || (0..TURNS).fold(Vec::new(), |found, _| self.turn(&still, options, &found)),
            || (0..TURNS).fold(Vec::new(), |found, _| self.turn(&moving, options, &found)),
        );
        let found = if floor_nt(&quieter) < QUIETER * floor_nt(&found) {
            quieter
        } else if found.iter().any(is_crowded) {
            let level = self.level(still.coefficients, &[], options);
            let other = |(index, found): (usize, Found)| {
                let options = Options { alike: 0.0, way_by: found.way_by, ..still };
                likelier(found, find(&self.levelled(index, &level), &options))
            };
            found.into_par_iter().enumerate().map(other).collect()
        } else {
            found
        };
        (self.level(Coefficients::Moving, &found, options), found)
    }

    /// Level and contacts in turns: the first level has a part of each target in it.
    fn turn(&self, how: &Options, options: &SurveyOptions, before: &[Found]) -> Vec<Found> {
        self.found(&self.level(how.coefficients, before, options), how, before)
    }

    fn level(&self, coefficients: Coefficients, found: &[Found], options: &SurveyOptions) -> Level {
        level(self.tows, anomalies_nt(found).as_deref(), options.calibration.as_ref(), coefficients)
    }

    fn found(&self, level: &Level, options: &Options, before: &[Found]) -> Vec<Found> {
        let of = |index: usize| {
            let levelled = self.levelled(index, level);
            before.get(index).map_or_else(|| find(&levelled, options), |before| find_again(&levelled, options, before))
        };
        (0..self.tows.len()).into_par_iter().map(of).collect()
    }

    fn levelled<'l>(&'l self, index: usize, level: &'l Level) -> Levelled<'l> {
        let (tow, rows) = (&self.tows[index], self.rows[index].clone());
        Levelled {
            time_s: &tow.time_s,
            is_valid: &tow.is_usable,
            field_nt: &level.field_nt[rows.clone()],
            variance_nt2: tow.scalar_variance_nt2.as_deref(),
            terms: &level.terms[rows.clone()],
            direction: &self.directions[rows],
            track: self.navigated[index].track.as_ref(),
            altitude_m: tow.altitude_m.as_deref(),
            depth_m: tow.depth_m.as_deref(),
        }
    }

    fn base(&self, index: usize, diurnal: &Diurnal, level: &Level, found: &Found) -> Option<Base> {
        self.tows[index].base_nt.as_ref()?;
        let variation_nt = diurnal.variation_nt[index].as_deref();
        let share_of = |variation_nt: &[f64]| {
            let field_nt = level.field_nt[self.rows[index].clone()].iter().zip(&found.anomaly_nt);
            let as_read: Vec<f64> = field_nt.zip(variation_nt).map(|((field, iron), day)| field - iron + day).collect();
            share(&as_read, variation_nt)
        };
        let (faults, share) = (diurnal.faults[index], variation_nt.and_then(share_of));
        Some(Base { is_taken_off: variation_nt.is_some(), faults, share })
    }

    fn tow(&self, index: usize, level: &Level, found: &Found) -> SurveyedTow {
        let (tow, navigated, rows) = (&self.tows[index], &self.navigated[index], self.rows[index].clone());
        SurveyedTow {
            name: tow.name.clone(),
            time_s: tow.time_s.clone(),
            is_valid: level.field_nt[rows.clone()].iter().map(|nt| nt.is_finite()).collect(),
            field_nt: level.field_nt[rows.clone()].to_vec(),
            field_std_nt: level.field_std_nt[rows.clone()].to_vec(),
            anomaly_nt: level.anomaly_nt[rows.clone()].to_vec(),
            anomaly_std_nt: level.anomaly_std_nt[rows].to_vec(),
            track: navigated.track.clone(),
            line: navigated.line.clone(),
            altitude_m: tow.altitude_m.clone(),
            smallest_moment_am2: smallest_moments_am2(&self.levelled(index, level), found, None),
            fixes: navigated.fixes,
            dropped_fixes: navigated.dropped_fixes,
            receiver_faults: navigated.receiver_faults.clone(),
            base: None,
            second: None,
        }
    }
}
