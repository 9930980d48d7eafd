extern crate std;

use proptest::prelude::*;

use super::*;
use crate::body::UnixTime;
use crate::estimate::{ElasticNet, Information, TRIANGLE};
use crate::filter::BandPassDesign;
use crate::housekeeping::Housekeeping;
use crate::model::{Coefficients, TERMS};
use crate::navigation::{Heading, Navigation, Position};
use crate::{Compensated, Epoch, Method, Output, Rejection, Settings, Status};

fn any_bits_f32() -> impl Strategy<Value = f32> {
    any::<u32>().prop_map(f32::from_bits)
}

fn any_bits_f64() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits)
}

fn status() -> impl Strategy<Value = Status> {
    prop_oneof![
        Just(Status::Used),
        Just(Status::Settling),
        Just(Status::Rejected(Rejection::ScalarMissing)),
        Just(Status::Rejected(Rejection::ScalarOutOfRange)),
        Just(Status::Rejected(Rejection::FluxMissing)),
        Just(Status::Rejected(Rejection::FluxOutOfRange)),
        Just(Status::Rejected(Rejection::AfterGap)),
    ]
}

fn compensated() -> impl Strategy<Value = Compensated> {
    (any_bits_f32(), any::<i32>(), any_bits_f32(), any_bits_f32(), any_bits_f32()).prop_map(
        |(interference_nt, compensated_pt, band_passed_nt, residual_nt, residual_after_update_nt)| Compensated {
            interference_nt,
            compensated_pt,
            band_passed_nt,
            residual_nt,
            residual_after_update_nt,
        },
    )
}

fn epoch() -> impl Strategy<Value = Record> {
    let flux_nt = proptest::array::uniform3(any_bits_f32());
    let input = (any::<u32>(), any::<Option<i32>>(), proptest::option::of(flux_nt));
    let output_tick = prop_oneof![3 => Just(None), 1 => any::<u32>().prop_map(Some)];
    let output = (output_tick, status(), proptest::option::of(compensated()));
    (input, output, proptest::option::of(any_bits_f32()), any::<Option<u32>>()).prop_map(
        |((tick, scalar_pt, flux_nt), (output_tick, status, compensated), battery_a, faults)| {
            Record::Epoch(EpochRecord {
                epoch: Epoch { tick, scalar_pt, flux_nt },
                output: Output { tick: output_tick.unwrap_or(tick), status, compensated },
                battery_a,
                faults,
            })
        },
    )
}

fn settings() -> impl Strategy<Value = Settings> {
    let method = prop_oneof![Just(Method::None), Just(Method::Fixed), Just(Method::Rls), Just(Method::SaddlePoint)];
    (proptest::array::uniform7(any_bits_f64()), any::<u8>(), method).prop_map(|(values, order, method)| {
        let [low_hz, high_hz, sample_rate_hz, lambda1, lambda2, forgetting, dual_step] = values;
        Settings {
            band_pass: BandPassDesign { low_hz, high_hz, order: usize::from(order), sample_rate_hz },
            method,
            penalty: ElasticNet { lambda1, lambda2 },
            forgetting,
            dual_step,
        }
    })
}

fn coefficients() -> impl Strategy<Value = Coefficients> {
    proptest::collection::vec(any_bits_f32(), TERMS).prop_map(|values| {
        let mut basis = [0.0; TERMS];
        for (basis, value) in basis.iter_mut().zip(values).filter(|(_, value)| value.is_finite()) {
            *basis = value;
        }
        Coefficients::from_basis(basis).unwrap()
    })
}

fn header() -> impl Strategy<Value = Record> {
    (".{0,40}", any::<[u8; 32]>(), settings(), coefficients(), any::<u32>(), any::<Option<u64>>()).prop_map(
        |(version, build_hash, settings, coefficients, start_tick, start_unix_ms)| {
            Record::Header(Header {
                firmware_version: truncated(&version),
                build_hash,
                settings,
                coefficients,
                start_tick,
                start_unix_ms,
            })
        },
    )
}

fn reset_cause() -> impl Strategy<Value = ResetCause> {
    use ResetCause::*;
    prop_oneof![Just(PowerOn), Just(BrownOut), Just(Pin), Just(Software), Just(Watchdog), Just(LowPower), Just(Unknown)]
}

fn navigation() -> impl Strategy<Value = Navigation> {
    let metres = || proptest::option::of(any_bits_f32());
    let position = proptest::option::of(any::<(i32, i32, u8)>());
    let heading = proptest::option::of((any_bits_f32(), any::<bool>()));
    (metres(), metres(), position, heading).prop_map(|(depth_m, altitude_m, position, heading)| Navigation {
        depth_m,
        altitude_m,
        position: position.map(|(latitude_e7, longitude_e7, fix)| Position { latitude_e7, longitude_e7, fix }),
        heading: heading.map(|(deg, is_magnetic)| Heading { deg, is_magnetic }),
    })
}

fn fluxgate_calibrated() -> impl Strategy<Value = EventKind> {
    let axes = (
        proptest::array::uniform5(proptest::array::uniform3(any_bits_f64())),
        proptest::array::uniform3(proptest::array::uniform3(any_bits_f32())),
    );
    (axes, any::<u32>(), any_bits_f32(), any_bits_f32()).prop_map(
        |(([nt_per_count, bias_nt, x, y, z], [bias_std_nt, scale_std, angle_std_deg]), used_epochs, before, after)| {
            let body_from_sensor = [x, y, z];
            EventKind::FluxgateCalibrated {
                axes: FluxgateAxes { nt_per_count, bias_nt, body_from_sensor, bias_std_nt, scale_std, angle_std_deg },
                used_epochs,
                rms_before_nt: before,
                rms_after_nt: after,
            }
        },
    )
}

fn event() -> impl Strategy<Value = Record> {
    let calibrated = (coefficients(), any::<u32>(), any_bits_f32(), any_bits_f32()).prop_map(
        |(coefficients, used_epochs, std_before_nt, rms_after_nt)| EventKind::Calibrated {
            coefficients,
            used_epochs,
            std_before_nt,
            rms_after_nt,
        },
    );
    let kinds = [EventKind::Information, EventKind::Level, EventKind::EarlierLevel];
    let information = (coefficients(), 0..5_usize, 0..3_usize).prop_map(move |(centre, part, kind)| {
        let information = Information::new(centre, [0.5; TRIANGLE], 0.3).unwrap();
        kinds[kind](InformationPart::all(&information).nth(part).unwrap())
    });
    let kind = prop_oneof![
        reset_cause().prop_map(EventKind::Reset),
        ".{0,250}".prop_map(|text| EventKind::Panic(truncated(&text))),
        settings().prop_map(EventKind::SettingsChanged),
        prop_oneof![
            any::<u64>().prop_map(|unix_ms| EventKind::TimeSet { unix_ms }),
            (any::<u64>(), any::<u32>())
                .prop_map(|(unix_us, error_us)| EventKind::Time(UnixTime { unix_us, error_us })),
        ],
        prop_oneof![calibrated, fluxgate_calibrated()],
        any::<u32>().prop_map(|used_epochs| EventKind::CalibrationFailed { used_epochs }),
        prop_oneof![Just(EventKind::LogStart), Just(EventKind::LogStop)],
        any::<(u32, u32)>().prop_map(|(first_position, blocks)| EventKind::BadBlocks { first_position, blocks }),
        prop_oneof![any::<[u16; 8]>().prop_map(EventKind::FaultCounters), information],
        prop_oneof![
            navigation().prop_map(EventKind::Navigation),
            (proptest::option::of(any_bits_f32()), any::<Option<bool>>())
                .prop_map(|(battery_v, has_leak)| EventKind::Housekeeping(Housekeeping { battery_v, has_leak })),
        ],
    ];
    (any::<u32>(), kind).prop_map(|(tick, kind)| Record::Event(Event { tick, kind }))
}

fn record() -> impl Strategy<Value = Record> {
    let loss = any::<(u32, u32, u32)>()
        .prop_map(|(first_tick, epochs, others)| Record::Loss(Loss { first_tick, epochs, others }));
    prop_oneof![4 => epoch(), 2 => header(), 3 => event(), 1 => loss]
}

fn encoded(record: &Record) -> std::vec::Vec<u8> {
    let mut bytes = [0xA5; Record::MAX_LEN];
    let len = record.encode(&mut bytes).unwrap();
    bytes[..len].to_vec()
}

/// Bytes of records whose kind and length make sense more often than chance would have it.
fn nearly_a_record() -> impl Strategy<Value = std::vec::Vec<u8>> {
    (record(), any::<proptest::sample::Index>(), any::<u8>(), 0..300_usize).prop_map(|(record, index, flip, len)| {
        let mut bytes = encoded(&record);
        let at = index.index(bytes.len());
        bytes[at] ^= flip;
        bytes.truncate(len);
        bytes
    })
}

proptest! {
    #[test]
    fn decoding_returns_what_was_encoded(record in record()) {
        let bytes = encoded(&record);
        let (decoded, len) = Record::decode(&bytes).unwrap();
        prop_assert_eq!(len, bytes.len());
        // NaN is not equal to itself, and -0.0 equal to 0.0: Debug and the bytes tell.
        prop_assert_eq!(encoded(&decoded), bytes);
        prop_assert_eq!(std::format!("{decoded:?}"), std::format!("{record:?}"));
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = Record::decode(&bytes);
    }

    #[test]
    fn damaged_records_never_panic(bytes in nearly_a_record()) {
        if let Ok((decoded, len)) = Record::decode(&bytes) {
            prop_assert_eq!(&encoded(&decoded)[..], &bytes[..len]);
        }
    }

    #[test]
    fn a_short_buffer_is_refused(record in record(), missing in 1..100_usize) {
        let len = encoded(&record).len();
        let mut bytes = std::vec![0; len.saturating_sub(missing)];
        prop_assert_eq!(record.encode(&mut bytes), None);
    }
}

#[test]
fn an_epoch_takes_48_bytes() {
    let output = Output {
        tick: 5,
        status: Status::Used,
        compensated: Some(Compensated {
            interference_nt: 1.0,
            compensated_pt: 50_000_000,
            band_passed_nt: 2.0,
            residual_nt: 3.0,
            residual_after_update_nt: 4.0,
        }),
    };
    let epoch = Epoch { tick: 5, scalar_pt: Some(50_000_001), flux_nt: Some([1.0, 2.0, 3.0]) };
    let record = Record::Epoch(EpochRecord { epoch, output, battery_a: Some(0.5), faults: None });
    assert_eq!(encoded(&record).len(), 48);
}

/// The bytes of a known record: a change of the format must show here, and in the format version.
#[test]
fn format_has_not_changed() {
    let epoch = Epoch { tick: 0x0102_0304, scalar_pt: Some(-2), flux_nt: None };
    let output = Output { tick: 0x0102_0304, status: Status::Rejected(Rejection::FluxMissing), compensated: None };
    let record = Record::Epoch(EpochRecord { epoch, output, battery_a: Some(1.0), faults: None });
    let expected = [2, 14, 0b1001, 4, 4, 3, 2, 1, 0xFE, 0xFF, 0xFF, 0xFF, 0, 0, 0x80, 0x3F];
    assert_eq!(encoded(&record), expected);
}

#[test]
fn information_comes_back_from_its_parts_in_any_order() {
    let triangle = core::array::from_fn(|i| i as f32 + 0.25);
    let information = Information::new(Coefficients::ZERO, triangle, 0.3).unwrap();
    let mut parts = InformationParts::default();
    for part in InformationPart::all(&information).collect::<std::vec::Vec<_>>().iter().rev() {
        assert_eq!(parts.information(), None);
        parts.add(part);
    }
    assert_eq!(parts.information(), Some(information));
}

#[test]
fn an_order_beyond_the_format_is_refused() {
    let mut settings = Settings::default();
    settings.band_pass.order = 256;
    let record = Record::Event(Event { tick: 0, kind: EventKind::SettingsChanged(settings) });
    assert_eq!(record.encode(&mut [0; Record::MAX_LEN]), None);
}
