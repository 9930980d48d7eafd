//! The course of a variable over a recording.

use std::borrow::Cow;

use towmag_effect_file::Variable;

use crate::effects::parts::flux_on_grid_nt;
use crate::simulator::signals::{Grid, Segment, Signals};

/// The course of a variable: one value a row, and between the rows where it is known there.
#[derive(Clone, Debug)]
pub(super) struct Course<'a> {
    pub(super) rows: Cow<'a, [f64]>,
    /// On the points of the grid that belong to each segment; none for what is only known at the rows.
    pub(super) dense: Option<Vec<Vec<f64>>>,
}

impl<'a> Course<'a> {
    /// At the rows alone; none where the recording does not have it.
    pub(super) fn at_rows(signals: &'a Signals, variable: Variable) -> Option<Cow<'a, [f64]>> {
        let rows = signals.rows();
        let component = |vectors: &[[f64; 3]], i: usize| Cow::Owned(vectors.iter().map(|v| v[i]).collect());
        Some(match variable {
            Variable::Direction(i) => component(&rows.direction, i),
            Variable::DirectionRate(i) => component(&rows.direction_rate, i),
            Variable::Field => Cow::Borrowed(&rows.field_nt[..]),
            Variable::Scalar => Cow::Borrowed(signals.scalar_at_rows_nt()),
            Variable::Flux(i) => component(&rows.flux_nt, i),
            Variable::Time => Cow::Borrowed(signals.epochs_s()),
            Variable::RecordingTime => (0..signals.len()).map(|row| signals.recording_time_s(row)).collect(),
            Variable::Depth => Cow::Borrowed(signals.trajectory().depth_m.as_deref()?),
            Variable::Temperature => Cow::Borrowed(signals.trajectory().temperature_deg_c.as_deref()?),
        })
    }

    /// With what is known of it between the rows; none where the recording does not have it.
    pub(super) fn of(signals: &'a Signals, variable: Variable) -> Option<Self> {
        let rows = Self::at_rows(signals, variable)?;
        let grid = signals.grid();
        let trajectory = signals.trajectory();
        let component = |vectors: &[[f64; 3]], i: usize| vectors.iter().map(|v| v[i]).collect::<Vec<f64>>();
        let all: Option<Cow<'_, [f64]>> = match variable {
            Variable::Direction(i) => Some(component(&trajectory.direction, i).into()),
            Variable::DirectionRate(i) => Some(component(&grid.derivative(&trajectory.direction), i).into()),
            Variable::Field => Some(Cow::Borrowed(&trajectory.field_nt)),
            Variable::Scalar => Some(Cow::Borrowed(signals.scalar_nt())),
            Variable::Flux(i) => Some(component(&flux_on_grid_nt(signals), i).into()),
            Variable::Time | Variable::RecordingTime | Variable::Depth | Variable::Temperature => None,
        };
        let of_segments = |all: Cow<'_, [f64]>| {
            let points = signals.segments().iter().map(|segment| signals.points(segment));
            points.map(|points| all[points].to_vec()).collect()
        };
        Some(Self { rows, dense: all.map(of_segments) })
    }

    /// What a formula makes of some, known between the rows where all of them are; 0 where it has no value.
    pub(super) fn of_all(signals: &Signals, all: &[Self], value: &dyn Fn(&[f64]) -> f64) -> Self {
        let each = |len: usize, at: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let mut values = vec![0.0; all.len()];
            let mut one = |row: usize| {
                values.iter_mut().enumerate().for_each(|(k, value)| *value = at(k, row));
                Some(value(&values)).filter(|value| value.is_finite()).unwrap_or(0.0)
            };
            (0..len).map(&mut one).collect()
        };
        let dense: Option<Vec<&Vec<Vec<f64>>>> = all.iter().map(|one| one.dense.as_ref()).collect();
        let between = dense.filter(|dense| !dense.is_empty()).map(|dense| {
            let segments = 0..signals.segments().len();
            segments.map(|s| each(dense[0][s].len(), &|k, point| dense[k][s][point])).collect()
        });
        Self { rows: each(signals.len(), &|k, row| all[k].rows[row]).into(), dense: between }
    }
}

/// The grid of the points of a segment alone.
pub(super) fn own_grid(signals: &Signals, segment: &Segment) -> Grid {
    let points = signals.points(segment);
    let grid = signals.grid();
    Grid { start_s: grid.time_s(points.start), len: points.len(), rate_hz: grid.rate_hz }
}
