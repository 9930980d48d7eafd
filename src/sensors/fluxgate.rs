//! From the converter's counts to the field in body axes and the battery's current.

use super::check;
use crate::settings::SettingsError;

/// Calibration of the fluxgate and of the current channel. `build` turns it into coefficients, once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxgateSettings {
    /// Scale of each sensor axis, nT per count, 0.0001 to 10. At gain 1 a count is 1.2 V / 2^23 at the converter.
    pub nt_per_count: [f64; 3],
    /// What each sensor axis reads in zero field, nT, -100,000 to 100,000.
    pub bias_nt: [f64; 3],
    /// Sensor axes to body axes (x forward, y starboard, z down), one row per body axis: takes out non-orthogonality and
    /// mounting, and may swap or reverse axes. Each entry -2 to 2, magnitude of the determinant 0.5 to 2.
    pub body_from_sensor: [[f64; 3]; 3],
    /// Scale of the current channel, ampere per count, -1 to 1.
    pub ampere_per_count: f64,
    /// What the current channel reads without current, ampere, -1,000 to 1,000.
    pub current_bias_a: f64,
}

impl Default for FluxgateSettings {
    /// A fluxgate of 100 uT for 10 V behind a divider by 8.5, axes along the body's, and 1 uA per count: a start for a
    /// calibration, not one.
    fn default() -> Self {
        // 1.2 V / 2^23 * 8.5 * 100,000 nT / 10 V
        let nt_per_count = 1.2 / 8_388_608.0 * 8.5 * 10_000.0;
        Self {
            nt_per_count: [nt_per_count; 3],
            bias_nt: [0.0; 3],
            body_from_sensor: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            ampere_per_count: 1e-6,
            current_bias_a: 0.0,
        }
    }
}

/// A checked calibration: `body = body_from_sensor (scale count - bias)`.
#[derive(Clone, Copy, Debug)]
pub struct Fluxgate {
    nt_per_count: [f32; 3],
    bias_nt: [f32; 3],
    body_from_sensor: [[f32; 3]; 3],
    ampere_per_count: f32,
    current_bias_a: f32,
}

impl FluxgateSettings {
    /// Take over scales, offsets and matrix of `other`; the current's are kept.
    pub(crate) fn take_axes(&mut self, other: &Self) {
        let Self { nt_per_count, bias_nt, body_from_sensor, .. } = *other;
        *self = Self { nt_per_count, bias_nt, body_from_sensor, ..*self };
    }

    /// The converter, or which setting is wrong.
    pub fn build(&self) -> Result<Fluxgate, SettingsError> {
        for scale in self.nt_per_count {
            check("nt_per_count", scale, 1e-4..=10.0, "0.0001 to 10")?;
        }
        for bias in self.bias_nt {
            check("bias_nt", bias, -1e5..=1e5, "-100000 to 100000")?;
        }
        for entry in self.body_from_sensor.iter().flatten() {
            check("body_from_sensor", *entry, -2.0..=2.0, "-2 to 2 in each entry")?;
        }
        let determinant = determinant(&self.body_from_sensor);
        let allowed = "axes far from one plane: determinant of magnitude 0.5 to 2";
        check("body_from_sensor", libm::fabs(determinant), 0.5..=2.0, allowed)?;
        check("ampere_per_count", self.ampere_per_count, -1.0..=1.0, "-1 to 1")?;
        check("current_bias_a", self.current_bias_a, -1e3..=1e3, "-1000 to 1000")?;
        Ok(Fluxgate {
            nt_per_count: self.nt_per_count.map(|scale| scale as f32),
            bias_nt: self.bias_nt.map(|bias| bias as f32),
            body_from_sensor: self.body_from_sensor.map(|row| row.map(|entry| entry as f32)),
            ampere_per_count: self.ampere_per_count as f32,
            current_bias_a: self.current_bias_a as f32,
        })
    }
}

impl Fluxgate {
    /// Field in body axes, nT. The order of the operations is fixed, so that the bits are too.
    pub fn convert(&self, counts: &[f32; 3]) -> [f32; 3] {
        let sensor = |axis: usize| self.nt_per_count[axis] * counts[axis] - self.bias_nt[axis];
        let [x, y, z] = [sensor(0), sensor(1), sensor(2)];
        self.body_from_sensor.map(|[a, b, c]| a * x + b * y + c * z)
    }

    /// Battery current, ampere.
    pub fn current_a(&self, count: f32) -> f32 {
        self.ampere_per_count * count - self.current_bias_a
    }
}

fn determinant([[a, b, c], [d, e, f], [g, h, i]]: &[[f64; 3]; 3]) -> f64 {
    a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
}
