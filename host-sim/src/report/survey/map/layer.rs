//! The track in colours: one path a class, the loud ones last and so on top.

use std::fmt::Write;

use towmag_survey::{Survey, SurveyedTow};

use super::sheet::Sheet;
use crate::report::survey::colours::Classes;

/// Points of all tracks together: what keeps the page small.
const POINTS: f64 = 8000.0;
/// Points across the sheet: more would fall on one dot of the screen.
const ACROSS: f64 = 1600.0;
/// A track breaks where it jumps by more than this, m: no tow makes them in a row of 0.1 s.
const JUMP_M: f64 = 30.0;

/// Colours of one quantity.
pub(in crate::report::survey) struct Layer {
    pub(in crate::report::survey) class: &'static str,
    pub(in crate::report::survey) title: String,
    /// Class and path.
    pub(in crate::report::survey) paths: Vec<(String, String)>,
    /// Class and what it stands for.
    pub(in crate::report::survey) legend: Vec<(String, String)>,
}

/// The anomaly: size by the class, sign by the colour.
pub(super) fn anomaly(survey: &Survey, sheet: &Sheet) -> Option<Layer> {
    let largest = survey.contacts.iter().map(|contact| contact.peak_nt.abs()).fold(0.0, f64::max);
    let largest = if largest > 0.0 { largest } else { 20.0 * survey.noise_floor_nt };
    let classes = Classes::of_anomalies(survey.noise_floor_nt, largest);
    let place = |nt: f64| 2 * classes.of(nt.abs()) + usize::from(nt < 0.0);
    let names: Vec<String> = (0..=7).map(name).collect();
    let paths = paths(survey, sheet, |tow| &tow.anomaly_nt, |nt| (nt.abs(), place(nt)), &names);
    let ranges = classes.ranges("nT");
    let mut legend: Vec<(String, String)> = vec![("c0".into(), ranges.first()?.clone())];
    for (k, range) in ranges.iter().enumerate().skip(1) {
        legend.push((format!("p{k}"), format!("+ {range}")));
        legend.push((format!("n{k}"), format!("− {range}")));
    }
    Some(Layer { class: "layer-anomaly", title: "Anomaly:".into(), paths, legend })
}

fn name(place: usize) -> String {
    match (place / 2, place % 2) {
        (0, _) => "c0".into(),
        (class, 0) => format!("p{class}"),
        (class, _) => format!("n{class}"),
    }
}

/// The smallest moment that is found below the track.
pub(super) fn reach(survey: &Survey, sheet: &Sheet) -> Option<Layer> {
    let all = survey.tows.iter().flat_map(|tow| tow.smallest_moment_am2.iter().copied());
    let mut all: Vec<f64> = all.filter(|moment| moment.is_finite() && *moment > 0.0).collect();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all.get((share * all.len() as f64) as usize).copied();
    let classes = Classes::between(at(0.1)?, at(0.9)?);
    let names: Vec<String> = (0..=3).map(|class| format!("r{class}")).collect();
    let paths = paths(survey, sheet, |tow| &tow.smallest_moment_am2, |am2| (am2, classes.of(am2)), &names);
    let ranges = classes.ranges("A m²").into_iter().enumerate();
    let legend = ranges.map(|(class, range)| (format!("r{class}"), range)).collect();
    let title = "Smallest moment found right below (1 A m² is 1 to 10 kg of iron):".into();
    Some(Layer { class: "layer-reach", title, paths, legend })
}

/// One path for each name. `class` gives a value's size, of which the largest of a stretch counts, and its class.
fn paths(
    survey: &Survey,
    sheet: &Sheet,
    values: impl Fn(&SurveyedTow) -> &Vec<f64>,
    class: impl Fn(f64) -> (f64, usize),
    names: &[String],
) -> Vec<(String, String)> {
    let cell_m = (length_m(survey) / POINTS).max(sheet.width_m.max(sheet.height_m) / ACROSS);
    let mut brush = Brush::new(sheet, names.len());
    for tow in &survey.tows {
        let Some(track) = &tow.track else { continue };
        brush.lift();
        for (row, &value) in values(tow).iter().enumerate() {
            let at = (track.easting_m[row], track.northing_m[row]);
            match at.0.is_finite() && at.1.is_finite() && value.is_finite() {
                true => brush.to(at, class(value), cell_m),
                false => brush.lift(),
            }
        }
        brush.lift();
    }
    names.iter().cloned().zip(brush.paths).filter(|(_, d)| !d.is_empty()).collect()
}

fn length_m(survey: &Survey) -> f64 {
    let tracks = survey.tows.iter().filter_map(|tow| tow.track.as_ref());
    tracks.filter_map(|track| track.along_m.iter().copied().rfind(|along| along.is_finite())).sum()
}

/// Draws stretches of the track, each in the class of its largest value.
struct Brush<'a> {
    sheet: &'a Sheet,
    paths: Vec<String>,
    /// Where the stretch began, where it is, and its largest value with the class.
    stretch: Option<Stretch>,
    /// Class of the stretch before, which this one may go on with.
    before: Option<usize>,
}

struct Stretch {
    from: (f64, f64),
    to: (f64, f64),
    size: f64,
    class: usize,
}

impl<'a> Brush<'a> {
    fn new(sheet: &'a Sheet, classes: usize) -> Self {
        Self { sheet, paths: vec![String::new(); classes], stretch: None, before: None }
    }

    fn to(&mut self, at: (f64, f64), (size, class): (f64, usize), cell_m: f64) {
        if self.stretch.as_ref().is_some_and(|stretch| distance(stretch.to, at) > JUMP_M) {
            self.lift();
        }
        let stretch = self.stretch.get_or_insert(Stretch { from: at, to: at, size, class });
        stretch.to = at;
        if size > stretch.size {
            (stretch.size, stretch.class) = (size, class);
        }
        if distance(stretch.from, at) >= cell_m {
            self.draw();
            self.stretch = Some(Stretch { from: at, to: at, size, class });
        }
    }

    fn lift(&mut self) {
        self.draw();
        (self.stretch, self.before) = (None, None);
    }

    fn draw(&mut self) {
        let Some(stretch) = self.stretch.take() else { return };
        let (from, to) = (self.sheet.at(stretch.from.0, stretch.from.1), self.sheet.at(stretch.to.0, stretch.to.1));
        let Some(d) = self.paths.get_mut(stretch.class) else { return };
        // A text takes everything.
        let _ = match self.before == Some(stretch.class) {
            true => write!(d, " {:.0} {:.0}", to.0, to.1),
            false => write!(d, "M{:.0} {:.0} {:.0} {:.0}", from.0, from.1, to.0, to.1),
        };
        self.before = Some(stretch.class);
    }
}

fn distance(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}
