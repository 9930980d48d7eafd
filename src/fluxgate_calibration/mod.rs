//! Calibration of the fluxgate on the body: offsets, scales and directions of its axes, found by turning it.
//!
//! The field has the same magnitude in whatever direction the body points, and the scalar sensor reads it. Each epoch is a
//! point on an ellipsoid in the sensor's axes; where it lies and how it is stretched and sheared are the three offsets,
//! three scales and three angles. How the sensor sits in the body does not show: that is kept as it was set.
//!
//! What the body's own iron adds at both sensors is part of it. A permanent field at the fluxgate is an offset, and so is
//! one at the scalar sensor: the 18 terms are calibrated afterwards, on top.

mod axes;
mod ellipsoid;
mod error;

pub use error::FluxgateCalibrationError;

use crate::epoch::{Epoch, RATE_HZ};
use crate::front_end::accept;
use crate::policy::{
    FASTEST_TURN_RAD_PER_S, LARGEST_AXIS_ERROR_NT, LARGEST_MISFIT_NT, LEAST_TURNING_S, TURNING_ERROR_NT,
};
use crate::sensors::fluxgate::FluxgateSettings;
use crate::settings::SettingsError;
use axes::{Axes, body_from_sensor};
use ellipsoid::{Ellipsoid, Fit, UNKNOWNS};
use nalgebra::{Matrix3, Vector3};

/// A calibration of the fluxgate in progress.
#[derive(Clone, Debug)]
pub struct FluxgateCalibration {
    settings: FluxgateSettings,
    sensor_from_body: Matrix3<f64>,
    ellipsoid: Ellipsoid,
    /// Tick and reading of the latest epoch that had both sensors.
    last: Option<(u32, Vector3<f64>)>,
    used_epochs: u32,
    squares_before: f64,
}

/// What a calibration of the fluxgate found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxgateResult {
    /// The settings, with new scales, offsets and matrix.
    pub settings: FluxgateSettings,
    /// By how much each scale has changed: new over old.
    pub scale_ratios: [f64; 3],
    /// Angle between x and y, x and z, y and z, degrees.
    pub angles_deg: [f64; 3],
    /// Standard deviation of each offset, nT, for residuals that are white.
    pub bias_std_nt: [f64; 3],
    /// The same of each scale's ratio.
    pub scale_std: [f64; 3],
    /// The same of each angle, degrees.
    pub angle_std_deg: [f64; 3],
    /// Epochs behind the result.
    pub used_epochs: u32,
    /// Root mean square of the fluxgate's magnitude less the scalar, nT, with the settings as they were.
    pub rms_before_nt: f64,
    /// The same with the result.
    pub rms_after_nt: f64,
}

impl FluxgateCalibration {
    /// A calibration before its first epoch; `settings` are those that the epochs are made with.
    pub fn new(settings: &FluxgateSettings) -> Result<Self, SettingsError> {
        settings.build()?;
        Ok(Self {
            settings: *settings,
            // Settings that can be built have an inverse; without one, nothing would ever be covered.
            sensor_from_body: body_from_sensor(settings).try_inverse().unwrap_or_default(),
            ellipsoid: Ellipsoid::new(),
            last: None,
            used_epochs: 0,
            squares_before: 0.0,
        })
    }

    /// Take in one epoch. Whether it counts: not without both sensors, nor when the body turns too fast, nor after a gap,
    /// where that is not known.
    #[inline(never)] // Else the task that has every epoch is the slower for it while no calibration runs.
    pub fn step(&mut self, epoch: &Epoch) -> bool {
        let last = self.last.take();
        let Ok((scalar_pt, flux_nt, magnitude_nt)) = accept(epoch) else { return false };
        let body_nt = Vector3::from(flux_nt.map(f64::from));
        self.last = Some((epoch.tick, body_nt));
        let Some((tick, last_nt)) = last else { return false };
        let turn_rad = (body_nt - last_nt).norm() / magnitude_nt;
        if epoch.tick.wrapping_sub(tick) != 1 || turn_rad > FASTEST_TURN_RAD_PER_S / RATE_HZ {
            return false;
        }
        let scalar_nt = f64::from(scalar_pt) / 1_000.0;
        self.ellipsoid.add(&(self.sensor_from_body * body_nt), scalar_nt);
        self.squares_before += (magnitude_nt - scalar_nt) * (magnitude_nt - scalar_nt);
        self.used_epochs = self.used_epochs.saturating_add(1);
        true
    }

    /// Solve for all epochs so far. The calibration can go on afterwards.
    pub fn solve(&self) -> Result<FluxgateResult, FluxgateCalibrationError> {
        let needed_epochs = libm::ceil(LEAST_TURNING_S * RATE_HZ) as u32;
        let used_epochs = self.used_epochs;
        if used_epochs < needed_epochs {
            return Err(FluxgateCalibrationError::TooShort { used_epochs, needed_epochs });
        }
        let Some((fit, axes)) = self.with_axes(self.ellipsoid.fit()) else {
            let (fit, axes) = self.with_axes(self.ellipsoid.sphere()).ok_or(FluxgateCalibrationError::NotFinite)?;
            self.check_coverage(&fit, &axes, 0.0)?;
            return Err(FluxgateCalibrationError::NotFinite);
        };
        let rms_after_nt = libm::sqrt(fit.squares / f64::from(used_epochs));
        if rms_after_nt > LARGEST_MISFIT_NT {
            return Err(FluxgateCalibrationError::Misfit(rms_after_nt));
        }
        self.check_coverage(&fit, &axes, rms_after_nt)?;
        self.result(&fit, &axes, rms_after_nt)
    }

    fn with_axes(&self, fit: Option<Fit>) -> Option<(Fit, Axes)> {
        let fit = fit?;
        let axes = Axes::of(&fit, &self.settings)?;
        Some((fit, axes))
    }

    /// Whether every unknown would be known well enough even if all that is left were not noise but one smooth error,
    /// which no number of epochs averages out.
    fn check_coverage(&self, fit: &Fit, axes: &Axes, rms_nt: f64) -> Result<(), FluxgateCalibrationError> {
        let smooth_nt = rms_nt.max(TURNING_ERROR_NT) * libm::sqrt(f64::from(self.used_epochs));
        let mut errors_nt = axes.unit_std * smooth_nt;
        errors_nt.fixed_rows_mut::<6>(3).scale_mut(fit.unit_nt);
        // A NaN is within no limit.
        if errors_nt.iter().all(|&error_nt| error_nt <= LARGEST_AXIS_ERROR_NT) {
            return Ok(());
        }
        let (unknown, error_nt) = errors_nt.argmax();
        Err(FluxgateCalibrationError::NotCovered { unknown, error_nt })
    }

    fn result(&self, fit: &Fit, axes: &Axes, rms_after_nt: f64) -> Result<FluxgateResult, FluxgateCalibrationError> {
        let settings = axes.settings(&self.settings).ok_or(FluxgateCalibrationError::NotFinite)?;
        settings.build().map_err(FluxgateCalibrationError::OutOfRange)?;
        let n = f64::from(self.used_epochs);
        let std = axes.unit_std * libm::sqrt(fit.squares / (n - UNKNOWNS as f64));
        let sines = Vector3::from(axes.cosines).map(|cosine| libm::sqrt(1.0 - cosine * cosine));
        let angle_std = std.fixed_rows::<3>(6).component_div(&sines);
        Ok(FluxgateResult {
            settings,
            scale_ratios: axes.scales,
            angles_deg: axes.cosines.map(|cosine| libm::acos(cosine).to_degrees()),
            bias_std_nt: std.fixed_rows::<3>(0).into(),
            scale_std: std.fixed_rows::<3>(3).into(),
            angle_std_deg: angle_std.map(f64::to_degrees).into(),
            used_epochs: self.used_epochs,
            rms_before_nt: libm::sqrt(self.squares_before / n),
            rms_after_nt,
        })
    }
}
