//! Frames and telemetry on the tow cable: what goes in comes out, whatever lies between.

use proptest::collection::vec;
use proptest::prelude::*;
use towmag::link::{
    Activity, CompensatedField, FAULTS, FRAME_OVERHEAD, FaultCounters, FaultSlice, FrameKind, FrameReader, MAX_BODY,
    MAX_FRAME, MAX_TELEMETRY_BODY, Quality, Telemetry, frame, text_frame,
};
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag::{Rejection, Status};

/// All frames in `bytes`.
fn read(reader: &mut FrameReader, bytes: &[u8]) -> Vec<(FrameKind, Vec<u8>)> {
    let mut frames = Vec::new();
    for &byte in bytes {
        if let Some(received) = reader.push(byte) {
            frames.push((received.kind, received.body.to_vec()));
        }
    }
    frames
}

fn kinds() -> impl Strategy<Value = FrameKind> {
    prop_oneof![Just(FrameKind::Telemetry), Just(FrameKind::Text)]
}

/// Bodies with the bytes that framing has to do with in them more often than chance has it.
fn bodies() -> impl Strategy<Value = Vec<u8>> {
    vec(prop_oneof![3 => any::<u8>(), 1 => Just(0), 1 => Just(1), 1 => Just(0xff)], 0..=MAX_BODY)
}

/// Rubbish, often of what frames are made of.
fn rubbish() -> impl Strategy<Value = Vec<u8>> {
    let piece = (bodies(), any::<proptest::sample::Index>(), any::<bool>()).prop_map(|(body, index, from_front)| {
        let whole = frame(FrameKind::Text, &body).unwrap();
        // Never all of it: without the end or without the start and one byte more.
        let cut = index.index(whole.len() - 2);
        if from_front { whole[..=cut].to_vec() } else { whole[cut + 2..].to_vec() }
    });
    vec(prop_oneof![vec(any::<u8>(), 0..400), piece], 0..4).prop_map(|pieces| pieces.concat())
}

fn telemetry() -> impl Strategy<Value = Telemetry> {
    let scalar = prop_oneof![
        Just(ScalarMark::Present),
        Just(ScalarMark::Missing),
        Just(ScalarMark::Invalid),
        Just(ScalarMark::OffTime)
    ];
    let flux = prop_oneof![Just(FluxMark::Present), Just(FluxMark::Missing), Just(FluxMark::Clipped)];
    let quality = (scalar, flux, any::<bool>(), any::<bool>(), any::<Option<u32>>()).prop_map(
        |(scalar, flux, duplicates, relocked, signal)| Quality { scalar, flux, duplicates, relocked, signal },
    );
    let activity = any::<(bool, bool, bool)>().prop_map(|(logging, calibrating, log_failing)| Activity {
        logging,
        calibrating,
        log_failing,
    });
    let compensated = proptest::option::of(
        (any::<i32>(), -1e9_f32..1e9)
            .prop_map(|(compensated_pt, residual_nt)| CompensatedField { compensated_pt, residual_nt }),
    );
    let faults = any::<(u8, [u32; 2])>().prop_map(|(first, counts)| FaultSlice { first, counts });
    let status = (0_u8..7).prop_map(|code| Status::from_code(code).unwrap());
    (
        any::<u32>(),
        any::<(Option<u64>, Option<u16>)>(),
        any::<Option<i32>>(),
        compensated,
        status,
        quality,
        activity,
        faults,
    )
        .prop_map(
            |(tick, (unix_ms, time_error_ms), raw_scalar_pt, compensated, status, quality, activity, faults)| {
                Telemetry {
                    tick,
                    unix_ms,
                    time_error_ms,
                    raw_scalar_pt,
                    compensated,
                    status,
                    quality,
                    activity,
                    faults,
                }
            },
        )
}

proptest! {
    #[test]
    fn frames_come_back(frames in vec((kinds(), bodies()), 0..5)) {
        let mut wire = Vec::new();
        for (kind, body) in &frames {
            let frame = frame(*kind, body).unwrap();
            prop_assert!(frame.len() == body.len() + FRAME_OVERHEAD);
            prop_assert!(frame[1..frame.len() - 1].iter().all(|&byte| byte != 0));
            wire.extend_from_slice(&frame);
        }
        let mut reader = FrameReader::default();
        prop_assert_eq!(read(&mut reader, &wire), frames);
        prop_assert_eq!(reader.counters().bad, 0);
    }

    #[test]
    fn the_frame_after_any_rubbish_is_read(before in rubbish(), kind in kinds(), body in bodies(), after in rubbish()) {
        let frame = frame(kind, &body).unwrap();
        let mut reader = FrameReader::default();
        let first = read(&mut reader, &before);
        let own = read(&mut reader, &frame);
        prop_assert_eq!(&own, &[(kind, body)]);
        let last = read(&mut reader, &after);
        prop_assert_eq!(reader.counters().good as usize, first.len() + 1 + last.len());
    }

    #[test]
    fn a_damaged_frame_is_not_read(kind in kinds(), body in bodies(), place in any::<proptest::sample::Index>(), flip in 1_u8..) {
        let mut wire = frame(kind, &body).unwrap();
        let place = place.index(wire.len());
        wire[place] ^= flip;
        let mut reader = FrameReader::default();
        let next = frame(FrameKind::Text, b"next").unwrap();
        let mut frames = read(&mut reader, &wire);
        frames.extend(read(&mut reader, &next));
        // Damage to a zero at either end is no damage to the frame when nothing comes before, and when another follows.
        frames.retain(|read| *read != (kind, body.clone()));
        prop_assert_eq!(frames, [(FrameKind::Text, b"next".to_vec())]);
    }

    #[test]
    fn telemetry_comes_back(message in telemetry()) {
        let frame = message.frame();
        prop_assert!(frame.len() <= MAX_TELEMETRY_BODY + FRAME_OVERHEAD);
        let frames = read(&mut FrameReader::default(), &frame);
        prop_assert_eq!(frames.len(), 1);
        prop_assert_eq!(frames[0].0, FrameKind::Telemetry);
        prop_assert_eq!(Telemetry::decode(&frames[0].1), Some(message));
    }

    #[test]
    fn what_telemetry_is_read_from_is_what_it_writes(body in vec(prop_oneof![any::<u8>(), 0_u8..8], 0..48)) {
        if let Some(message) = Telemetry::decode(&body) {
            let mut again = [0; MAX_TELEMETRY_BODY];
            let len = message.encode(&mut again).unwrap();
            prop_assert_eq!(&again[..len], &body[..]);
        }
    }

    #[test]
    fn no_telemetry_from_a_part_of_it(message in telemetry(), len in any::<proptest::sample::Index>()) {
        let mut body = [0; MAX_TELEMETRY_BODY];
        let whole = message.encode(&mut body).unwrap();
        prop_assert_eq!(Telemetry::decode(&body[..len.index(whole)]), None);
        prop_assert_eq!(message.encode(&mut body[..len.index(whole)]), None);
    }

    #[test]
    fn text_keeps_whole_characters(line in "\\PC{0,200}") {
        let frames = read(&mut FrameReader::default(), &text_frame(&line));
        let text = std::str::from_utf8(&frames[0].1).unwrap();
        prop_assert!(line.starts_with(text));
        prop_assert!(text.len() == line.len() || text.len() > MAX_BODY - 4);
    }
}

/// The layout is a contract with recordings that exist: these bytes may not change.
#[test]
fn the_bytes_of_a_message() {
    let message = Telemetry {
        tick: 0x0102_0304,
        unix_ms: Some(1_767_225_600_100),
        time_error_ms: None,
        raw_scalar_pt: Some(50_123_456),
        compensated: Some(CompensatedField { compensated_pt: 50_000_001, residual_nt: -0.125 }),
        status: Status::Used,
        quality: Quality {
            scalar: ScalarMark::Present,
            flux: FluxMark::Clipped,
            duplicates: true,
            relocked: false,
            signal: Some(1234),
        },
        activity: Activity { logging: true, calibrating: false, log_failing: true },
        faults: FaultSlice { first: 34, counts: [7, 0] },
    };
    let hex: String = message.frame().iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hex, EXPECTED);
    assert_eq!(message.frame().len(), 48);
    assert_eq!(Telemetry { time_error_ms: Some(12), ..message }.frame().len(), 50);
}

/// Made independently, with another program.
const EXPECTED: &str =
    "0007015f04030201041822070101010101010764a8da769b010109c0d2fc0281f0fa02010104bed2040105bf64b3e600";

#[test]
fn a_rejected_epoch_without_readings_is_small() {
    let message = Telemetry {
        tick: 1,
        unix_ms: None,
        time_error_ms: None,
        raw_scalar_pt: None,
        compensated: None,
        status: Status::Rejected(Rejection::ScalarMissing),
        quality: Quality {
            scalar: ScalarMark::Missing,
            flux: FluxMark::Missing,
            duplicates: false,
            relocked: false,
            signal: None,
        },
        activity: Activity::default(),
        faults: FaultSlice::default(),
    };
    assert_eq!(message.frame().len(), 24);
}

#[test]
fn frames_have_a_longest() {
    assert_eq!(frame(FrameKind::Text, &[7; MAX_BODY]).unwrap().len(), MAX_FRAME);
    assert_eq!(frame(FrameKind::Text, &[7; MAX_BODY + 1]), None);
}

#[test]
fn counters_of_the_reader() {
    let mut reader = FrameReader::default();
    let mut wire = frame(FrameKind::Text, b"one").unwrap().to_vec();
    wire.extend_from_slice(&[9; 1000]);
    wire.extend_from_slice(&frame(FrameKind::Text, b"two").unwrap());
    wire.extend_from_slice(&[0; 50]);
    assert_eq!(read(&mut reader, &wire).len(), 2);
    let counters = reader.counters();
    assert_eq!((counters.good, counters.bad, counters.bad_bytes, counters.unknown), (2, 1, 1000, 0));
}

#[test]
fn every_counter_has_its_turn() {
    let sent = FaultCounters(std::array::from_fn(|number| 1000 + number as u32));
    let mut received = FaultCounters::default();
    for tick in 0..(FAULTS as u32).div_ceil(2) {
        received.update(&sent.slice(7 + tick));
    }
    assert_eq!(received, sent);
    received.update(&FaultSlice { first: 255, counts: [1, 2] });
    assert_eq!(received, sent);
}
