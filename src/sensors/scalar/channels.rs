//! The channels that a G-882 sends beside field and signal: counts to depth and altitude.

use super::CHANNELS;
use crate::sensors::check;
use crate::settings::SettingsError;

/// What the counts of the channels stand for: 0 to 9,999 for 0 to 5 V (G-882 manual p. 46). A body's own settings, since the
/// sensors behind the channels are chosen and calibrated for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelSettings {
    /// Depth, m for a count; 0 where no depth sensor is fitted.
    pub depth_m_per_count: f64,
    /// Depth at 0 counts, m. A sensor that shows 112 counts at the surface has -112 times its scale.
    pub depth_bias_m: f64,
    /// Altitude, m for a count; 0 where no altimeter is fitted.
    pub altitude_m_per_count: f64,
    /// Altitude at 0 counts, m.
    pub altitude_bias_m: f64,
}

impl Default for ChannelSettings {
    /// Neither is fitted.
    fn default() -> Self {
        Self { depth_m_per_count: 0.0, depth_bias_m: 0.0, altitude_m_per_count: 0.0, altitude_bias_m: 0.0 }
    }
}

impl ChannelSettings {
    /// Check every number against its range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        for (name, value) in [
            ("g882_depth_m_per_count", self.depth_m_per_count),
            ("g882_altitude_m_per_count", self.altitude_m_per_count),
        ] {
            check(name, value, -1.0..=1.0, "-1 to 1")?;
        }
        for (name, value) in [("g882_depth_bias_m", self.depth_bias_m), ("g882_altitude_bias_m", self.altitude_bias_m)]
        {
            check(name, value, -10_000.0..=10_000.0, "-10000 to 10000")?;
        }
        Ok(())
    }

    /// Depth and altitude, m, as far as they are fitted and the sentence had them.
    pub fn metres(&self, channels: [Option<u16>; CHANNELS]) -> [Option<f32>; CHANNELS] {
        let scales = [(self.depth_m_per_count, self.depth_bias_m), (self.altitude_m_per_count, self.altitude_bias_m)];
        let mut metres = [None; CHANNELS];
        for ((place, counts), (m_per_count, bias_m)) in metres.iter_mut().zip(channels).zip(scales) {
            *place =
                counts.filter(|_| m_per_count != 0.0).map(|counts| (f64::from(counts) * m_per_count + bias_m) as f32);
        }
        metres
    }
}
