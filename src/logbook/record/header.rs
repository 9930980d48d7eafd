//! What a session ran with.

use super::HEADER;
use crate::bytes::{Put, Take, put_some};
use crate::compensation::{BandPassDesign, Coefficients, ElasticNet};
use crate::{Method, Settings};

/// Longest firmware version, bytes of UTF-8.
pub const VERSION_LEN: usize = 32;

/// What wrote the records that follow, and with which settings: enough to replay them.
///
/// Body: `firmware_version (length u8, UTF-8), build_hash 32 bytes, settings, coefficients 18 x f32, start_tick u32,
/// has_time u8, [start_unix_ms u64]`. Settings: `low_hz f64, high_hz f64, order u8, sample_rate_hz f64, method u8
/// (0 none, 1 fixed, 2 rls, 3 saddle-point), lambda1 f64, lambda2 f64, forgetting f64, dual_step f64`.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Version of the firmware.
    pub firmware_version: heapless::String<VERSION_LEN>,
    /// Hash of the build: names the source and the compiler to replay with.
    pub build_hash: [u8; 32],
    /// The settings, the sample rate (`band_pass.sample_rate_hz`) among them.
    pub settings: Settings,
    /// The coefficients that the session started from, basis of the core, nT.
    pub coefficients: Coefficients,
    /// Tick at the start of the session.
    pub start_tick: u32,
    /// Time at that tick, milliseconds since 1970-01-01 UTC; `None` while the clock is not set.
    pub start_unix_ms: Option<u64>,
}

impl Header {
    pub(super) fn put(&self, put: &mut Put<'_>) -> u8 {
        put.text(&self.firmware_version);
        put.bytes(&self.build_hash);
        put_settings(&self.settings, put);
        put_coefficients(&self.coefficients, put);
        put.u32(self.start_tick);
        put.u8(u8::from(self.start_unix_ms.is_some()));
        put_some(self.start_unix_ms, |unix_ms| put.u64(unix_ms));
        HEADER
    }

    pub(super) fn take(take: &mut Take<'_>) -> Option<Self> {
        Some(Self {
            firmware_version: take.text()?,
            build_hash: take.array()?,
            settings: take_settings(take)?,
            coefficients: take_coefficients(take)?,
            start_tick: take.u32()?,
            start_unix_ms: match take.u8()? {
                0 => None,
                1 => Some(take.u64()?),
                _ => return None,
            },
        })
    }
}

pub(super) fn put_settings(settings: &Settings, put: &mut Put<'_>) {
    let Settings { band_pass, method, penalty, forgetting, dual_step } = settings;
    put.f64(band_pass.low_hz);
    put.f64(band_pass.high_hz);
    match u8::try_from(band_pass.order) {
        Ok(order) => put.u8(order),
        Err(_) => put.refuse(),
    }
    put.f64(band_pass.sample_rate_hz);
    put.u8(match method {
        Method::None => 0,
        Method::Fixed => 1,
        Method::Rls => 2,
        Method::SaddlePoint => 3,
    });
    for value in [penalty.lambda1, penalty.lambda2, *forgetting, *dual_step] {
        put.f64(value);
    }
}

pub(super) fn take_settings(take: &mut Take<'_>) -> Option<Settings> {
    Some(Settings {
        band_pass: BandPassDesign {
            low_hz: take.f64()?,
            high_hz: take.f64()?,
            order: usize::from(take.u8()?),
            sample_rate_hz: take.f64()?,
        },
        method: match take.u8()? {
            0 => Method::None,
            1 => Method::Fixed,
            2 => Method::Rls,
            3 => Method::SaddlePoint,
            _ => return None,
        },
        penalty: ElasticNet { lambda1: take.f64()?, lambda2: take.f64()? },
        forgetting: take.f64()?,
        dual_step: take.f64()?,
    })
}

pub(super) fn put_coefficients(coefficients: &Coefficients, put: &mut Put<'_>) {
    coefficients.basis().iter().for_each(|&value| put.f32(value));
}

/// `None` also when one is not finite: [`Coefficients`] never are.
pub(super) fn take_coefficients(take: &mut Take<'_>) -> Option<Coefficients> {
    let mut basis = *Coefficients::ZERO.basis();
    for value in &mut basis {
        *value = take.f32()?;
    }
    Coefficients::from_basis(basis)
}
