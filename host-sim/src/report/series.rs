//! What a diagnosis leaves of each sensor, reduced to what a screen can show.

use crate::collect::{AmplitudeSpectrum, Envelope, EnvelopeCollector};
use crate::diagnosis::{ChannelResiduals, Diagnosis};

/// The residual of one sensor.
pub(super) struct Series {
    /// `scalar` or `fluxgate`.
    pub(super) channel: &'static str,
    /// Noise that the simulator expects, rms, nT.
    pub(super) noise_floor_nt: f64,
    /// Without any effect.
    pub(super) before_nt: Envelope,
    /// With the effects named on this sensor, if there are any.
    pub(super) after_nt: Option<Envelope>,
    /// Amplitude spectrum of the one.
    pub(super) spectrum_before: AmplitudeSpectrum,
    /// Amplitude spectrum of the other.
    pub(super) spectrum_after: AmplitudeSpectrum,
    /// Amplitude spectrum of the noise that the simulator expects.
    pub(super) spectrum_noise: AmplitudeSpectrum,
}

/// Those of all sensors, in the order of the diagnosis.
pub(super) fn series(diagnosis: &Diagnosis) -> Vec<Series> {
    diagnosis.residuals.iter().filter(|residuals| !residuals.time_s.is_empty()).map(|p| of(diagnosis, p)).collect()
}

fn of(diagnosis: &Diagnosis, residuals: &ChannelResiduals) -> Series {
    let channel = residuals.channel;
    let is_changed = diagnosis.effects.iter().any(|effect| effect.channel == channel);
    let gap = diagnosis.channels.iter().find(|gap| gap.channel == channel);
    Series {
        channel,
        noise_floor_nt: gap.map_or(0.0, |gap| gap.noise_floor_rms_nT),
        before_nt: envelope(&residuals.time_s, &residuals.before_nt),
        after_nt: is_changed.then(|| envelope(&residuals.time_s, &residuals.after_nt)),
        spectrum_before: amplitude(&residuals.spectrum_before),
        spectrum_after: amplitude(&residuals.spectrum_after),
        spectrum_noise: amplitude(&residuals.spectrum_noise),
    }
}

fn envelope(time_s: &[f64], values_nt: &[f64]) -> Envelope {
    let mut collector = EnvelopeCollector::default();
    time_s.iter().zip(values_nt).for_each(|(&time_s, &value_nt)| collector.push(time_s, value_nt));
    collector.envelope()
}

/// Amplitude density of power density.
fn amplitude(power: &[[f64; 2]]) -> AmplitudeSpectrum {
    AmplitudeSpectrum {
        frequency_hz: power.iter().map(|[hz, _]| *hz).collect(),
        density: power.iter().map(|[_, power]| power.max(0.0).sqrt()).collect(),
    }
}
