//! A column of the recording that a user suspects. `s' = s + g i(t - delay)`, or as a moment in the body
//! `s' = s + i(t - delay) g . c`.

use super::parts::{between_rows, dot, linear, real, scalar_by_row};
use crate::effects::{Change, Draw, Effect, HeldOut, Kind, Parameter, Recorded, RecordedForm, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// A recorded column, in one of the forms in which it may act.
#[derive(Debug)]
pub struct Regressor {
    column: String,
    form: RecordedForm,
    spec: &'static Spec,
}

/// How much later than the column the field may change, s, and how far apart delays are tried: a row.
const DELAY_S: f64 = 2.0;
const ROW_S: f64 = 0.1;
const TRIED: i32 = 20;
/// Gains are accepted up to this, and plausible: nobody knows the unit.
const ANY_GAIN: f64 = 1e12;

const GAIN: Parameter = linear("gain_nT_per_unit", "nT/unit", ANY_GAIN, ANY_GAIN);
const X: Parameter = linear("x_nT_per_unit", "nT/unit", ANY_GAIN, ANY_GAIN);
const Y: Parameter = linear("y_nT_per_unit", "nT/unit", ANY_GAIN, ANY_GAIN);
const Z: Parameter = linear("z_nT_per_unit", "nT/unit", ANY_GAIN, ANY_GAIN);
/// Half a row is half the width of its difference quotient: a column is known at the rows.
const DELAY: Parameter =
    real("delay_s", "s", [-DELAY_S, DELAY_S], [-DELAY_S, DELAY_S], Kind::Differentiable(Step::fixed(0.5 * ROW_S)));

impl Regressor {
    /// A column in every form.
    pub fn forms(column: &str) -> [Self; 2] {
        [RecordedForm::Additive, RecordedForm::Moment].map(|form| Self::new(column, form))
    }

    fn new(column: &str, form: RecordedForm) -> Self {
        let (name, title, parameters): (String, String, &[Parameter]) = match form {
            RecordedForm::Additive => (format!("regressor:{column}"), format!("the column {column}"), &[GAIN, DELAY]),
            RecordedForm::Moment => (
                format!("regressor_moment:{column}"),
                format!("the column {column} as a moment in the body"),
                &[X, Y, Z, DELAY],
            ),
        };
        Self { spec: Box::leak(Box::new(spec(name, title, parameters))), column: column.into(), form }
    }

    /// The column at each row, so much later.
    fn late(&self, signals: &Signals, delay_s: f64) -> Vec<f64> {
        let Some(column) = signals.column(&self.column) else { return vec![0.0; signals.len()] };
        let of_segment = |segment: &crate::simulator::signals::Segment| {
            let (times_s, values) = (&signals.epochs_s()[segment.epochs.clone()], &column[segment.epochs.clone()]);
            times_s.iter().map(|time_s| between_rows(times_s, values, time_s - delay_s)).collect::<Vec<f64>>()
        };
        signals.segments().iter().flat_map(of_segment).collect()
    }
}

/// Kept until the program ends, once for each column that it is given: results name effects by words that are always there.
fn spec(name: String, title: String, parameters: &'static [Parameter]) -> Spec {
    let start = |row: i32| {
        let mut start = vec![0.0; parameters.len()];
        start[parameters.len() - 1] = ROW_S * f64::from(row);
        &*start.leak()
    };
    Spec {
        name: name.leak(),
        title: title.leak(),
        what: "a column of the recording that the reading follows",
        origin: "what the column was asked for with --regressor",
        source: "no bounds: its unit is not known",
        model: "`s' = s + g i(t - delay)`, or `s' = s + i(t - delay) g . c`",
        parameters,
        search: Search::Profile { starts: (-TRIED..=TRIED).map(start).collect::<Vec<_>>().leak() },
        held_out: HeldOut::MustExplain,
        ..Spec::BASE
    }
}

impl Effect for Regressor {
    fn spec(&self) -> &'static Spec {
        self.spec
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        match (self.form, parameters) {
            (RecordedForm::Additive, &[gain, delay_s]) => {
                Change::of_scalar(self.late(signals, delay_s).into_iter().map(|value| gain * value).collect())
            }
            (RecordedForm::Moment, &[x, y, z, delay_s]) => {
                let late = self.late(signals, delay_s);
                scalar_by_row(signals, |row| late[row] * dot([x, y, z], signals.rows().direction[row]))
            }
            _ => unreachable!("as many parameters as the form has"),
        }
    }

    fn columns(&self) -> Vec<&str> {
        vec![&self.column]
    }

    fn recorded(&self) -> Option<Recorded> {
        Some(Recorded { column: self.column.clone(), form: self.form, is_asked: true })
    }

    fn refusal(&self, signals: &Signals, _: &[bool], _: Option<&[f64]>) -> Option<String> {
        let is_there = signals.column(&self.column).is_some();
        (!is_there)
            .then(|| format!("--regressor {}: no such column of numbers, or over a tenth is missing", self.column))
    }

    fn applies_to(&self, signals: &Signals) -> bool {
        signals.column(&self.column).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{direction, signals_of, trajectory};

    fn signals() -> Signals {
        let mut trajectory = trajectory();
        let ramp = trajectory.epochs_s.iter().map(|t| 3.0 * t).collect();
        trajectory.columns = vec![("winch_rpm".into(), ramp)];
        signals_of(trajectory)
    }

    #[test]
    fn it_follows_the_column_late_in_both_forms() {
        let signals = signals();
        let [additive, moment] = Regressor::forms("winch_rpm");
        let nt = additive.change(&signals, &[0.5, 0.7], &mut no_draw()).scalar_nt;
        let nt_of_moment = moment.change(&signals, &[1.0, -2.0, 3.0, -0.25], &mut no_draw()).scalar_nt;
        for (row, time_s) in signals.epochs_s().iter().enumerate().skip(7).take(580) {
            assert!((nt[row] - 0.5 * 3.0 * (time_s - 0.7)).abs() < 1e-9);
            let [x, y, z] = direction(*time_s);
            assert!((nt_of_moment[row] - 3.0 * (time_s + 0.25) * (x - 2.0 * y + 3.0 * z)).abs() < 2e-3);
        }
    }

    #[test]
    fn a_column_that_is_not_there_is_refused() {
        let signals = signals();
        let [absent, _] = Regressor::forms("pump_rpm");
        assert!(absent.refusal(&signals, &[], None).unwrap().contains("--regressor pump_rpm"));
        let [there, _] = Regressor::forms("winch_rpm");
        assert_eq!(there.refusal(&signals, &[], None), None);
    }
}
