//! An effect that a user wrote, as every other one.

use std::borrow::Cow;

use towmag_effect_file::{BoundFormula, EffectFile, Kind, Source};

use super::course::Course;
use super::filter::filtered;
use super::spec::spec;
use super::trial_values::trial_values;
use crate::effects::parts::{flux_by_row, flux_retimed, retimed, scalar_by_row};
use crate::effects::{Change, Channel, Draw, Effect, Spec};
use crate::simulator::signals::Signals;

/// An effect that a user wrote.
#[derive(Debug)]
pub struct FileEffect {
    file: EffectFile,
    spec: &'static Spec,
}

impl FileEffect {
    /// Of a file that has been checked.
    pub fn new(file: EffectFile) -> Self {
        Self { spec: spec(&file), file }
    }

    /// What the user wrote.
    pub fn file(&self) -> &EffectFile {
        &self.file
    }

    /// What it needs and a recording does not have, in the user's words.
    pub fn lacks(&self, signals: &Signals) -> Option<&str> {
        let is_there = |source: &&Source| match source {
            Source::Variable(variable) => Course::at_rows(signals, *variable).is_some(),
            Source::Column(name) => signals.column(name).is_some(),
            Source::Parameter(_) | Source::Input(_) => true,
        };
        self.file.sources().find(|source| !is_there(source)).map(|source| match source {
            Source::Variable(variable) => variable.name(),
            Source::Column(name) => name,
            Source::Parameter(_) | Source::Input(_) => "",
        })
    }

    /// Where a formula has no value at one of some values of the parameters, in a row that is `usable`.
    fn row_without_value(&self, signals: &Signals, usable: &[bool], parameters: &[f64]) -> Option<(usize, &str)> {
        let courses = self.courses(signals, parameters);
        self.file.formulas.iter().find_map(|formula| {
            let values = self.values(signals, formula, &courses, parameters);
            let row = values.iter().zip(usable).position(|(value, usable)| *usable && !value.is_finite())?;
            Some((row, formula.text.as_str()))
        })
    }

    fn told(&self, parameters: &[f64]) -> String {
        let one = |(parameter, value): (&towmag_effect_file::Parameter, &f64)| format!("{} = {value}", parameter.name);
        let all: Vec<String> = self.file.parameters.iter().zip(parameters).map(one).collect();
        if all.is_empty() { "no parameter".into() } else { all.join(", ") }
    }

    /// The inputs at values of the parameters. What a recording lacks is 0: [`Self::applies_to`] asks before.
    fn courses<'a>(&self, signals: &'a Signals, parameters: &[f64]) -> Vec<Course<'a>> {
        let mut courses: Vec<Course<'a>> = Vec::with_capacity(self.file.inputs.len());
        for input in &self.file.inputs {
            let of = |source: &Source| match source {
                Source::Input(index) => Some(courses[*index].clone()),
                Source::Variable(variable) => Course::of(signals, *variable),
                Source::Column(name) => signals.column(name).map(|rows| Course { rows: rows.into(), dense: None }),
                Source::Parameter(_) => None,
            };
            let nothing = || Course { rows: vec![0.0; signals.len()].into(), dense: None };
            let own = match input.of.alone() {
                Some(source) => of(source).unwrap_or_else(nothing),
                None => {
                    let sources = input.of.sources.iter().map(|source| of(source).unwrap_or_else(nothing));
                    Course::of_all(signals, &sources.collect::<Vec<_>>(), &|values| input.of.eval(values))
                }
            };
            courses.push(filtered(signals, &own, input.filter, parameters));
        }
        courses
    }

    /// A formula at every row.
    fn values(
        &self,
        signals: &Signals,
        formula: &BoundFormula,
        courses: &[Course<'_>],
        parameters: &[f64],
    ) -> Vec<f64> {
        let column = |source: &Source| -> Column<'_> {
            match source {
                Source::Parameter(index) => Column::Same(parameters[*index]),
                Source::Input(index) => Column::Rows(Cow::Borrowed(&courses[*index].rows[..])),
                Source::Variable(variable) => {
                    Course::at_rows(signals, *variable).map_or(Column::Same(0.0), Column::Rows)
                }
                Source::Column(name) => {
                    signals.column(name).map_or(Column::Same(0.0), |rows| Column::Rows(Cow::Borrowed(rows)))
                }
            }
        };
        let columns: Vec<Column<'_>> = formula.sources.iter().map(column).collect();
        let mut at_row = vec![0.0; columns.len()];
        let value = |row: usize| {
            at_row.iter_mut().zip(&columns).for_each(|(value, column)| *value = column.at(row));
            formula.eval(&at_row)
        };
        (0..signals.len()).map(value).collect()
    }

    /// Every formula at every row; 0 where one has no value, as in a row that is not used.
    fn all_values(&self, signals: &Signals, parameters: &[f64]) -> Vec<Vec<f64>> {
        let courses = self.courses(signals, parameters);
        let of = |formula: &BoundFormula| {
            let mut values = self.values(signals, formula, &courses, parameters);
            values.iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
            values
        };
        self.file.formulas.iter().map(of).collect()
    }

    fn change_of_scalar(&self, signals: &Signals, value: &[f64]) -> Change {
        match self.file.kind {
            Kind::Additive => scalar_by_row(signals, |row| value[row]),
            Kind::Multiplicative => scalar_by_row(signals, |row| value[row] * signals.scalar_at_rows_nt()[row]),
            Kind::Delay => retimed(signals, |row, time_s| time_s - value[row]),
        }
    }

    fn change_of_flux(&self, signals: &Signals, values: &[Vec<f64>]) -> Change {
        match self.file.kind {
            Kind::Additive => flux_by_row(signals, |row, _| [0, 1, 2].map(|i| values[i][row])),
            Kind::Multiplicative => flux_by_row(signals, |row, f| [0, 1, 2].map(|i| values[i][row] * f[i])),
            Kind::Delay => flux_retimed(signals, |row, i, time_s| time_s - values[i][row]),
        }
    }
}

/// A name of a formula over the rows.
enum Column<'a> {
    Same(f64),
    Rows(Cow<'a, [f64]>),
}

impl Column<'_> {
    fn at(&self, row: usize) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Rows(rows) => rows[row],
        }
    }
}

impl Effect for FileEffect {
    fn spec(&self) -> &'static Spec {
        self.spec
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let values = self.all_values(signals, parameters);
        match self.spec.channel {
            Channel::Scalar => self.change_of_scalar(signals, &values[0]),
            Channel::Fluxgate => self.change_of_flux(signals, &values),
        }
    }

    /// The file's own values; halfway to an end in place of a 0 at which nothing would be seen.
    fn typical(&self, _: &Signals) -> Vec<f64> {
        let value = |parameter: &towmag_effect_file::Parameter| match parameter.default == 0.0 && !parameter.is_linear {
            true if parameter.high > -parameter.low => 0.5 * parameter.high,
            true => 0.5 * parameter.low,
            false => parameter.default,
        };
        self.file.parameters.iter().map(value).collect()
    }

    fn defaults(&self) -> Option<Vec<f64>> {
        Some(self.file.parameters.iter().map(|parameter| parameter.default).collect())
    }

    fn columns(&self) -> Vec<&str> {
        self.file.columns()
    }

    /// The row and the formula where it has no value, or what the recording lacks.
    fn refusal(&self, signals: &Signals, usable: &[bool], parameters: Option<&[f64]>) -> Option<String> {
        let (name, file) = (&self.file.name, &self.file.file);
        if let Some(lacks) = self.lacks(signals) {
            return Some(format!("{file}: {name} needs {lacks}, which the recording does not have"));
        }
        let tried = parameters.map_or_else(|| trial_values(&self.file), |at| vec![at.to_vec()]);
        tried.iter().find_map(|at| {
            let (row, formula) = self.row_without_value(signals, usable, at)?;
            let (time_s, with) = (signals.recording_time_s(row), self.told(at));
            Some(format!(
                "{file}: {name} has no finite value in row {}, at {time_s} s, with {with}: {formula}",
                row + 1
            ))
        })
    }

    fn applies_to(&self, signals: &Signals) -> bool {
        self.lacks(signals).is_none()
    }
}
