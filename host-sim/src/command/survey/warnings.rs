//! What the reader must know before trusting a survey's figures.

use towmag_survey::navigation::ReceiverFault;
use towmag_survey::{Base, Survey, SurveyedTow, Tow};

use super::place;
use super::summary::GridSummary;
use super::tows::Read;
use crate::text::survey::{left_over, taken_off};

/// A warning is due where more than one in so many positions is no good: one or two are any receiver's.
const ONE_FIX_IN: usize = 100;
/// Cells of a map are coarse from this share of the distance between lines on: a quarter of it is usual.
const COARSE_CELLS: f64 = 0.5;
/// Where nothing tells that distance, m.
const USUAL_DISTANCE_M: f64 = 20.0;
/// So many faults of a receiver are told one by one.
const MOST_FAULTS: usize = 4;

/// A base station that reads the same for longer is doubted, s: the field of the quietest hour changes a tenth of a nanotesla in less.
const STANDS_S: f64 = 600.0;
/// Its changes are doubted where the recording shows less, or more, than this by the ends of the interval.
const LEAST_SHARE: f64 = 0.5;
const MOST_SHARE: f64 = 1.5;

/// What the reader must know before trusting the figures, a sentence each. `grid` is the map, where its cells were not asked for.
pub(super) fn warnings(read: &Read, survey: &Survey, grid: Option<&GridSummary>) -> Vec<String> {
    let mut warnings = read.notes.clone();
    warnings.extend(grid.and_then(coarse));
    for ((tow, surveyed), diagnosed) in read.tows.iter().zip(&survey.tows).zip(&read.diagnosed) {
        let name = &tow.name;
        warnings.extend(taken_off(name, &diagnosed.effects));
        warnings.extend(diagnosed.unexplained_nt.map(|nt| left_over(name, nt)));
        warnings.extend(
            diagnosed
                .refusal
                .as_ref()
                .map(|why| format!("Not diagnosed, so that faults of the sensor may be contacts: {why}")),
        );
        warnings.extend(of_positions(tow, surveyed));
        if tow.scalar2_nt.is_some() && surveyed.second.is_none() {
            warnings.push(format!("{name}: scalar2_nT was not used: in more than a tenth of the rows, here or in another recording, it is missing, stands still, or is a tenth off scalar_nT."));
        }
        warnings.extend(surveyed.base.iter().flat_map(|base| of_base(name, base)));
    }
    warnings
}

/// That the cells of a map, which are as large as they must be for all recordings to be on it, hide what lies between two lines.
fn coarse(grid: &GridSummary) -> Option<String> {
    let cell_m = grid.cell_m;
    let lines = grid.line_distance_m.map(|distance_m| format!(", where lines are {distance_m:.0} m apart"));
    (cell_m > COARSE_CELLS * grid.line_distance_m.unwrap_or(USUAL_DISTANCE_M)).then(|| {
        let lines = lines.unwrap_or_default();
        format!("The map's cells are {cell_m} m{lines}: it reaches too far for smaller ones. Survey recordings of different places apart, or give --grid-m.")
    })
}

/// What is odd about the positions of a recording.
fn of_positions(tow: &Tow, surveyed: &SurveyedTow) -> Vec<String> {
    if !surveyed.track.iter().flat_map(|track| &track.easting_m).any(|east| east.is_finite()) {
        return vec![unplaced(tow)];
    }
    let (dropped, faults) = (surveyed.dropped_fixes, &surveyed.receiver_faults);
    let is_step = |fault: &ReceiverFault| matches!(fault, ReceiverFault::Step { .. });
    let dropped = (faults.iter().all(is_step) && dropped * ONE_FIX_IN > surveyed.fixes).then(|| {
        format!(
            "{}: {dropped} positions are far off their neighbours, zero, not on Earth, or the same to the last digit for half a minute, and were not used.",
            tow.name
        )
    });
    let faults = faults.iter().take(MOST_FAULTS).map(|fault| format!("{}: {}", tow.name, of_receiver(fault)));
    let more = surveyed.receiver_faults.len().saturating_sub(MOST_FAULTS);
    let more = (more > 0).then(|| format!("{}: and {more} more such faults of the receiver.", tow.name));
    place::doubt(tow).into_iter().chain(dropped).chain(faults).chain(more).collect()
}

fn of_receiver(fault: &ReceiverFault) -> String {
    match *fault {
        ReceiverFault::Hang { from_s, to_s } => format!(
            "the receiver stands still from {from_s:.0} s and has caught up at {to_s:.0} s; its positions between were not used, and contacts there are told by time."
        ),
        ReceiverFault::Away { from_s, to_s, by_m } => format!(
            "the receiver jumps by {by_m:.1} m at {from_s:.0} s and back at {to_s:.0} s; its positions between were not used, and contacts there are told by time."
        ),
        ReceiverFault::Step { at_s, by_m } => format!(
            "the positions jump by {by_m:.1} m at {at_s:.0} s and stay there: contacts before or after are off by as much, and it is not known which."
        ),
    }
}

/// Why a recording has no place on the map, and what that means.
fn unplaced(tow: &Tow) -> String {
    let has_some = |degrees: &Vec<f64>| degrees.iter().any(|degrees| degrees.is_finite());
    let why = match (&tow.latitude_deg, &tow.longitude_deg) {
        (Some(latitude_deg), Some(longitude_deg)) if has_some(latitude_deg) && has_some(longitude_deg) => {
            ": none of its positions can be used, as they are zero or not on Earth (minutes of a degree are no decimals of it)"
        }
        (Some(_), None) => " has latitude_deg without longitude_deg, and so no positions",
        (None, Some(_)) => " has longitude_deg without latitude_deg, and so no positions",
        _ => " has no positions",
    };
    let distances = if tow.speed_m_per_s.is_some() { ", their distances by speed_m_per_s" } else { "" };
    format!("{}{why}: contacts are told by time{distances}, and there is no map of it.", tow.name)
}

/// What is odd about the base station of a recording.
fn of_base(name: &str, base: &Base) -> Vec<String> {
    let Base { is_taken_off, faults, share } = base;
    let mut said = Vec::new();
    if !is_taken_off {
        said.push(format!("{name}: base_nT is missing in more than a tenth of the rows, and the change with the day was not taken away."));
    }
    if faults.left_out > 0 {
        said.push(left_out(&format!("{name}: base_nT"), faults.left_out));
    }
    if faults.stood_s > STANDS_S {
        said.push(format!(
            "{name}: the base station reads the same for {:.0} minutes: did it stand still?",
            faults.stood_s / 60.0
        ));
    }
    if let Some(share) = share.filter(|share| share.high < LEAST_SHARE || share.low > MOST_SHARE) {
        let [low, high] = [share.low, share.high].map(|share| 100.0 * share);
        said.push(format!("{name}: of the base station's changes the recording shows {low:.0} to {high:.0} %, where 100 are expected: are its clock, its sign and its place right? They were taken off all the same; survey without it to compare."));
    }
    said
}

/// That readings of a base station were not used.
pub(super) fn left_out(whose: &str, readings: usize) -> String {
    let readings = if readings == 1 { "1 reading was".into() } else { format!("{readings} readings were") };
    format!(
        "{whose}: {readings} not used, as no change of the Earth's field is like that (a spike, a dummy, a car that passes)."
    )
}
