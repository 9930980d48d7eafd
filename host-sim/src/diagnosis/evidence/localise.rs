//! Where the gap lies: excess of the whitened residual over noise, by band, time, heading and whatever was recorded.

use serde::Serialize;
use towmag_fourier::{Complex, Planner};

use crate::diagnosis::policy::RATE_HZ;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::search::log_tail;
use crate::effects::Channel;

/// Edges of the bands, Hz.
const BANDS_HZ: [f64; 7] = [0.04, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0];
/// Parts of the time that are told apart.
const TIMES: usize = 10;
/// Headings that are told apart, from north by east.
const HEADINGS: [&str; 8] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];

/// A cell of the map.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// What the cells are told apart by.
    pub by: &'static str,
    /// Which cell.
    pub cell: String,
    /// `scalar`, `fluxgate` or `firmware`.
    pub channel: &'static str,
    /// Share of the excess over noise of all cells told apart in the same way.
    pub excess_share: f64,
    /// Chance of as much excess from noise alone.
    pub p_value: f64,
}

/// A cell before the shares are known.
pub(crate) struct CellExcess {
    by: &'static str,
    cell: String,
    channel: &'static str,
    /// Sum of whitened squares over what noise has.
    excess: f64,
    p_value: f64,
}

/// Whitened squares of a cell: how many, and their sum.
#[derive(Clone, Copy, Default)]
struct Squares {
    count: f64,
    sum: f64,
}

impl Squares {
    fn of(squares: impl Iterator<Item = f64>) -> Self {
        squares.fold(Self::default(), |all, square| Self { count: all.count + 1.0, sum: all.sum + square })
    }

    fn cell(self, by: &'static str, cell: String, channel: &'static str) -> CellExcess {
        let p_value = if self.count > 0.0 { log_tail(self.count, self.sum).exp() } else { 1.0 };
        CellExcess { by, cell, channel, excess: self.sum - self.count, p_value }
    }
}

/// Name of a channel.
pub(crate) fn channel_name(channel: Channel) -> &'static str {
    match channel {
        Channel::Scalar => "scalar",
        Channel::Fluxgate => "fluxgate",
    }
}

/// All cells of a channel; `whitened` has unit variance where there is noise alone.
pub(crate) fn cells(problem: &RegressionProblem<'_>, table: &Prepared, whitened: &[f64]) -> Vec<CellExcess> {
    let channel = channel_name(problem.channel);
    let mut map = Map { channel, rows: problem.whitening.rows().collect(), whitened, cells: Vec::new() };
    map.cells.push(Squares::of(whitened.iter().map(|z| z * z)).cell("channel", channel.into(), channel));
    map.cells.extend(bands(problem, whitened, channel));
    map.by_time(&table.time_s);
    let heading = headings(table, problem);
    let sector = |row: usize| heading[row].map(|deg| ((deg / 45.0).round() as usize) % HEADINGS.len());
    map.by("heading", HEADINGS.map(String::from).to_vec(), &sector);
    let signals = &problem.signals;
    let speed = |r: &[f64; 3]| (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt().to_degrees();
    map.by_quartiles("attitude_rate", "deg/s", &signals.rows().direction_rate.iter().map(speed).collect::<Vec<_>>());
    let interference_nt = |row| signals.interference(row).total_nt();
    map.by_quartiles("amplitude", "nT", &(0..signals.len()).map(interference_nt).collect::<Vec<_>>());
    for (name, unit, values) in [("depth", "m", &table.depth_m), ("temperature", "degC", &table.temperature_deg_c)] {
        values.iter().for_each(|values| map.by_quartiles(name, unit, values));
    }
    table.currents_a.iter().for_each(|(load, current_a)| map.by_load(load, current_a));
    map.cells
}

/// The map while it is made.
struct Map<'a> {
    channel: &'static str,
    /// The row of each sample.
    rows: Vec<usize>,
    whitened: &'a [f64],
    cells: Vec<CellExcess>,
}

impl Map<'_> {
    /// Cells with these labels; `of` is the index of a row's label.
    fn by(&mut self, name: &'static str, labels: Vec<String>, of: &dyn Fn(usize) -> Option<usize>) {
        for (index, label) in labels.into_iter().enumerate() {
            let samples = self.rows.iter().zip(self.whitened).filter(|(row, _)| of(**row) == Some(index));
            self.cells.push(Squares::of(samples.map(|(_, z)| z * z)).cell(name, label, self.channel));
        }
    }

    fn by_time(&mut self, time_s: &[f64]) {
        let (first_s, last_s) = (time_s[0], time_s[time_s.len() - 1]);
        let part_s = ((last_s - first_s) / TIMES as f64).max(1e-9);
        let edge_s = |k: usize| first_s + part_s * k as f64;
        let labels = (0..TIMES).map(|k| format!("{:.0}-{:.0} s", edge_s(k), edge_s(k + 1))).collect();
        self.by("time", labels, &|row| Some((((time_s[row] - first_s) / part_s) as usize).min(TIMES - 1)));
    }

    fn by_quartiles(&mut self, name: &'static str, unit: &str, values: &[f64]) {
        let edges = quartiles(&self.rows, values);
        let labels = (0..4).map(|k| format!("{:.3}-{:.3} {unit}", edges[k], edges[k + 1])).collect();
        self.by(name, labels, &|row| Some((1..4).filter(|&k| values[row] > edges[k]).count()));
    }

    fn by_load(&mut self, load: &str, current_a: &[f64]) {
        let [lowest_a, .., highest_a] = quartiles(&self.rows, current_a);
        let middle_a = 0.5 * (lowest_a + highest_a);
        let labels = vec![format!("{load} off"), format!("{load} on")];
        self.by("load", labels, &|row| Some(usize::from(current_a[row] > middle_a)));
    }
}

/// Shares of each way to tell cells apart sum to 1; largest first.
pub(crate) fn shares(cells: Vec<CellExcess>) -> Vec<Cell> {
    let total = |by: &str| cells.iter().filter(|cell| cell.by == by).map(|cell| cell.excess.max(0.0)).sum::<f64>();
    let count = |by: &str| cells.iter().filter(|cell| cell.by == by).count() as f64;
    let mut shares: Vec<Cell> = cells
        .iter()
        .map(|cell| {
            let total = total(cell.by);
            let excess_share = if total > 0.0 { cell.excess.max(0.0) / total } else { 1.0 / count(cell.by) };
            Cell { by: cell.by, cell: cell.cell.clone(), channel: cell.channel, excess_share, p_value: cell.p_value }
        })
        .collect();
    shares.sort_by(|a, b| b.excess_share.total_cmp(&a.excess_share));
    shares
}

/// Spectra of the whitened residual, block by block: flat, and 1, where there is noise alone. Each power is two squares.
fn bands(problem: &RegressionProblem<'_>, whitened: &[f64], channel: &'static str) -> Vec<CellExcess> {
    let mut bands = [Squares::default(); BANDS_HZ.len() - 1];
    let mut planner = Planner::new();
    for range in problem.whitening.ranges() {
        let mut spectrum: Vec<Complex<f64>> = whitened[range].iter().map(|z| Complex::new(*z, 0.0)).collect();
        let n = spectrum.len();
        planner.forward(n).process(&mut spectrum);
        for (k, value) in spectrum.iter().enumerate().take(n / 2).skip(1) {
            let hz = k as f64 * RATE_HZ / n as f64;
            if let Some(band) = (0..bands.len()).find(|&band| hz >= BANDS_HZ[band] && hz < BANDS_HZ[band + 1]) {
                bands[band].count += 2.0;
                bands[band].sum += 2.0 * value.norm_sqr() / n as f64;
            }
        }
    }
    let label = |band: usize| format!("{}-{} Hz", BANDS_HZ[band], BANDS_HZ[band + 1]);
    bands.into_iter().enumerate().map(|(band, squares)| squares.cell("band", label(band), channel)).collect()
}

/// Recorded headings, degrees, or those of the fluxgate's horizontal components as if the body were level.
fn headings(table: &Prepared, problem: &RegressionProblem<'_>) -> Vec<Option<f64>> {
    match &table.heading_deg {
        Some(heading) => heading.iter().map(|deg| Some(deg.rem_euclid(360.0))).collect(),
        None => {
            let of = |c: &[f64; 3]| Some((-c[1]).atan2(c[0]).to_degrees().rem_euclid(360.0));
            problem.signals.rows().direction.iter().map(of).collect()
        }
    }
}

/// Least, quartiles and largest of a column over some rows.
fn quartiles(rows: &[usize], values: &[f64]) -> [f64; 5] {
    let mut sorted: Vec<f64> = rows.iter().map(|&row| values[row]).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| sorted.get((share * last as f64) as usize).copied().unwrap_or(0.0))
}
