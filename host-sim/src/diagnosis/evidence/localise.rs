//! Where the gap lies: excess of the whitened residual over noise, by band, time, heading and whatever was recorded.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use serde::Serialize;

use crate::diagnosis::reconstruct::prepared::Table;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::search::log_tail;
use crate::effects::Channel;

/// Edges of the bands, Hz.
const BANDS_HZ: [f64; 7] = [0.04, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0];
/// Rows per second.
const RATE_HZ: f64 = 10.0;

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
pub(crate) struct Raw {
    by: &'static str,
    cell: String,
    channel: &'static str,
    excess: f64,
    p_value: f64,
}

/// Name of a channel.
pub(crate) fn channel_name(channel: Channel) -> &'static str {
    match channel {
        Channel::Scalar => "scalar",
        Channel::Fluxgate => "fluxgate",
    }
}

/// All cells of a channel; `whitened` has unit variance where there is noise alone.
pub(crate) fn cells(problem: &RegressionProblem<'_>, table: &Table, whitened: &[f64]) -> Vec<Raw> {
    let channel = channel_name(problem.channel);
    let rows: Vec<usize> = problem.whitening.rows().collect();
    let mut cells = vec![cell_of("channel", channel.into(), channel, whitened.iter().map(|z| z * z))];
    cells.extend(bands(problem, whitened, channel));
    let mut by = |name: &'static str, labels: Vec<String>, of: &dyn Fn(usize) -> Option<usize>| {
        for (index, label) in labels.into_iter().enumerate() {
            let squares = rows.iter().zip(whitened).filter(|(row, _)| of(**row) == Some(index)).map(|(_, z)| z * z);
            cells.push(cell_of(name, label, channel, squares));
        }
    };
    let time_s = &table.time_s;
    let (first_s, last_s) = (time_s[0], time_s[time_s.len() - 1]);
    let tenth_s = ((last_s - first_s) / 10.0).max(1e-9);
    let labels = (0..10)
        .map(|k| format!("{:.0}-{:.0} s", first_s + tenth_s * f64::from(k), first_s + tenth_s * f64::from(k + 1)));
    by("time", labels.collect(), &|row| Some((((time_s[row] - first_s) / tenth_s) as usize).min(9)));
    let heading = headings(table, problem);
    let names = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];
    by("heading", names.map(String::from).to_vec(), &|row| heading[row].map(|deg| ((deg / 45.0).round() as usize) % 8));
    let signals = problem.signals.rows();
    let rate: Vec<f64> =
        signals.direction_rate.iter().map(|r| (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt().to_degrees()).collect();
    let amplitude: Vec<f64> = signals.interference.iter().map(|parts| parts.total_nt()).collect();
    for (name, unit, values) in [
        ("attitude_rate", "deg/s", Some(&rate)),
        ("amplitude", "nT", Some(&amplitude)),
        ("depth", "m", table.depth_m.as_ref()),
        ("temperature", "degC", table.temperature_deg_c.as_ref()),
    ] {
        let Some(values) = values else { continue };
        let edges = quartiles(&rows, values);
        let labels = (0..4).map(|k| format!("{:.3}-{:.3} {unit}", edges[k], edges[k + 1])).collect();
        by(name, labels, &|row| Some((1..4).filter(|&k| values[row] > edges[k]).count()));
    }
    for (load, current_a) in &table.currents_a {
        let edges = quartiles(&rows, current_a);
        let middle = 0.5 * (edges[0] + edges[4]);
        by("load", vec![format!("{load} off"), format!("{load} on")], &|row| {
            Some(usize::from(current_a[row] > middle))
        });
    }
    cells
}

/// Shares of each way to tell cells apart sum to 1; largest first.
pub(crate) fn shares(raw: Vec<Raw>) -> Vec<Cell> {
    let total = |by: &str| raw.iter().filter(|cell| cell.by == by).map(|cell| cell.excess.max(0.0)).sum::<f64>();
    let count = |by: &str| raw.iter().filter(|cell| cell.by == by).count() as f64;
    let mut cells: Vec<Cell> = raw
        .iter()
        .map(|cell| {
            let total = total(cell.by);
            let excess_share = if total > 0.0 { cell.excess.max(0.0) / total } else { 1.0 / count(cell.by) };
            Cell { by: cell.by, cell: cell.cell.clone(), channel: cell.channel, excess_share, p_value: cell.p_value }
        })
        .collect();
    cells.sort_by(|a, b| b.excess_share.total_cmp(&a.excess_share));
    cells
}

fn cell_of(by: &'static str, cell: String, channel: &'static str, squares: impl Iterator<Item = f64>) -> Raw {
    let (mut count, mut sum) = (0.0, 0.0);
    for square in squares {
        count += 1.0;
        sum += square;
    }
    let p_value = if count > 0.0 { log_tail(count, sum).exp() } else { 1.0 };
    Raw { by, cell, channel, excess: sum - count, p_value }
}

/// Spectra of the whitened residual, block by block: flat, and 1, where there is noise alone.
fn bands(problem: &RegressionProblem<'_>, whitened: &[f64], channel: &'static str) -> Vec<Raw> {
    let mut sums = [(0.0, 0.0); BANDS_HZ.len() - 1];
    let mut planner = FftPlanner::new();
    for range in problem.whitening.ranges() {
        let mut spectrum: Vec<Complex<f64>> = whitened[range].iter().map(|z| Complex::new(*z, 0.0)).collect();
        let n = spectrum.len();
        planner.plan_fft_forward(n).process(&mut spectrum);
        for (k, value) in spectrum.iter().enumerate().take(n / 2).skip(1) {
            let hz = k as f64 * RATE_HZ / n as f64;
            if let Some(band) = (0..sums.len()).find(|&band| hz >= BANDS_HZ[band] && hz < BANDS_HZ[band + 1]) {
                sums[band].0 += 2.0;
                sums[band].1 += 2.0 * value.norm_sqr() / n as f64;
            }
        }
    }
    let label = |band: usize| format!("{}-{} Hz", BANDS_HZ[band], BANDS_HZ[band + 1]);
    let raw = |(band, (count, sum)): (usize, (f64, f64))| Raw {
        by: "band",
        cell: label(band),
        channel,
        excess: sum - count,
        p_value: if count > 0.0 { log_tail(count, sum).exp() } else { 1.0 },
    };
    sums.into_iter().enumerate().map(raw).collect()
}

/// Recorded headings, or what the fluxgate says of them, not levelled.
fn headings(table: &Table, problem: &RegressionProblem<'_>) -> Vec<Option<f64>> {
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
