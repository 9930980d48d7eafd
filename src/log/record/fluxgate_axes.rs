//! The axes of the fluxgate as a calibration has found them.

use crate::bytes::{Put, Take};

/// Scales, offsets and matrix of the fluxgate, and how well they were known.
///
/// `3 x f64, 3 x f64, 9 x f64` of the settings in their order, `3 x f32, 3 x f32, 3 x f32` of the standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxgateAxes {
    /// Scale of each sensor axis, nT per count.
    pub nt_per_count: [f64; 3],
    /// What each sensor axis reads in zero field, nT.
    pub bias_nt: [f64; 3],
    /// Sensor axes to body axes, one row per body axis.
    pub body_from_sensor: [[f64; 3]; 3],
    /// Standard deviation of each offset, nT.
    pub bias_std_nt: [f32; 3],
    /// Standard deviation of each scale, relative.
    pub scale_std: [f32; 3],
    /// Standard deviation of the angles between x and y, x and z, y and z, degrees.
    pub angle_std_deg: [f32; 3],
}

impl FluxgateAxes {
    pub(super) fn put(&self, put: &mut Put<'_>) {
        let Self { nt_per_count, bias_nt, body_from_sensor: [x, y, z], bias_std_nt, scale_std, angle_std_deg } = *self;
        [nt_per_count, bias_nt, x, y, z].iter().flatten().for_each(|&value| put.f64(value));
        [bias_std_nt, scale_std, angle_std_deg].iter().flatten().for_each(|&value| put.f32(value));
    }

    pub(super) fn take(take: &mut Take<'_>) -> Option<Self> {
        let mut axes = [[0.0; 3]; 5];
        for value in axes.iter_mut().flatten() {
            *value = take.f64()?;
        }
        let mut std = [[0.0; 3]; 3];
        for value in std.iter_mut().flatten() {
            *value = take.f32()?;
        }
        let ([nt_per_count, bias_nt, x, y, z], [bias_std_nt, scale_std, angle_std_deg]) = (axes, std);
        Some(Self { nt_per_count, bias_nt, body_from_sensor: [x, y, z], bias_std_nt, scale_std, angle_std_deg })
    }
}
