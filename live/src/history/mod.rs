//! The last twelve hours, in memory that does not grow: the same samples in cells of several lengths, each with the
//! smallest and largest value, so that no spike is lost however much is shown; and the track.

mod cell;
mod tier;
mod track;

pub use cell::Cell;
pub use tier::Tier;
pub use track::{Track, TrackPoint};

use crate::sample::Sample;

/// How much a page may show at once, s, and the length of a cell then, s: 1,080 to 1,440 cells, which is more than a
/// tablet has columns in a chart.
pub const WINDOWS: [(f64, f64); 5] = [(120.0, 0.1), (600.0, 0.5), (3_600.0, 2.5), (10_800.0, 10.0), (43_200.0, 30.0)];

/// All that is kept.
#[derive(Debug)]
pub struct History {
    tiers: [Tier; WINDOWS.len()],
    track: Track,
    last_s: Option<f64>,
}

impl Default for History {
    fn default() -> Self {
        Self {
            tiers: WINDOWS.map(|(window_s, cell_s)| Tier::new(cell_s, window_s)),
            track: Track::default(),
            last_s: None,
        }
    }
}

impl History {
    /// Keep a sample, unless its time is not after that of the one before.
    pub fn push(&mut self, sample: &Sample) {
        let is_later = self.last_s.is_none_or(|last_s| sample.time_s > last_s);
        if !sample.time_s.is_finite() || !is_later {
            return;
        }
        self.last_s = Some(sample.time_s);
        let series = sample.series();
        self.tiers.iter_mut().for_each(|tier| tier.push(sample.time_s, &series));
        if let Some([latitude_deg, longitude_deg]) = sample.place_deg() {
            self.track.push(TrackPoint { time_s: sample.time_s, latitude_deg, longitude_deg });
        }
    }

    /// Time of the latest sample, s.
    pub fn last_s(&self) -> Option<f64> {
        self.last_s
    }

    /// The cells for this much, s: of the shortest window that holds it.
    pub fn tier(&self, window_s: f64) -> &Tier {
        let fits = WINDOWS.iter().position(|(longest_s, _)| window_s <= *longest_s);
        &self.tiers[fits.unwrap_or(WINDOWS.len() - 1)]
    }

    /// Where the body was.
    pub fn track(&self) -> &Track {
        &self.track
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(tick: u64) -> Sample {
        let raw_nt = Some(if tick == 777 { 60_000.0 } else { 50_000.0 });
        Sample {
            time_s: 1e9 + 0.1 * tick as f64,
            raw_nt,
            position_deg: Some([54.0, 1e-6 * tick as f64]),
            ..Sample::default()
        }
    }

    #[test]
    fn a_day_takes_no_more_room_than_half_of_it_and_a_spike_stays() {
        let mut history = History::default();
        let mut cells = 0;
        for tick in 0..24 * 36_000 {
            history.push(&sample(tick));
            if tick == 24 * 18_000 {
                cells = history.tiers.iter().map(|tier| tier.cells().count()).sum();
                let most = history
                    .tier(43_200.0)
                    .cells()
                    .filter_map(|cell| cell.bounds(0))
                    .fold(0.0, |most: f64, [_, high]| most.max(high));
                assert_eq!(most, 60_000.0, "eleven hours and more ago");
            }
        }
        assert_eq!(cells, history.tiers.iter().map(|tier| tier.cells().count()).sum::<usize>());
        assert!(cells < 8_000 && history.track.points().count() <= track::MOST_POINTS);
        let first = history.tier(43_200.0).cells().next().unwrap().time_s;
        assert!((43_100.0..43_300.0).contains(&(history.last_s().unwrap() - first)), "{first}");
    }

    #[test]
    fn time_goes_forward_only() {
        let mut history = History::default();
        [5, 4, 5, 6].into_iter().for_each(|tick| history.push(&sample(tick)));
        history.push(&Sample { time_s: f64::NAN, ..Sample::default() });
        assert_eq!(history.tier(60.0).cells().count(), 2);
        assert_eq!(history.last_s(), Some(sample(6).time_s));
    }

    #[test]
    fn every_window_has_its_cells() {
        let history = History::default();
        for (window_s, cell_s) in WINDOWS {
            assert_eq!(history.tier(window_s).cell_s(), cell_s);
        }
        assert_eq!(history.tier(f64::INFINITY).cell_s(), 30.0);
    }
}
