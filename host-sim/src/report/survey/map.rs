//! The map: the track in colours, the contacts on it, equal axes.

mod layer;
mod sheet;

use towmag_survey::{Contact, Survey};

use crate::report::svg::round_step;
use crate::text::number::group;
use crate::text::survey as words;

use layer::{Layer, anomaly, reach};
use sheet::Sheet;

/// Lines whose names are written on the map; more would hide it.
const NAMED_LINES: usize = 40;

/// All of it.
pub(super) struct Map {
    /// In units of the drawing.
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) width_over_height: String,
    pub(super) layers: Vec<Layer>,
    pub(super) grid: String,
    /// Name, and where it begins, percent from the left and from the top.
    pub(super) lines: Vec<(String, String, String)>,
    pub(super) pins: Vec<Pin>,
    /// Length of the bar.
    pub(super) scale: String,
    /// The same, of the width.
    pub(super) scale_percent: String,
}

/// A contact on it.
pub(super) struct Pin {
    pub(super) number: usize,
    pub(super) is_first: bool,
    pub(super) is_sure: bool,
    pub(super) left: String,
    pub(super) top: String,
    pub(super) title: String,
}

/// `None` without a track.
pub(super) fn map(survey: &Survey) -> Option<Map> {
    let sheet = Sheet::of(survey)?;
    let step_m = round_step(0.25 * sheet.width_m.max(0.5 * sheet.height_m));
    Some(Map {
        width: (sheet.width_m * sheet.units_per_m).round(),
        height: (sheet.height_m * sheet.units_per_m).round(),
        width_over_height: format!("{:.4}", sheet.width_m / sheet.height_m),
        layers: [anomaly(survey, &sheet), reach(survey, &sheet)].into_iter().flatten().collect(),
        grid: grid(&sheet, step_m),
        lines: line_names(survey, &sheet),
        pins: pins(&survey.contacts, &sheet),
        scale: if step_m >= 1.0 { format!("{} m", group(step_m as i64)) } else { format!("{step_m} m") },
        scale_percent: format!("{:.2}", 100.0 * step_m / sheet.width_m),
    })
}

fn grid(sheet: &Sheet, step_m: f64) -> String {
    let multiples = |low: f64, length: f64| {
        let first = (low / step_m).ceil();
        (0..((low + length) / step_m - first) as usize + 1).map(move |k| (first + k as f64) * step_m)
    };
    let (width, height) = (sheet.width_m * sheet.units_per_m, sheet.height_m * sheet.units_per_m);
    let down =
        multiples(sheet.west_m, sheet.width_m).map(|east| format!("M{:.0} 0V{height:.0}", sheet.at(east, 0.0).0));
    let south_m = sheet.north_m - sheet.height_m;
    let across = multiples(south_m, sheet.height_m).map(|north| format!("M0 {:.0}H{width:.0}", sheet.at(0.0, north).1));
    down.chain(across).collect()
}

/// Where each line begins.
fn line_names(survey: &Survey, sheet: &Sheet) -> Vec<(String, String, String)> {
    let mut names = Vec::new();
    for tow in &survey.tows {
        let Some(track) = &tow.track else { continue };
        let mut last = "";
        for (row, line) in tow.line.iter().enumerate() {
            let (east, north) = (track.easting_m[row], track.northing_m[row]);
            if **line != *last && east.is_finite() && north.is_finite() {
                last = line;
                let (left, top) = sheet.percent(east, north);
                names.extend((!line.is_empty()).then(|| (line.to_string(), left, top)));
            }
        }
    }
    if names.len() > NAMED_LINES { Vec::new() } else { names }
}

/// The one to dive for first lies on top.
fn pins(contacts: &[Contact], sheet: &Sheet) -> Vec<Pin> {
    let pin = |(place, contact): (usize, &Contact)| {
        let at = contact.place.filter(|place| place.easting_m.is_finite() && place.northing_m.is_finite())?;
        let (left, top) = sheet.percent(at.easting_m, at.northing_m);
        let iron =
            contact.moment_am2.as_ref().map_or(String::new(), |moment| format!(", {} of iron", words::iron(moment)));
        let title = format!("Contact {}: {} nT{iron}", contact.number, words::signed(contact.peak_nt));
        Some(Pin { number: contact.number, is_first: place == 0, is_sure: words::is_sure(contact), left, top, title })
    };
    let mut pins: Vec<Pin> = words::dive_order(contacts).into_iter().enumerate().filter_map(pin).collect();
    pins.reverse();
    pins
}
