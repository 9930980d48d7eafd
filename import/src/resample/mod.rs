//! Faster recordings at 10 Hz: filtered against aliases, without delay, gaps kept.

mod filtered;
mod grid;
mod low_pass;

use std::sync::Arc;

use towmag_recording::{Column, ColumnKind};

use self::grid::Grid;
use crate::between::led;
use crate::draft::{Draft, DraftColumn, DraftValues};
use crate::rate::Sampling;

/// The rows of a 10 Hz grid within the stretches of the source.
pub(crate) fn resample(draft: &Draft, sampling: &Sampling) -> Draft {
    let grid = Grid::of(&draft.time_s, sampling);
    let columns: Vec<DraftColumn> = draft.columns.iter().map(|column| self::column(&grid, draft, column)).collect();
    let invalid = (0..grid.time_s.len()).map(|row| grid.nearby(row).any(|source| draft.invalid[source])).collect();
    Draft { time_s: grid.time_s, invalid, columns, is_utc: draft.is_utc, is_clock: draft.is_clock }
}

fn column(grid: &Grid<'_>, draft: &Draft, column: &DraftColumn) -> DraftColumn {
    let rows = 0..grid.time_s.len();
    let values = match &column.values {
        DraftValues::Labels(labels) => {
            DraftValues::Labels(rows.map(|row| labels[grid.nearest(row)].clone()).collect::<Vec<Arc<str>>>())
        }
        DraftValues::Numbers(numbers) => DraftValues::Numbers(match way(column, numbers) {
            Way::Nearest => rows.map(|row| numbers[grid.nearest(row)]).collect(),
            Way::Lowest => rows.map(|row| grid.lowest(row, numbers)).collect(),
            Way::LedOn => led(&grid.time_s, grid.source_s, numbers, false),
            Way::Filtered => {
                let usable = |source: usize| !draft.invalid[source] || column.known != Some(Column::Scalar);
                rows.map(|row| grid.filtered(row, numbers, usable)).collect()
            }
            Way::FilteredAngle => grid.filtered_angle(numbers),
        }),
    };
    DraftColumn { values, is_made: true, ..column.clone() }
}

/// How the rows of a column become fewer.
enum Way {
    Nearest,
    Lowest,
    LedOn,
    Filtered,
    FilteredAngle,
}

fn way(column: &DraftColumn, numbers: &[f64]) -> Way {
    let present = numbers.iter().filter(|number| number.is_finite()).count();
    match column.known {
        Some(known) if known.spec().kind == ColumnKind::Flag => Way::Lowest,
        _ if present * 10 < numbers.len() * 7 => Way::LedOn,
        Some(Column::Heading | Column::Roll) => Way::FilteredAngle,
        Some(_) => Way::Filtered,
        None if column.name.starts_with("current_") => Way::Filtered,
        // Nobody knows what it is: a counter must stay one.
        None => Way::Nearest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resampled(rate_hz: f64, signal: impl Fn(f64) -> f64, spoil: impl Fn(usize, &mut Draft)) -> Draft {
        let time_s: Vec<f64> = (0..(60.0 * rate_hz) as usize).map(|row| row as f64 / rate_hz).collect();
        let numbers = time_s.iter().map(|t| signal(*t)).collect();
        let column = DraftColumn {
            name: "scalar_nT".into(),
            known: Some(Column::Scalar),
            values: DraftValues::Numbers(numbers),
            is_made: false,
        };
        let mut draft = Draft { invalid: vec![false; time_s.len()], time_s, columns: vec![column], ..Draft::default() };
        (0..draft.len()).for_each(|row| spoil(row, &mut draft));
        let sampling = Sampling::of(&draft.time_s).unwrap();
        resample(&draft, &sampling)
    }

    /// Largest difference from a signal, 3 s from the ends on.
    fn off(draft: &Draft, signal: impl Fn(f64) -> f64) -> f64 {
        let numbers = draft.numbers(Column::Scalar).unwrap();
        let inner = (0..draft.len()).filter(|&row| (3.0..57.0).contains(&draft.time_s[row]));
        inner.map(|row| (numbers[row] - signal(draft.time_s[row])).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn what_is_slow_passes_without_delay_and_what_is_fast_is_gone() {
        for rate_hz in [20.0, 40.0, 100.0, 160.0, 1000.0] {
            let slow = |t: f64| 50_000.0 + 10.0 * (2.0 * t).sin() + 3.0 * (24.0 * t).cos();
            let draft = resampled(rate_hz, slow, |_, _| {});
            assert!(off(&draft, slow) < 1e-3, "{rate_hz}: {}", off(&draft, slow));
            assert!((draft.time_s[1] - 0.1).abs() < 1e-12 && draft.len() >= 599);
            for tone_hz in [5.1, 6.0, 8.0, 9.9, 0.45 * rate_hz].into_iter().filter(|hz| *hz < rate_hz / 2.0) {
                let tone = |t: f64| 50_000.0 + 10.0 * (2.0 * std::f64::consts::PI * tone_hz * t).sin();
                let alias = off(&resampled(rate_hz, tone, |_, _| {}), |_| 50_000.0);
                assert!(alias < 1e-3, "{tone_hz} Hz at {rate_hz}: {alias}");
            }
        }
    }

    #[test]
    fn gaps_stay_and_what_is_invalid_is_left_out() {
        let draft = resampled(
            100.0,
            |_| 50_000.0,
            |row, draft| {
                if row >= 3000 {
                    draft.time_s[row] += 7.0;
                }
                if (1000..1030).contains(&row) {
                    draft.invalid[row] = true;
                    if let DraftValues::Numbers(numbers) = &mut draft.columns[0].values {
                        numbers[row] = 99_999.0;
                    }
                }
            },
        );
        assert!(draft.time_s.iter().all(|t| !(30.1..36.9).contains(t)));
        let scalar = draft.numbers(Column::Scalar).unwrap();
        assert!(scalar.iter().all(|value| value.is_nan() || (value - 50_000.0).abs() < 1e-6));
        let invalid = draft.invalid.iter().filter(|invalid| **invalid).count();
        assert!((3..=5).contains(&invalid), "{invalid}");
    }
}
