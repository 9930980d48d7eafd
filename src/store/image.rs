//! Settings and coefficients as bytes.
//!
//! `"TMST", version u16, payload length u16, sequence u32, payload, CRC-32/ISO-HDLC u32` over all before it;
//! little-endian, floating-point numbers as their IEEE 754 bits. Payload of version 7, 1,916 bytes at most: estimator
//! (`low_hz f64, high_hz f64, order u8, sample_rate_hz f64, method u8, lambda1 f64, lambda2 f64, forgetting f64,
//! dual_step f64`), scalar sensor (`format u8 and its own parameters, lowest_nt f64, highest_nt f64, weakest_signal u32,
//! strongest_signal u32, baud u32`), fluxgate (17 f64 in the order of [`FluxgateSettings`]), grid (`4 u32, u8` in the order
//! of [`GridSettings`]), `log u8, log_file_h u32, cable_baud u32` (not in
//! version 2), `nmea_baud u32, nmea_depth_is u8 (0 depth, 1 altitude), nmea_surface_dbar f64` and the G-882's channels (4 f64 in the order of
//! [`ChannelSettings`]; both not before version 4), `battery_v_per_count f64, battery_low_v f64, leak_fitted u8` (not before
//! version 5), 18 coefficients in the core's basis (f32), `has_information u8`, then, if it is 1, the
//! calibration's information (18 f32 of its solution, 171 f32 of its triangle, `noise_nt f32`), and the same again of what it
//! has learnt of the level (not before version 6, whose is in columns 1 and left aside: [`LEVEL_COLUMNS`]).

use super::body_settings::{BodySettings, CABLE_BAUD, Stored};
use crate::bytes::{Put, Take, put_some};
use crate::estimate::LEVEL_COLUMNS;
use crate::housekeeping::HousekeepingSettings;
use crate::sensors::fluxgate::FluxgateSettings;
use crate::sensors::grid::GridSettings;
use crate::sensors::nmea::{DepthIs, NmeaSettings};
use crate::sensors::scalar::{ChannelSettings, FORMATS, ScalarFormat, ScalarSettings, Value};
use crate::wire::{
    put_coefficients, put_information, put_settings, take_coefficients, take_information, take_settings,
};
use crc::{CRC_32_ISO_HDLC, Crc};

/// Bytes that one image takes up in the flash.
pub const SLOT_LEN: usize = 2048;

/// Layout of the payload. A firmware writes this one, and reads those from version 2 on.
pub const IMAGE_VERSION: u16 = 7;

/// The oldest layout that is read.
const OLDEST_VERSION: u16 = 2;

/// The first layouts with the baud rate of the cable, with the third UART and the channels, with leak and battery, with
/// a level, and with one in columns [2](LEVEL_COLUMNS).
const WITH_CABLE_BAUD: u16 = 3;
const WITH_NMEA: u16 = 4;
const WITH_HOUSEKEEPING: u16 = 5;
const WITH_EARLIER_LEVEL: u16 = 6;
const WITH_LEVEL: u16 = 7;
const _: () = assert!(LEVEL_COLUMNS == 2, "other columns need another version of the image");

/// What blank flash reads as.
pub(super) const BLANK: u8 = 0xff;

const MAGIC: [u8; 4] = *b"TMST";
const HEAD_LEN: usize = 12;
const CRC_LEN: usize = 4;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The bytes of one slot.
pub(super) type SlotBytes = [u8; SLOT_LEN];

/// What a slot holds.
#[derive(Clone, Debug, PartialEq)]
// Lives on the stack for the time of a scan, one at a time.
#[allow(clippy::large_enum_variant)]
pub(super) enum Content {
    /// Nothing: it can be written.
    Blank,
    /// A whole image.
    Image { sequence: u32, stored: Stored },
    /// A whole image of another version, or with settings that this firmware does not accept.
    Foreign { sequence: u32 },
    /// Neither: cut, damaged, or something else.
    Junk,
}

/// The bytes of an image, followed by [`BLANK`]; `None` for a band-pass order beyond a byte, which no valid settings have.
pub(super) fn encode(sequence: u32, stored: &Stored) -> Option<SlotBytes> {
    let mut slot = [BLANK; SLOT_LEN];
    let mut put = Put::new(slot.get_mut(HEAD_LEN..SLOT_LEN - CRC_LEN)?);
    put_stored(stored, &mut put);
    let payload_len = put.finish()?;
    let mut head = Put::new(&mut slot);
    MAGIC.iter().for_each(|&byte| head.u8(byte));
    head.u16(IMAGE_VERSION);
    head.u16(u16::try_from(payload_len).ok()?);
    head.u32(sequence);
    let crc = CRC.checksum(slot.get(..HEAD_LEN + payload_len)?);
    slot.get_mut(HEAD_LEN + payload_len..)?.first_chunk_mut::<CRC_LEN>()?.copy_from_slice(&crc.to_le_bytes());
    Some(slot)
}

/// What the bytes of a slot are.
pub(super) fn decode(slot: &SlotBytes) -> Content {
    if slot.iter().all(|&byte| byte == BLANK) {
        return Content::Blank;
    }
    let Some((version, sequence, payload)) = open(slot) else { return Content::Junk };
    let is_known = (OLDEST_VERSION..=IMAGE_VERSION).contains(&version);
    let stored = if is_known { take_stored(payload, version) } else { None };
    match stored.filter(|stored| stored.settings.validate().is_ok()) {
        Some(stored) => Content::Image { sequence, stored },
        None => Content::Foreign { sequence },
    }
}

/// Whether there is an image whose CRC fits, of whatever version.
pub(super) fn is_whole(slot: &SlotBytes) -> bool {
    open(slot).is_some()
}

/// Version, sequence number and payload, if the frame around them is intact.
fn open(slot: &SlotBytes) -> Option<(u16, u32, &[u8])> {
    let mut head = Take(slot);
    let magic: [u8; 4] = head.array()?;
    let (version, payload_len, sequence) = (head.u16()?, usize::from(head.u16()?), head.u32()?);
    let (content, rest) = slot.split_at_checked(HEAD_LEN + payload_len)?;
    let crc = rest.first_chunk::<CRC_LEN>()?;
    let intact = magic == MAGIC && CRC.checksum(content).to_le_bytes() == *crc;
    intact.then_some((version, sequence, content.get(HEAD_LEN..)?))
}

fn put_stored(stored: &Stored, put: &mut Put<'_>) {
    let BodySettings { estimator, scalar, channels, scalar_baud, cable_baud, nmea, .. } = &stored.settings;
    let BodySettings { housekeeping, fluxgate, grid, log, log_file_h, .. } = &stored.settings;
    put_settings(estimator, put);
    put_scalar(scalar, put);
    put.u32(*scalar_baud);
    fluxgate_numbers(fluxgate).for_each(|value| put.f64(value));
    put_grid(grid, put);
    put.u8(u8::from(*log));
    put.u32(*log_file_h);
    put.u32(*cable_baud);
    put_nmea(nmea, put);
    put_channels(channels, put);
    put_housekeeping(housekeeping, put);
    put_coefficients(&stored.coefficients, put);
    for known in [&stored.information, &stored.level] {
        put.u8(u8::from(known.is_some()));
        put_some(known.as_ref(), |information| put_information(information, put));
    }
}

fn take_stored(payload: &[u8], version: u16) -> Option<Stored> {
    let take = &mut Take(payload);
    let settings = BodySettings {
        estimator: take_settings(take)?,
        scalar: take_scalar(take)?,
        scalar_baud: take.u32()?,
        fluxgate: take_fluxgate(take)?,
        grid: take_grid(take)?,
        log: take_bool(take)?,
        log_file_h: take.u32()?,
        cable_baud: if version >= WITH_CABLE_BAUD { take.u32()? } else { CABLE_BAUD },
        nmea: if version >= WITH_NMEA { take_nmea(take)? } else { NmeaSettings::default() },
        channels: if version >= WITH_NMEA { take_channels(take)? } else { ChannelSettings::default() },
        housekeeping: if version >= WITH_HOUSEKEEPING { take_housekeeping(take)? } else { Default::default() },
    };
    let coefficients = take_coefficients(take)?;
    let information = if take_bool(take)? { Some(take_information(take)?) } else { None };
    let has_level = version >= WITH_EARLIER_LEVEL && take_bool(take)?;
    let level = if has_level { Some(take_information(take)?) } else { None };
    let level = level.filter(|_| version >= WITH_LEVEL);
    take.is_empty().then_some(Stored { settings, coefficients, information, level })
}

/// The format's tag and the values of its parameters in their order: a number as `f64`, all others as `u8`.
fn put_scalar(scalar: &ScalarSettings, put: &mut Put<'_>) {
    put.u8(scalar.format.format().tag);
    for (_, value) in scalar.format.parameters() {
        match *value {
            Value::Number(number) => put.f64(number),
            Value::Small(byte) | Value::Mark(byte) => put.u8(byte),
            Value::Switch(on) => put.u8(u8::from(on)),
        }
    }
    put.f64(scalar.lowest_nt);
    put.f64(scalar.highest_nt);
    put.u32(scalar.weakest_signal);
    put.u32(scalar.strongest_signal);
}

fn take_scalar(take: &mut Take<'_>) -> Option<ScalarSettings> {
    let tag = take.u8()?;
    let mut format = ScalarFormat::of(FORMATS.into_iter().find(|format| format.tag == tag)?);
    for value in format.values_mut() {
        match value {
            Value::Number(number) => *number = take.f64()?,
            Value::Small(byte) | Value::Mark(byte) => *byte = take.u8()?,
            Value::Switch(on) => *on = take_bool(take)?,
        }
    }
    Some(ScalarSettings {
        format,
        lowest_nt: take.f64()?,
        highest_nt: take.f64()?,
        weakest_signal: take.u32()?,
        strongest_signal: take.u32()?,
    })
}

fn fluxgate_numbers(fluxgate: &FluxgateSettings) -> impl Iterator<Item = f64> {
    let FluxgateSettings { nt_per_count, bias_nt, body_from_sensor, ampere_per_count, current_bias_a } = *fluxgate;
    let axes = nt_per_count.into_iter().chain(bias_nt).chain(body_from_sensor.into_iter().flatten());
    axes.chain([ampere_per_count, current_bias_a])
}

fn take_fluxgate(take: &mut Take<'_>) -> Option<FluxgateSettings> {
    let mut axes = [[0.0; 3]; 5];
    for value in axes.iter_mut().flatten() {
        *value = take.f64()?;
    }
    let [nt_per_count, bias_nt, x, y, z] = axes;
    let (ampere_per_count, current_bias_a) = (take.f64()?, take.f64()?);
    Some(FluxgateSettings { nt_per_count, bias_nt, body_from_sensor: [x, y, z], ampere_per_count, current_bias_a })
}

fn put_grid(grid: &GridSettings, put: &mut Put<'_>) {
    let GridSettings { scalar_delay_us, flux_delay_us, latency_us, tolerance_us, conversions_per_epoch } = *grid;
    for value in [scalar_delay_us, flux_delay_us, latency_us, tolerance_us] {
        put.u32(value);
    }
    put.u8(conversions_per_epoch);
}

fn take_grid(take: &mut Take<'_>) -> Option<GridSettings> {
    Some(GridSettings {
        scalar_delay_us: take.u32()?,
        flux_delay_us: take.u32()?,
        latency_us: take.u32()?,
        tolerance_us: take.u32()?,
        conversions_per_epoch: take.u8()?,
    })
}

fn put_nmea(nmea: &NmeaSettings, put: &mut Put<'_>) {
    let NmeaSettings { baud, depth_is, surface_dbar } = *nmea;
    put.u32(baud);
    put.u8(match depth_is {
        DepthIs::Depth => 0,
        DepthIs::Altitude => 1,
    });
    put.f64(surface_dbar);
}

fn take_nmea(take: &mut Take<'_>) -> Option<NmeaSettings> {
    Some(NmeaSettings {
        baud: take.u32()?,
        depth_is: match take.u8()? {
            0 => DepthIs::Depth,
            1 => DepthIs::Altitude,
            _ => return None,
        },
        surface_dbar: take.f64()?,
    })
}

fn put_channels(channels: &ChannelSettings, put: &mut Put<'_>) {
    let ChannelSettings { depth_m_per_count, depth_bias_m, altitude_m_per_count, altitude_bias_m } = *channels;
    for value in [depth_m_per_count, depth_bias_m, altitude_m_per_count, altitude_bias_m] {
        put.f64(value);
    }
}

fn take_channels(take: &mut Take<'_>) -> Option<ChannelSettings> {
    Some(ChannelSettings {
        depth_m_per_count: take.f64()?,
        depth_bias_m: take.f64()?,
        altitude_m_per_count: take.f64()?,
        altitude_bias_m: take.f64()?,
    })
}

fn put_housekeeping(housekeeping: &HousekeepingSettings, put: &mut Put<'_>) {
    let HousekeepingSettings { battery_v_per_count, battery_low_v, is_leak_fitted } = *housekeeping;
    put.f64(battery_v_per_count);
    put.f64(battery_low_v);
    put.u8(u8::from(is_leak_fitted));
}

fn take_housekeeping(take: &mut Take<'_>) -> Option<HousekeepingSettings> {
    Some(HousekeepingSettings {
        battery_v_per_count: take.f64()?,
        battery_low_v: take.f64()?,
        is_leak_fitted: take_bool(take)?,
    })
}

fn take_bool(take: &mut Take<'_>) -> Option<bool> {
    match take.u8()? {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    }
}
