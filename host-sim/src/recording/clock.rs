//! What a recording's own times are in seconds since 1970.

/// Times later than this many seconds are of the clock, whatever their column is called: 2001, and 30 years of a recording.
const UNIX_S: f64 = 1e9;

/// What makes seconds since 1970 of a recording's `time_s`: from its own column of clock times, else none where the times
/// are of the clock already. `None` where neither is known.
pub fn utc_offset_s(time_s: &[f64], utc_s: Option<&[f64]>) -> Option<f64> {
    let pairs = utc_s.unwrap_or_default().iter().zip(time_s);
    let mut offsets: Vec<f64> = pairs.map(|(utc, time)| utc - time).filter(|offset| offset.is_finite()).collect();
    if !offsets.is_empty() {
        let middle = offsets.len() / 2;
        return Some(*offsets.select_nth_unstable_by(middle, f64::total_cmp).1);
    }
    time_s.iter().any(|time_s| *time_s > UNIX_S).then_some(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offset_comes_from_the_column_or_from_the_times_themselves() {
        let utc_s = [f64::NAN, 1_780_300_901.0, 1_780_300_902.0, 5.0];
        assert_eq!(utc_offset_s(&[0.0, 1.0, 2.0, 3.0], Some(&utc_s)), Some(1_780_300_900.0));
        assert_eq!(utc_offset_s(&[1_780_300_900.0], None), Some(0.0));
        assert_eq!(utc_offset_s(&[1_780_300_900.0], Some(&[f64::NAN])), Some(0.0));
        assert_eq!(utc_offset_s(&[0.0, 3600.0], None), None);
    }
}
