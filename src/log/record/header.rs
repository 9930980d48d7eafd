//! What a session ran with.

use super::kind::HEADER;
use crate::Settings;
use crate::bytes::{Put, Take, put_some};
use crate::model::Coefficients;
use crate::wire::{put_coefficients, put_settings, take_coefficients, take_settings};

/// Longest firmware version, bytes of UTF-8.
pub const VERSION_LEN: usize = 32;

/// What wrote the records that follow, and with which settings: with the [`Information`](super::EventKind::Information)
/// after it, enough to replay them.
///
/// Body: `firmware_version (length u8, UTF-8), build_hash 32 bytes, settings, coefficients 18 x f32, start_tick u32,
/// has_time u8, [start_unix_ms u64]`. Settings: `low_hz f64, high_hz f64, order u8, sample_rate_hz f64, method u8
/// (0 none, 1 fixed, 2 rls, 3 saddle-point, 4 adaptive), lambda1 f64, lambda2 f64, forgetting f64, dual_step f64`.
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
