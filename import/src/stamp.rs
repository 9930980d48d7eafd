//! Stamps of text: dates and times of day, as instruments and spreadsheets write them.

use jiff::civil::Date;

/// Which of day and month stands first where both are numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DateOrder {
    /// 2026-11-22
    Ymd,
    /// 22.11.2026
    Dmy,
    /// 11/22/2026
    Mdy,
}

/// What a stamp says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Stamp {
    /// Days since 1970-01-01.
    pub day: Option<f64>,
    /// Seconds since midnight, in UTC where the stamp tells its zone.
    pub second: Option<f64>,
}

/// Seconds of a day.
pub(crate) const DAY_S: f64 = 86_400.0;
const MONTHS: [&str; 12] = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];
/// A longer field is no stamp.
const LONGEST: usize = 40;

/// Days from 1970-01-01 to this date.
pub(crate) fn days_since_1970(year: i16, month: i8, day: i8) -> Option<f64> {
    let date = Date::new(year, month, day).ok()?;
    let epoch = Date::constant(1970, 1, 1);
    Some(f64::from((date - epoch).get_days()))
}

/// Whether a field could be a date, a time of day or both: cheap, for finding out what a column is.
pub(crate) fn looks_like_a_stamp(field: &str) -> bool {
    parse(field, DateOrder::Dmy).is_some() || parse(field, DateOrder::Mdy).is_some()
}

/// The stamp of a field; `order` tells only where the field does not.
pub(crate) fn parse(field: &str, order: DateOrder) -> Option<Stamp> {
    let field = field.trim();
    if field.len() < 5 || field.len() > LONGEST || !field.is_ascii() {
        return None;
    }
    let (date, time) = parts(field);
    let mut stamp = Stamp::default();
    if let Some(date) = date {
        stamp.day = Some(parse_date(date, order)?);
    }
    if let Some(time) = time {
        stamp.second = Some(parse_time(time)?);
    }
    (stamp.day.is_some() || stamp.second.is_some()).then_some(stamp)
}

/// The date and the time of a stamp: a time has colons, what stands before it is a date.
fn parts(field: &str) -> (Option<&str>, Option<&str>) {
    let Some(colon) = field.find(':') else { return (Some(field), None) };
    match field[..colon].rfind(['T', 't', ' ', '_']) {
        Some(at) => (Some(field[..at].trim()), Some(&field[at + 1..])),
        None => (None, Some(field)),
    }
}

fn parse_date(date: &str, order: DateOrder) -> Option<f64> {
    let separators: Vec<char> = date.chars().filter(|c| !c.is_ascii_alphanumeric()).collect();
    let tokens: Vec<&str> = date.split(['-', '/', '.', ' ', ',']).filter(|token| !token.is_empty()).collect();
    let &[a, b, c] = tokens.as_slice() else { return None };
    if separators.iter().any(|c| !matches!(c, '-' | '/' | '.' | ' ' | ',')) {
        return None;
    }
    let month_of = |token: &str| {
        let name = token.get(..3)?.to_ascii_lowercase();
        MONTHS.iter().position(|month| *month == name).map(|at| at as i8 + 1)
    };
    if let Some(month) = month_of(b) {
        return from_parts(c, month, a);
    }
    if let Some(month) = month_of(a) {
        return from_parts(c, month, b);
    }
    let order = if a.len() == 4 { DateOrder::Ymd } else { order };
    match order {
        DateOrder::Ymd => from_parts(a, b.parse().ok()?, c),
        DateOrder::Dmy => from_parts(c, b.parse().ok()?, a),
        DateOrder::Mdy => from_parts(c, a.parse().ok()?, b),
    }
}

fn from_parts(year: &str, month: i8, day: &str) -> Option<f64> {
    let year = match (year.len(), year.parse::<i16>().ok()?) {
        (2, year) if year < 70 => 2000 + year,
        (2, year) => 1900 + year,
        (4, year) => year,
        _ => return None,
    };
    days_since_1970(year, month, day.parse().ok()?)
}

/// Seconds of `hh:mm`, `hh:mm:ss` or `hh:mm:ss.sss`, with AM or PM, with Z or an offset, which is taken off.
fn parse_time(time: &str) -> Option<f64> {
    let time = time.trim();
    let (time, zone_s) = without_zone(time)?;
    let lower = time.to_ascii_lowercase();
    let (time, half) = match (lower.strip_suffix("am"), lower.strip_suffix("pm")) {
        (Some(time), _) => (time.trim(), Some(0.0)),
        (_, Some(time)) => (time.trim(), Some(12.0)),
        _ => (lower.as_str(), None),
    };
    let mut tokens = time.split(':');
    let hour = whole(tokens.next()?)?;
    let minute = whole(tokens.next()?)?;
    let second = tokens.next().map_or(Some(0.0), |token| decimal(&token.replace(',', ".")))?;
    // 10:00:00:250, as some loggers have it.
    let milliseconds = tokens.next().map_or(Some(0.0), whole)?;
    let hour = half.map_or(hour, |half| hour % 12.0 + half);
    let is_time = tokens.next().is_none() && hour <= 24.0 && minute < 60.0 && second < 61.0;
    is_time.then_some(hour * 3600.0 + minute * 60.0 + second + milliseconds * 1e-3 - zone_s)
}

/// A time without its zone, and what the zone is ahead of UTC, s.
fn without_zone(time: &str) -> Option<(&str, f64)> {
    if let Some(time) = time.strip_suffix(['Z', 'z']).or(time.strip_suffix(" UTC")).or(time.strip_suffix(" GMT")) {
        return Some((time.trim(), 0.0));
    }
    let Some(at) = time.rfind(['+', '-']) else { return Some((time, 0.0)) };
    let sign = if time.as_bytes()[at] == b'-' { -1.0 } else { 1.0 };
    let digits = time[at + 1..].replace(':', "");
    let number = whole(&digits)?;
    let zone_s = match digits.len() {
        2 => number * 3600.0,
        4 => (number / 100.0).floor() * 3600.0 + number % 100.0 * 60.0,
        _ => return None,
    };
    Some((time[..at].trim(), sign * zone_s))
}

fn whole(token: &str) -> Option<f64> {
    let token = token.trim();
    (!token.is_empty() && token.len() <= 4 && token.bytes().all(|byte| byte.is_ascii_digit()))
        .then(|| token.parse().ok())
        .flatten()
}

fn decimal(token: &str) -> Option<f64> {
    let is_plain = token.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    is_plain.then(|| token.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(field: &str, order: DateOrder) -> f64 {
        let stamp = parse(field, order).unwrap_or_else(|| panic!("{field}"));
        stamp.day.unwrap_or_default() * DAY_S + stamp.second.unwrap_or_default()
    }

    #[test]
    fn one_instant_in_many_words() {
        let instant = 1_795_343_400.5;
        for field in [
            "2026-11-22T10:30:00.5Z",
            "2026-11-22 10:30:00.500",
            "2026/11/22 10:30:00,5",
            "2026-11-22T11:30:00.5+01:00",
            "2026-11-22T05:30:00.5-0500",
            "22.11.2026 10:30:00.5",
            "22-Nov-2026 10:30:00.5",
            "Nov 22 2026 10:30:00.5",
            "22/11/26 10:30:00:500",
            "2026-11-22 10:30:00.5 AM",
        ] {
            assert_eq!(seconds(field, DateOrder::Dmy), instant, "{field}");
        }
        assert_eq!(seconds("11/22/2026 10:30:00.5", DateOrder::Mdy), instant);
    }

    #[test]
    fn parts_alone() {
        assert_eq!(parse("23:59:59.9", DateOrder::Dmy), Some(Stamp { day: None, second: Some(86_399.9) }));
        assert_eq!(parse("12:05 am", DateOrder::Dmy).unwrap().second, Some(300.0));
        assert_eq!(parse("1970-01-02", DateOrder::Dmy), Some(Stamp { day: Some(1.0), second: None }));
    }

    #[test]
    fn what_is_none() {
        for field in ["51384.25", "leg 1", "", "25:61:00", "2026-13-01", "1.2.3.4", "12:xx:00", "10-20", "99/99/9999"] {
            assert_eq!(parse(field, DateOrder::Dmy), None, "{field}");
        }
    }
}
