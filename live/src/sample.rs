//! One epoch, as a viewer sees it.

/// One epoch, as a viewer sees it. What is not known is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Place on the strip, s: rising, of any origin; seconds since 1970-01-01 UTC where that is known.
    pub time_s: f64,
    /// The sender's own time stamp, seconds since 1970-01-01 UTC.
    pub sent_s: Option<f64>,
    /// When it was read off the cable, by the clock of this machine, seconds since 1970-01-01 UTC.
    pub heard_s: Option<f64>,
    /// Total field as the sensor sent it, nT.
    pub raw_nt: Option<f64>,
    /// Less the predicted deviation, nT.
    pub compensated_nt: Option<f64>,
    /// In the band, strictly predictive, nT.
    pub residual_nt: Option<f64>,
    /// Depth below the surface, m.
    pub depth_m: Option<f64>,
    /// Height above the bottom, m.
    pub altitude_m: Option<f64>,
    /// Latitude and longitude, WGS 84, degrees.
    pub position_deg: Option<[f64; 2]>,
    /// Whether there is water in the body.
    pub has_leak: Option<bool>,
    /// Voltage of the body's battery, V.
    pub battery_v: Option<f64>,
}

/// How many values of an epoch are drawn over time.
pub(crate) const SERIES: usize = 6;

/// Their names on the wire, in the order of [`Sample::series`].
pub(crate) const SERIES_NAMES: [&str; SERIES] =
    ["raw_nt", "compensated_nt", "deviation_nt", "residual_nt", "depth_m", "altitude_m"];

impl Sample {
    /// What the compensation has taken off, nT.
    pub(crate) fn deviation_nt(&self) -> Option<f64> {
        Some(self.raw_nt? - self.compensated_nt?)
    }

    /// What is drawn over time; what is no number is as unknown as what is not there.
    pub(crate) fn series(&self) -> [Option<f64>; SERIES] {
        let all =
            [self.raw_nt, self.compensated_nt, self.deviation_nt(), self.residual_nt, self.depth_m, self.altitude_m];
        all.map(|value| value.filter(|value| value.is_finite()))
    }

    /// Where the body was, if that is a place.
    pub(crate) fn place_deg(&self) -> Option<[f64; 2]> {
        self.position_deg.filter(|[latitude, longitude]| latitude.abs() <= 90.0 && longitude.abs() <= 180.0)
    }
}
