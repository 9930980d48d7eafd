//! The sheet that the map is drawn on.

use towmag_survey::Survey;

/// Length of the longer side in units of the drawing.
const UNITS: f64 = 10_000.0;
/// A map is at most this many times as long as wide: a single line still has room for its numbers.
const LONGEST: f64 = 3.0;
/// Room around the track, of the longer side.
const MARGIN: f64 = 0.05;

/// What is drawn of the world, m, and how large.
pub(super) struct Sheet {
    pub(super) west_m: f64,
    pub(super) north_m: f64,
    pub(super) width_m: f64,
    pub(super) height_m: f64,
    pub(super) units_per_m: f64,
}

impl Sheet {
    pub(super) fn of(survey: &Survey) -> Option<Self> {
        let tracks = survey.tows.iter().filter_map(|tow| tow.track.as_ref());
        let on_track = tracks.flat_map(|track| track.easting_m.iter().copied().zip(track.northing_m.iter().copied()));
        let contacts = survey.contacts.iter().filter_map(|contact| contact.place);
        let places = on_track.chain(contacts.map(|place| (place.easting_m, place.northing_m)));
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        for (east, north) in places.filter(|(east, north)| east.is_finite() && north.is_finite()) {
            ends = [ends[0].min(east), ends[1].max(east), ends[2].min(north), ends[3].max(north)];
        }
        let [west, east, south, north] = ends;
        if west > east || survey.tows.iter().all(|tow| tow.track.is_none()) {
            return None;
        }
        let longest_m = (east - west).max(north - south).max(1.0);
        let side = |length_m: f64| length_m.max(longest_m / LONGEST) + 2.0 * MARGIN * longest_m;
        let (width_m, height_m) = (side(east - west), side(north - south));
        let (west_m, north_m) = (0.5 * (west + east - width_m), 0.5 * (south + north + height_m));
        Some(Self { west_m, north_m, width_m, height_m, units_per_m: UNITS / width_m.max(height_m) })
    }

    /// In units of the drawing.
    pub(super) fn at(&self, east_m: f64, north_m: f64) -> (f64, f64) {
        ((east_m - self.west_m) * self.units_per_m, (self.north_m - north_m) * self.units_per_m)
    }

    /// From the left and from the top.
    pub(super) fn percent(&self, east_m: f64, north_m: f64) -> (String, String) {
        let percent = |part: f64, whole: f64| format!("{:.2}", 100.0 * part / whole);
        (percent(east_m - self.west_m, self.width_m), percent(self.north_m - north_m, self.height_m))
    }
}
