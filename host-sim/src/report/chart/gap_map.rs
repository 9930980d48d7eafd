//! Where the gap lies: a small picture for each way to tell the rows of a recording apart.

use plotly::common::Marker;
use plotly::layout::BarMode;
use plotly::{Bar, Plot};
use serde_json::json;

use super::{Chart, FLUXGATE, SCALAR, axis, layout, plain};
use crate::collect::SECTORS;
use crate::diagnosis::{Cell, Diagnosis};
use crate::text::diagnosis::percent;
use crate::text::number::{rounded, short, three_digits};

/// What noise alone may show.
pub(in crate::report) const NOT_SIGNIFICANT: &str = "#C9C9C9";

/// Chance that noise alone makes any bar of the map significant.
const CHANCE: f64 = 0.05;

/// Letters that fit side by side under a picture.
const LETTERS: usize = 36;

/// The ways in the order that is shown: what they are called, and what is on the axis.
const WAYS: [(&str, &str, &str); 10] = [
    ("channel", "Sensor", "sensor"),
    ("stage", "Stage of the firmware", "stage"),
    ("band", "Frequency", "frequency, Hz"),
    ("time", "Time", "time in the recording, s, from"),
    ("heading", "Heading", "heading"),
    ("attitude_rate", "How fast the body turns", "turning rate, °/s"),
    ("amplitude", "Strength of the interference", "interference, nT"),
    ("load", "Loads", "load"),
    ("depth", "Depth", "depth, m"),
    ("temperature", "Temperature", "temperature, °C"),
];

/// One way to tell rows apart.
pub(in crate::report) struct By {
    /// What it is called.
    pub(in crate::report) title: &'static str,
    /// Where most of the gap is.
    pub(in crate::report) note: String,
    /// Its picture.
    pub(in crate::report) chart: Chart,
}

/// The pictures of all ways that tell anything apart.
pub(in crate::report) fn gap_map(diagnosis: &Diagnosis) -> Vec<By> {
    let limit = CHANCE / diagnosis.cells.len().max(1) as f64;
    WAYS.iter().filter_map(|way| picture(diagnosis, way, limit)).collect()
}

fn picture(diagnosis: &Diagnosis, (by, title, unit): &(&str, &'static str, &str), limit: f64) -> Option<By> {
    let mut cells: Vec<&Cell> = diagnosis.cells.iter().filter(|cell| cell.by == *by && !is_empty(cell)).collect();
    cells.sort_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal));
    if cells.len() < 2 {
        return None;
    }
    let mut plot = Plot::new();
    let mut places: Option<Vec<String>> = None;
    for (channel, colour) in [("scalar", SCALAR), ("fluxgate", FLUXGATE), ("firmware", SCALAR)] {
        let own: Vec<&Cell> = cells.iter().copied().filter(|cell| cell.channel == channel).collect();
        if own.is_empty() {
            continue;
        }
        let names: Vec<String> = own.iter().map(|cell| tick(cell)).collect();
        // The sensors' ranges differ in the last digit, for their valid rows do: they share their places all the same.
        let is_range = own.iter().all(|cell| range(&cell.cell).is_some());
        let shared = places.as_ref().filter(|places| is_range && places.len() == own.len());
        let at = shared.cloned().unwrap_or(names);
        plot.add_trace(bars(channel, &own, at.clone(), colour, limit));
        places = Some(at);
    }
    let layout = layout().bar_mode(BarMode::Stack).x_axis(axis(unit)).y_axis(axis("share of the gap, %"));
    plot.set_layout(layout);
    let also = json!({
        "xaxis": {"type": "category", "tickangle": 0, "dtick": each(&places.unwrap_or_default()), "tickfont": {"size": 11}, "title": {"font": {"size": 12}, "standoff": 6}},
        "yaxis": {"rangemode": "tozero", "title": {"font": {"size": 12}}},
        "margin": {"l": 52},
    });
    let chart = Chart::picture(&format!("map-{by}"), &format!("Share of the gap by {by}"), 250, plot, also);
    Some(By { title, note: note(&cells, limit), chart })
}

/// Every how many-th place has room for its name: all of them, or times far into a day would run into each other.
fn each(places: &[String]) -> usize {
    let longest = |place: &String| place.split("<br>").map(|line| line.chars().count()).max().unwrap_or(0);
    places.iter().map(longest).sum::<usize>().div_ceil(LETTERS).max(1)
}

/// Bars of one sensor at places on the axis.
fn bars(channel: &str, cells: &[&Cell], at: Vec<String>, colour: &'static str, limit: f64) -> Box<Bar<String, f64>> {
    let colours = cells.iter().map(|cell| if cell.p_value < limit { colour } else { NOT_SIGNIFICANT }).collect();
    let hover = |cell: &&Cell| {
        let share = percent(cell.excess_share);
        format!("{}, {}: {share}, {}", plain(&named(cell)), cell.channel, chance(cell.p_value))
    };
    Bar::new(at, cells.iter().map(|cell| rounded(100.0 * cell.excess_share, 2)).collect())
        .name(channel)
        .marker(Marker::new().color_array(colours))
        .hover_text_array(cells.iter().map(hover).collect())
        .hover_template("%{hovertext}<extra></extra>")
}

/// Where most of it is, of what noise does not explain.
fn note(cells: &[&Cell], limit: f64) -> String {
    let significant = cells.iter().filter(|cell| cell.p_value < limit);
    let Some(most) = significant.max_by(|a, b| a.excess_share.total_cmp(&b.excess_share)) else {
        return "Nothing here is more than noise.".into();
    };
    let channels = cells.iter().any(|cell| cell.channel != most.channel && cell.excess_share > 0.005);
    let channel = if channels && most.by != "channel" { format!(" ({})", most.channel) } else { String::new() };
    format!("Most: {}{channel}, {}.", named(most), percent(most.excess_share))
}

/// The chance as a reader wants it.
fn chance(p_value: f64) -> String {
    match p_value {
        p if p < 1e-12 => "p below 10⁻¹²".into(),
        p => format!("p = {}", three_digits(p)),
    }
}

/// A cell's name as on the axis: ranges without their unit, with three digits.
fn name(cell: &Cell) -> String {
    match range(&cell.cell) {
        Some([low, high]) => {
            let text = |value: f64| if cell.by == "time" { format!("{value:.0}") } else { short(value) };
            format!("{} to {}", text(low), text(high))
        }
        None => cell.cell.clone(),
    }
}

/// The name beneath a bar: a range in two lines, of ten stretches of time the beginning alone.
fn tick(cell: &Cell) -> String {
    let name = plain(&name(cell));
    match name.split_once(" to ") {
        Some((from, _)) if cell.by == "time" => from.into(),
        Some((from, to)) => format!("{from}<br>to {to}"),
        None => name,
    }
}

/// The name with its unit.
fn named(cell: &Cell) -> String {
    let unit = match (range(&cell.cell), cell.cell.split_once(' ')) {
        (Some(_), Some((_, unit))) => format!(" {}", unit.replace("degC", "°C").replace("deg", "°")),
        _ => String::new(),
    };
    name(cell) + &unit
}

/// A range without width holds no rows of its own: the sensor does not know what it is told apart by.
fn is_empty(cell: &Cell) -> bool {
    range(&cell.cell).is_some_and(|[low, high]| low >= high)
}

/// The ends of "0.1-0.25 Hz"; either may be negative.
fn range(cell: &str) -> Option<[f64; 2]> {
    let numbers = cell.split(' ').next()?;
    let dash = numbers.match_indices('-').find(|(at, _)| *at > 0)?.0;
    Some([numbers[..dash].parse().ok()?, numbers[dash + 1..].parse().ok()?])
}

/// Along the axis: by size, round the compass, or by name.
fn order(cell: &Cell) -> (f64, String) {
    let sector = SECTORS.iter().position(|sector| *sector == cell.cell).map(|index| index as f64);
    let low = range(&cell.cell).map(|[low, _]| low);
    (low.or(sector).unwrap_or(0.0), cell.cell.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(by: &'static str, name: &str, excess_share: f64, p_value: f64) -> Cell {
        Cell { by, cell: name.into(), channel: "scalar", excess_share, p_value }
    }

    #[test]
    fn cells_are_named_and_ordered_as_on_an_axis() {
        assert_eq!(name(&cell("amplitude", "-165.507-12.149 nT", 0.5, 0.0)), "−166 to 12.1");
        assert_eq!(name(&cell("band", "0.25-0.5 Hz", 0.5, 0.0)), "0.25 to 0.5");
        assert_eq!(name(&cell("load", "pump on", 0.5, 0.0)), "pump on");
        assert!(
            order(&cell("temperature", "-3.0--1.5 degC", 0.5, 0.0))
                < order(&cell("temperature", "-1.5-2.0 degC", 0.5, 0.0))
        );
        assert!(order(&cell("heading", "NE", 0.5, 0.0)) < order(&cell("heading", "E", 0.5, 0.0)));
    }

    #[test]
    fn only_what_is_more_than_noise_is_pointed_at() {
        let (loud, quiet) = (cell("band", "1-2 Hz", 0.2, 1e-9), cell("band", "2-5 Hz", 0.8, 0.3));
        assert_eq!(note(&[&loud, &quiet], 1e-3), "Most: 1 to 2 Hz, 20 %.");
        assert_eq!(note(&[&quiet], 1e-3), "Nothing here is more than noise.");
    }
}
