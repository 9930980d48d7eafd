//! Where the anomaly was measured.

use std::collections::BTreeMap;

use crate::result::SurveyedTow;

/// A measurement, or the mean of those in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spot {
    pub(crate) place_m: [f64; 2],
    pub(crate) anomaly_nt: f64,
    /// Which line of which recording; 0 between lines.
    pub(crate) line: usize,
}

/// All valid rows with a place, in their order.
pub(crate) fn spots(tows: &[SurveyedTow]) -> Vec<Spot> {
    let mut numbers = BTreeMap::new();
    let mut spots = Vec::new();
    for (at, tow) in tows.iter().enumerate() {
        let Some(track) = &tow.track else { continue };
        for row in (0..tow.time_s.len()).filter(|&row| tow.is_valid[row]) {
            let next = numbers.len() + 1;
            let name = &tow.line[row];
            let line = if name.is_empty() { 0 } else { *numbers.entry((at, name.clone())).or_insert(next) };
            let spot =
                Spot { place_m: [track.easting_m[row], track.northing_m[row]], anomaly_nt: tow.anomaly_nt[row], line };
            if spot.place_m.iter().all(|metres| metres.is_finite()) && spot.anomaly_nt.is_finite() {
                spots.push(spot);
            }
        }
    }
    spots
}

/// Of each cell that has any the means, so that a body that waits counts no more than one that goes on: GMT's `blockmean`.
pub(crate) fn block_means(spots: &[Spot], cell_m: f64) -> Vec<Spot> {
    let mut blocks: BTreeMap<[i64; 2], (Spot, f64)> = BTreeMap::new();
    for spot in spots {
        let cell = spot.place_m.map(|metres| (metres / cell_m).floor() as i64);
        let (sum, count) = blocks.entry(cell).or_default();
        sum.place_m = [sum.place_m[0] + spot.place_m[0], sum.place_m[1] + spot.place_m[1]];
        sum.anomaly_nt += spot.anomaly_nt;
        *count += 1.0;
    }
    let mean = |(sum, count): (Spot, f64)| Spot {
        place_m: sum.place_m.map(|metres| metres / count),
        anomaly_nt: sum.anomaly_nt / count,
        line: 0,
    };
    blocks.into_values().map(mean).collect()
}
