//! What a calibration came to, as the log keeps it.

use crate::link::Found;
use crate::log::{EventKind, FluxgateAxes};

/// The event of a result.
pub(super) fn event_of(found: &Found) -> EventKind {
    match found {
        Found::Terms(summary) => EventKind::Calibrated {
            coefficients: summary.coefficients,
            used_epochs: summary.used_epochs,
            std_before_nt: summary.std_before_nt as f32,
            rms_after_nt: summary.rms_after_nt as f32,
        },
        Found::Fluxgate(result) => EventKind::FluxgateCalibrated {
            axes: FluxgateAxes {
                nt_per_count: result.settings.nt_per_count,
                bias_nt: result.settings.bias_nt,
                body_from_sensor: result.settings.body_from_sensor,
                bias_std_nt: result.bias_std_nt.map(|std| std as f32),
                scale_std: result.scale_std.map(|std| std as f32),
                angle_std_deg: result.angle_std_deg.map(|std| std as f32),
            },
            used_epochs: result.used_epochs,
            rms_before_nt: result.rms_before_nt as f32,
            rms_after_nt: result.rms_after_nt as f32,
        },
    }
}
