//! When each row was, for the log.

use towmag_recording::Column;

use crate::error::ExportError;
use crate::table::Table;

/// A double holds a second of this century to a quarter of a microsecond: finer digits would be made up.
const STEPS_PER_S: f64 = 1e6;
const NS_PER_STEP: u64 = 1000;
/// What the log has room for.
const LATEST_S: f64 = 1.8e10;

/// Nanoseconds: of UTC where the table knows it in some row, else since the first row. `None` for a row without time.
///
/// # Errors
///
/// When there is no time at all, or one that the log has no room for.
pub(super) fn log_times_ns(table: &Table) -> Result<Vec<Option<u64>>, ExportError> {
    let [time, utc] = [Column::Time, Column::Utc].map(Column::name);
    let [time_s, utc_s] = [time, utc].map(|name| table.numbers(name).filter(|times| times.iter().any(|t| !t.is_nan())));
    let (column, times_s) = match (time_s, utc_s) {
        (Some(time_s), None) => (time, since_first(time_s)),
        (None, Some(utc_s)) => (utc, utc_s.to_vec()),
        (Some(time_s), Some(utc_s)) => (utc, carried(time_s, utc_s)),
        (None, None) => return Err(table.lacks(format!("{time} and {utc} are missing, and a log needs one of them"))),
    };
    let log_time = |(row, &s): (usize, &f64)| match s {
        s if s.is_nan() => Ok(None),
        // Rounded and in range: the cast keeps all of it.
        s if (0.0..=LATEST_S).contains(&s) => Ok(Some((s * STEPS_PER_S).round() as u64 * NS_PER_STEP)),
        s => Err(table.at(row, column, format!("{s} s is no time that a log can have: 0 to {LATEST_S} s"))),
    };
    times_s.iter().enumerate().map(log_time).collect()
}

fn since_first(time_s: &[f64]) -> Vec<f64> {
    let first_s = time_s.iter().copied().find(|time_s| !time_s.is_nan()).unwrap_or(0.0);
    time_s.iter().map(|time_s| time_s - first_s).collect()
}

/// UTC in all rows: where it is not known, from the latest row that knew it, and in front of them all from the first one.
fn carried(time_s: &[f64], utc_s: &[f64]) -> Vec<f64> {
    let offset_s = |row: usize| utc_s[row] - time_s[row];
    let mut latest_s = (0..utc_s.len()).map(offset_s).find(|offset_s| !offset_s.is_nan()).unwrap_or(f64::NAN);
    let mut carry = |row: usize| {
        if !offset_s(row).is_nan() {
            latest_s = offset_s(row);
        }
        if utc_s[row].is_nan() { time_s[row] + latest_s } else { utc_s[row] }
    };
    (0..utc_s.len()).map(&mut carry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::read_from;

    fn times_ns(csv: &str) -> Vec<Option<u64>> {
        log_times_ns(&read_from("t.csv", csv.as_bytes()).unwrap()).unwrap()
    }

    #[test]
    fn without_utc_the_log_begins_at_zero() {
        assert_eq!(times_ns("time_s,a\n-3.5,1\n-3.4,1\n,1\n"), [Some(0), Some(100_000_000), None]);
    }

    #[test]
    fn utc_is_carried_to_where_it_was_not_known() {
        let csv = "time_s,utc_s\n1.0,\n1.1,1700000000.25\n1.2,\n1.3,1700000000.47\n";
        let expected =
            [150_000_000, 250_000_000, 350_000_000, 470_000_000].map(|ns| Some(1_700_000_000_000_000_000 + ns));
        assert_eq!(times_ns(csv), expected);
    }

    #[test]
    fn a_time_before_1970_is_placed() {
        let table = read_from("t.csv", b"time_s,utc_s\n1.0,-5\n".as_slice()).unwrap();
        let error = log_times_ns(&table).unwrap_err().to_string();
        assert!(error.starts_with("t.csv:2: utc_s: -5 s is no time"), "{error}");
    }
}
