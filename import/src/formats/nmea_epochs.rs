//! Sentences of the same time become a row.

use super::civil::{day_of, midnight_s};
use super::nmea_sentence::Reading;
use crate::source::{Clock, Facts, SourceColumn, SourceTable, Values};
use crate::stamp::DAY_S;

/// What of a reading a column holds.
type Part = fn(&Reading) -> Option<f64>;

/// Of the ship, not of the body: the name must not be that of the recording's depth.
pub(super) const WATER_DEPTH: &str = "water_depth_m";

const COLUMNS: [(&str, Part); 6] = [
    ("latitude_deg", |reading| reading.position_deg.map(|position| position.0)),
    ("longitude_deg", |reading| reading.position_deg.map(|position| position.1)),
    ("speed_m_per_s", |reading| reading.speed_m_per_s),
    ("course_deg", |reading| reading.course_deg),
    ("heading_deg", |reading| reading.heading_deg),
    (WATER_DEPTH, |reading| reading.water_depth_m),
];

/// A row.
#[derive(Clone, Copy, Debug)]
struct Epoch {
    line: u32,
    /// Since the midnight before the first row, as far as only times are known.
    time_s: f64,
    /// Seconds from 1970 to that midnight, as the last date before this row has it.
    origin_s: Option<f64>,
    reading: Reading,
}

/// Rows that grow by a sentence at a time.
#[derive(Debug, Default)]
pub(super) struct Epochs {
    rows: Vec<Epoch>,
    days: f64,
    origin_s: Option<f64>,
}

impl Epochs {
    /// What a sentence says. Without a time it belongs to the row before; before the first row it belongs to none.
    pub(super) fn add(&mut self, line: u32, reading: Reading) {
        let is_new = |time_s: f64| self.rows.last().and_then(|row| row.reading.time_s) != Some(time_s);
        if let Some(time_s) = reading.time_s.filter(|time_s| is_new(*time_s)) {
            self.begin(line, time_s);
        }
        if let Some(date_s) = reading.date.and_then(midnight_s) {
            self.origin_s = Some(date_s - self.days * DAY_S);
        }
        let origin_s = self.origin_s;
        if let Some(row) = self.rows.last_mut() {
            row.origin_s = origin_s;
            merge(&mut row.reading, reading);
        }
    }

    /// A time that falls by more than half a day is the next day's.
    fn begin(&mut self, line: u32, time_s: f64) {
        let before = self.rows.last().and_then(|row| row.reading.time_s);
        if before.is_some_and(|before| before - time_s > DAY_S / 2.0) {
            self.days += 1.0;
        }
        let reading = Reading { time_s: Some(time_s), ..Reading::default() };
        self.rows.push(Epoch { line, time_s: self.days * DAY_S + time_s, origin_s: None, reading });
    }

    /// The table, without rows that have a time alone, and without columns that no row fills.
    pub(super) fn table(mut self) -> SourceTable {
        // Rows before the first date are of the days before it.
        let first = self.rows.iter().find_map(|row| row.origin_s);
        self.rows.retain(|row| COLUMNS.iter().any(|(_, of)| of(&row.reading).is_some()));
        let times = self.rows.iter().map(|row| row.time_s + row.origin_s.or(first).unwrap_or(0.0)).collect();
        let date = first.and_then(day_of);
        let time =
            SourceColumn { name: "time".into(), unit: Some("s".into()), values: Values::Times(times), dummy: None };
        let column = |(name, of): (&str, Part)| {
            let numbers: Vec<f64> = self.rows.iter().map(|row| of(&row.reading).unwrap_or(f64::NAN)).collect();
            numbers.iter().any(|value| value.is_finite()).then(|| SourceColumn::numbers(name, numbers))
        };
        SourceTable {
            name: String::new(),
            rows: self.rows.len(),
            columns: std::iter::once(time).chain(COLUMNS.into_iter().filter_map(column)).collect(),
            places: self.rows.iter().map(|row| row.line).collect(),
            facts: Facts { clock: Clock::Utc, date, ..Facts::default() },
            notes: Vec::new(),
        }
    }
}

fn merge(row: &mut Reading, new: Reading) {
    row.position_deg = new.position_deg.or(row.position_deg);
    row.speed_m_per_s = new.speed_m_per_s.or(row.speed_m_per_s);
    row.course_deg = new.course_deg.or(row.course_deg);
    row.heading_deg = new.heading_deg.or(row.heading_deg);
    // The deeper of two depths of the same time is the one from the surface.
    row.water_depth_m = match (row.water_depth_m, new.water_depth_m) {
        (Some(one), Some(other)) => Some(one.max(other)),
        (one, other) => one.or(other),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time_s: f64) -> Reading {
        Reading { time_s: Some(time_s), speed_m_per_s: Some(2.0), ..Reading::default() }
    }

    fn table(readings: &[Reading]) -> (Vec<f64>, SourceTable) {
        let mut epochs = Epochs::default();
        for (line, reading) in (1..).zip(readings) {
            epochs.add(line, *reading);
        }
        let table = epochs.table();
        let Values::Times(times) = &table.columns[0].values else { panic!("{:?}", table.columns[0]) };
        (times.clone(), table)
    }

    #[test]
    fn sentences_of_a_time_are_one_row() {
        let heading = Reading { heading_deg: Some(90.0), ..Reading::default() };
        let depth = |depth| Reading { water_depth_m: Some(depth), ..Reading::default() };
        let fix = Reading { position_deg: Some((50.0, 7.0)), ..at(2.0) };
        let (times, table) = table(&[heading, at(1.0), depth(12.5), depth(12.0), at(2.0), heading, fix]);
        assert_eq!((times, &table.places[..]), (vec![1.0, 2.0], &[2, 5][..]));
        let names: Vec<_> = table.columns.iter().map(|column| &column.name[..]).collect();
        assert_eq!(names, ["time", "latitude_deg", "longitude_deg", "speed_m_per_s", "heading_deg", "water_depth_m"]);
        let numbers = |column: usize| format!("{:?}", table.columns[column].as_numbers().unwrap());
        assert_eq!([1, 4, 5].map(numbers), ["[NaN, 50.0]", "[NaN, 90.0]", "[12.5, NaN]"]);
    }

    #[test]
    fn dates_hold_across_midnight_and_for_rows_before_them() {
        let dated = |time_s, day| Reading { date: Some((2020, 9, day)), ..at(time_s) };
        let (times, table) =
            table(&[at(86_398.0), dated(86_399.0, 28), at(0.0), dated(1.0, 29), dated(5.0, 30), at(6.0)]);
        let day = 1_601_251_200.0;
        let wanted = [86_398.0, 86_399.0, 86_400.0, 86_401.0, 2.0 * 86_400.0 + 5.0, 2.0 * 86_400.0 + 6.0];
        assert_eq!(times, wanted.map(|time_s| day + time_s));
        assert_eq!((table.facts.date, table.facts.clock), (Some((2020, 9, 28)), Clock::Utc));
    }

    #[test]
    fn a_time_alone_is_no_row() {
        let time = Reading { date: Some((2020, 9, 28)), ..Reading { speed_m_per_s: None, ..at(1.0) } };
        let (times, table) = table(&[time, at(2.0)]);
        assert_eq!((times, table.rows), (vec![1_601_251_202.0], 1));
    }

    #[test]
    fn without_a_date_times_count_from_midnight() {
        let (times, table) = table(&[at(86_399.0), at(0.0), at(1.0)]);
        assert_eq!((times, table.facts.date), (vec![86_399.0, 86_400.0, 86_401.0], None));
    }
}
