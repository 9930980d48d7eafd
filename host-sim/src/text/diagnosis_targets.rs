//! Targets as a short table: the largest, in the order of time.

use super::diagnosis::percent;
use crate::diagnosis::TargetFound;

/// Rows of the table at most.
const MOST: usize = 12;

/// What stands above the columns.
pub const COLUMNS: [&str; 4] = ["Time, s", "Peak, nT", "Width, s", "Probability"];

/// A row for each target: time on the recording's axis, peak with its sign, width, and that it is one.
pub fn rows(targets: &[TargetFound]) -> Vec<[String; 4]> {
    let mut largest: Vec<&TargetFound> = targets.iter().collect();
    largest.sort_by(|a, b| b.peak_nT.abs().total_cmp(&a.peak_nT.abs()));
    largest.truncate(MOST);
    largest.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let row = |target: &TargetFound| {
        let time = format!("{:.1}", target.time_s).replace('-', "−");
        [time, peak(target), format!("{:.1}", target.width_s), percent(target.probability)]
    };
    largest.into_iter().map(row).collect()
}

/// What the table leaves out.
pub fn more(targets: &[TargetFound]) -> Option<String> {
    match targets.len().saturating_sub(MOST) {
        0 => None,
        more => Some(format!("and {more} more, smaller, in diagnosis.json")),
    }
}

/// What a target adds to the field where it adds most, nT.
pub fn peak(target: &TargetFound) -> String {
    format!("{:+.2}", target.peak_nT).replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(time_s: f64, peak_nt: f64) -> TargetFound {
        TargetFound { time_s, peak_nT: peak_nt, width_s: 2.14, probability: 0.998 }
    }

    #[test]
    fn peaks_have_their_sign() {
        let rows = rows(&[target(-3.04, -8.0), target(520.13, 3.014)]);
        assert_eq!(rows[0], ["−3.0", "−8.00", "2.1", "over 99 %"]);
        assert_eq!(rows[1], ["520.1", "+3.01", "2.1", "over 99 %"]);
    }

    #[test]
    fn largest_are_listed_in_time_and_the_others_counted() {
        let mut targets: Vec<TargetFound> = (0..15).map(|k| target(f64::from(k), f64::from(15 - k))).collect();
        targets[14].peak_nT = -99.0;
        let rows = rows(&targets);
        assert_eq!((rows.len(), rows[10][1].as_str(), rows[11][1].as_str()), (12, "+5.00", "−99.00"));
        assert_eq!(more(&targets).unwrap(), "and 3 more, smaller, in diagnosis.json");
        assert_eq!(more(&targets[..12]), None);
    }
}
