//! Scalar sensors: recorded and documented lines, rubbish in any split, and the serial port.

use embedded_hal_mock::eh1::serial::{Mock, Transaction};
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::ErrorKind;
use proptest::prelude::*;
use towmag::sensors::scalar::{
    FORMATS, Format, LONGEST_SENTENCE, Reading, ScalarFaults, ScalarParser, ScalarReader, ScalarSettings, Value,
    qtfm_gen1, qtfm_gen2, seaspy,
};

const GEN1: ScalarSettings = ScalarSettings::of(&qtfm_gen1::FORMAT);
const GEN2: ScalarSettings = ScalarSettings::of(&qtfm_gen2::FORMAT);
const SEASPY: ScalarSettings = ScalarSettings::of(&seaspy::FORMAT);

/// Scale of the QTFM Gen-1 (<http://quspin.com/qtfm/qtfm-serial-communication/>, 2017).
const GEN1_COUNTS_PER_NT: f64 = 6009.342147;

/// A sensor of this format with one parameter set.
fn with(format: &'static Format, name: &str, value: Value) -> ScalarSettings {
    let mut settings = ScalarSettings::of(format);
    *settings.format.value_mut(name).unwrap() = value;
    settings
}

/// All readings of these bytes, byte `n` stamped `n`.
fn parse(parser: &mut ScalarParser, bytes: &[u8]) -> Vec<Reading> {
    bytes.iter().zip(0..).filter_map(|(byte, now_us)| parser.push(*byte, now_us)).collect()
}

fn read(settings: &ScalarSettings, bytes: &[u8]) -> (Vec<Reading>, ScalarFaults) {
    let mut parser = settings.build().unwrap();
    let readings = parse(&mut parser, bytes);
    (readings, *parser.faults())
}

/// The one reading of a faultless line.
fn one(settings: &ScalarSettings, line: &str) -> Reading {
    let (readings, faults) = read(settings, line.as_bytes());
    assert_eq!(faults, ScalarFaults::default(), "{line:?}");
    assert_eq!(readings.len(), 1, "{line:?}");
    readings[0]
}

fn none(settings: &ScalarSettings, line: &str, expected: ScalarFaults) {
    let (readings, faults) = read(settings, line.as_bytes());
    assert_eq!((readings, faults), (vec![], expected), "{line:?}");
}

macro_rules! one_fault {
    ($field:ident) => {
        ScalarFaults { $field: 1, ..ScalarFaults::default() }
    };
}

#[test]
fn g882_lines_of_the_manual() {
    // G-882 manual p. 47.
    for (line, scalar_pt, signal) in [
        ("$ 49895.131,1249\r\n", 49_895_131, 1249),
        ("$ 49895.376,1287\r\n", 49_895_376, 1287),
        ("$ 49995.517,1245\r\n", 49_995_517, 1245),
    ] {
        let expected = Reading {
            scalar_pt,
            signal: Some(signal),
            counter: None,
            channels: [None; 2],
            valid: true,
            first_byte_us: 0,
            last_byte_us: 16,
        };
        assert_eq!(one(&ScalarSettings::G882, line), expected);
    }
}

#[test]
fn g882_more_channels_and_clock() {
    // Depth 112 at the surface (manual p. 74), altitude 9900 in air (p. 83); lamp, RF, heater and supplies (p. 84).
    let depth_and_altitude = [Some(112), Some(9900)];
    for (line, channels) in [
        ("$ 49895.131,1249,0112\r\n", [Some(112), None]),
        ("$ 49895.131,1249,0112,9900\r\n", depth_and_altitude),
        ("$ 49895.131,1249,0112,9900,5600,2200,1800,6500,5100\r\n", depth_and_altitude),
        ("$ 49895.131,1249,D123H23M59S59_99\r\n", [None; 2]),
        ("$ 49895.131,1249,0112,9900,5600,2200,1800,6500,5100,D123H23M59S59_99\r\n", depth_and_altitude),
    ] {
        let reading = one(&ScalarSettings::G882, line);
        assert_eq!((reading.scalar_pt, reading.signal, reading.valid), (49_895_131, Some(1249), true), "{line:?}");
        assert_eq!(reading.channels, channels, "{line:?}");
        assert!(line.len() < LONGEST_SENTENCE);
    }
}

#[test]
fn g882_above_100000_nt() {
    assert!(one(&ScalarSettings::G882, "$100000.000,1249\r\n").valid);
    let (readings, faults) = read(&ScalarSettings::G882, b"$149895.131,1249\r\n");
    assert_eq!((readings[0].scalar_pt, readings[0].valid), (149_895_131, false));
    assert_eq!(faults, one_fault!(out_of_range));
}

#[test]
fn g882_refuses_what_is_not_its_form() {
    for (line, expected) in [
        ("$\r\n", one_fault!(cut_lines)),
        ("$ 49895.13\r\n", one_fault!(cut_lines)),
        ("$ 49895.131\r\n", one_fault!(cut_lines)),
        ("$ 49895.131,124\r\n", one_fault!(cut_lines)),
        ("$ 49895.131,1249,D123H23M59\r\n", one_fault!(cut_lines)),
        ("$249895.131,1249\r\n", one_fault!(bad_number)),
        ("$ 4989x.131,1249\r\n", one_fault!(bad_number)),
        ("$ 49895.131,-249\r\n", one_fault!(bad_number)),
        ("$ 49895.131,12490\r\n", one_fault!(malformed)),
        ("$ 49895,131,1249\r\n", one_fault!(malformed)),
        ("$ 49895.131,1,2,3,4\r\n", one_fault!(bad_number)),
        ("$ 49895.131,0001,0002,0003,0004,0005,0006,0007,0008,0009\r\n", one_fault!(malformed)),
        // Two counters in a daisy chain.
        ("$ 49895.131,1249, 49995.517,1245\r\n", one_fault!(bad_number)),
        ("$ 49895.131,1249,149995.517,1245\r\n", one_fault!(malformed)),
    ] {
        none(&ScalarSettings::G882, line, expected);
    }
}

#[test]
fn g882_weak_signal_is_invalid() {
    // Warming up (manual p. 83).
    let (readings, faults) = read(&ScalarSettings::G882, b"$ 49895.131,0010\r\n");
    assert_eq!((readings[0].scalar_pt, readings[0].valid), (49_895_131, false));
    assert_eq!(faults, one_fault!(signal_out_of_limits));
    let settings = ScalarSettings { weakest_signal: 10, ..ScalarSettings::G882 };
    assert!(one(&settings, "$ 49895.131,0010\r\n").valid);
}

#[test]
fn gen1_by_decimation() {
    let settings = &GEN1;
    // 300467107 / 6009.342147 = 49,999.99994 nT.
    for (line, signal, counter) in [
        ("!300467107\r\n", None, None),
        ("!300467107@1234\r\n", Some(1234), None),
        ("!300467107@1234^17\r\n", Some(1234), Some(17)),
    ] {
        let reading = one(settings, line);
        assert_eq!((reading.scalar_pt, reading.signal, reading.counter), (50_000_000, signal, counter));
        assert!(reading.valid);
    }
    none(settings, "!\r\n", one_fault!(cut_lines));
    none(settings, "!300467107@\r\n", one_fault!(cut_lines));
    none(settings, "!300467107^17\r\n", one_fault!(malformed));
    none(settings, "!300467107@12^1@5\r\n", one_fault!(malformed));
    none(settings, "!-300467107\r\n", one_fault!(bad_number));
    none(settings, "!9999999999\r\n", one_fault!(bad_number));
    let (readings, faults) = read(settings, b"!4294967295\r\n");
    assert_eq!((readings[0].valid, faults), (false, one_fault!(out_of_range)));
}

#[test]
fn gen1_keeps_every_count() {
    // Neighbouring counts are 0.17 pT apart; through f32 they would be 5 pT apart at best.
    for count in [300_467_107_u32, 300_467_108, 300_467_110, 600_934_214, 6_009_343] {
        let exact_pt = f64::from(count) * 1000.0 / GEN1_COUNTS_PER_NT;
        let reading = one(&GEN1, &format!("!{count}\r\n"));
        assert!((f64::from(reading.scalar_pt) - exact_pt).abs() <= 0.5 + 1e-6, "{count}");
    }
}

#[test]
fn gen2_recorded_lines() {
    let settings = &GEN2;
    let reading = one(settings, "!51318.312_X17130.334=>141949s054v076i0.43j-0.49k0.49\r\n");
    assert_eq!((reading.scalar_pt, reading.signal, reading.counter), (51_318_312, Some(54), None));
    assert!(reading.valid);
    let reading = one(settings, "!51312.571_s126\r\n");
    assert_eq!((reading.scalar_pt, reading.signal, reading.valid), (51_312_571, Some(126), true));
    let reading = one(settings, "!51312.571_Y-17130.334?@4711>141949s126v076\r\n");
    assert_eq!((reading.signal, reading.counter, reading.valid), (Some(126), Some(4711), true));
    // The digits before it were added by the logger; here they are rubbish.
    let (readings, faults) = read(settings, b"118743331!51318.312_s054\r\n");
    assert_eq!((readings.len(), faults.rubbish_bytes), (1, 9));
}

#[test]
fn gen2_marks() {
    let settings = &GEN2;
    for line in [&b"!51312.571*s126\r\n"[..], b"!51312.571s126\r\n"] {
        let (readings, faults) = read(settings, line);
        assert_eq!((readings[0].scalar_pt, readings[0].valid), (51_312_571, false));
        assert_eq!(faults, one_fault!(flagged_invalid));
    }
    let lenient = with(&qtfm_gen2::FORMAT, "gen2_mark_required", Value::Switch(false));
    assert!(one(&lenient, "!51312.571s126\r\n").valid);
}

#[test]
fn gen2_refuses_what_is_not_its_form() {
    for (line, expected) in [
        ("!51318.31_s126\r\n", one_fault!(bad_number)),
        ("!51318.3121_s126\r\n", one_fault!(malformed)),
        ("!51318_s126\r\n", one_fault!(malformed)),
        ("!51318.3\r\n", one_fault!(cut_lines)),
        ("!51312.571_s\r\n", one_fault!(cut_lines)),
        ("!51312.571_s126s126\r\n", one_fault!(malformed)),
        ("!51312.571_X1.0=Y1.0=\r\n", one_fault!(malformed)),
        ("!51312.571_s126,5\r\n", one_fault!(malformed)),
        ("!51312.571_X1.=\r\n", one_fault!(bad_number)),
    ] {
        none(&GEN2, line, expected);
    }
}

#[test]
fn gen2_other_scales() {
    let decimals = |decimals| with(&qtfm_gen2::FORMAT, "gen2_decimals", Value::Small(decimals));
    assert_eq!(one(&decimals(1), "!51312.5_s126\r\n").scalar_pt, 51_312_500);
    assert_eq!(one(&decimals(5), "!51312.57151_\r\n").scalar_pt, 51_312_572);
    assert_eq!(one(&decimals(0), "!51312_\r\n").scalar_pt, 51_312_000);
    assert_eq!(one(&ScalarSettings::of(&qtfm_gen2::COUNTS), "!300467107_s126\r\n").scalar_pt, 50_000_000);
}

#[test]
fn seaspy_lines() {
    // Made after the form that the module cites: no recorded line was at hand.
    for (line, scalar_pt, signal) in [
        ("*26.232/01:02:03.4 F:050123.456 S:1050 D:+008.0m A:022.0 L:0 250ms_Q:05 !!!!\r\n", 50_123_456, 1050),
        ("*26.232/01:02:03.4 F:050123.456 S:180 D:-000.1m A:022.0m L:1 Q:99\r\n", 50_123_456, 180),
        ("*26.232/01:02:03.4 F:100000.000 S:90 \r\n", 100_000_000, 90),
    ] {
        let reading = one(&SEASPY, line);
        assert_eq!((reading.scalar_pt, reading.signal, reading.valid), (scalar_pt, Some(signal), true), "{line:?}");
    }
    for (line, expected) in [
        ("*26.232/01:02:03.4 F:050123.456 S:1050\r\n", one_fault!(cut_lines)),
        ("*26.232/01:02:03.4 F:050123.4\r\n", one_fault!(cut_lines)),
        ("*26.232/01:02:03.4 F:50123.456 S:1050 \r\n", one_fault!(bad_number)),
        ("*26.232/01:02:03.4 F:050123.45 S:1050 \r\n", one_fault!(bad_number)),
        ("*26.232/01:02:03 F:050123.456 S:1050 \r\n", one_fault!(malformed)),
        ("*26.232/01:02:03.4 S:1050 F:050123.456 \r\n", one_fault!(malformed)),
        ("*26.232/01:02:03.4 F:050123.456 S:1O50 \r\n", one_fault!(malformed)),
    ] {
        none(&SEASPY, line, expected);
    }
    let five_digits = with(&seaspy::FORMAT, "seaspy_digits", Value::Small(5));
    assert_eq!(one(&five_digits, "*26.232/01:02:03.4 F:50123.000 S:1050 D:+008.0m\r\n").scalar_pt, 50_123_000);
}

#[test]
fn lines_that_are_no_data_are_no_rubbish() {
    let (readings, faults) = read(&GEN1, b"#Laser on\r\n*10\r\n!300467107\r\n");
    assert_eq!((readings.len(), faults), (1, ScalarFaults::default()));
    let stream = b"#Laser on\r\n)1\r\n(2\r\n+3\r\n=4\r\n!51312.571_s126\r\n";
    let (readings, faults) = read(&GEN2, stream);
    assert_eq!((readings.len(), faults), (1, ScalarFaults::default()));
}

#[test]
fn rubbish_is_counted_and_passed_over() {
    let cut = b"$ 49895.1$ 49895.131,1249\r\n";
    let stray_zeros = b"\0\0\0$ 49895.131,1249\r\n";
    let zero_inside = b"$ 498\095.131,1249\r\n$ 49895.131,1249\r\n";
    let overlong = [&b"$"[..], &[b'7'; 200], b"\r\n$ 49895.131,1249\r\n"].concat();
    let no_line_feed = b"$ 49895.131,1249\r";
    let no_return = b"$ 49895.131,1249\n";
    let expected = [
        (&cut[..], ScalarFaults { cut_lines: 1, ..Default::default() }),
        (stray_zeros, ScalarFaults { rubbish_bytes: 3, ..Default::default() }),
        (zero_inside, ScalarFaults { rubbish_bytes: 12, cut_lines: 1, ..Default::default() }),
        (&overlong, ScalarFaults { overlong: 1, rubbish_bytes: 200 - 97, ..Default::default() }),
        (no_line_feed, ScalarFaults::default()),
        (no_return, ScalarFaults::default()),
    ];
    for (stream, faults) in expected {
        let (readings, counted) = read(&ScalarSettings::G882, stream);
        assert_eq!((readings.len(), counted), (1, faults), "{}", stream.escape_ascii());
    }
}

#[test]
fn settings_are_checked() {
    for settings in [
        ScalarSettings { lowest_nt: 999.0, ..ScalarSettings::G882 },
        ScalarSettings { highest_nt: f64::NAN, ..ScalarSettings::G882 },
        ScalarSettings { highest_nt: 100_001.0, ..ScalarSettings::G882 },
        ScalarSettings { lowest_nt: 50_000.0, highest_nt: 40_000.0, ..ScalarSettings::G882 },
        ScalarSettings { weakest_signal: 9, strongest_signal: 8, ..ScalarSettings::G882 },
        with(&qtfm_gen1::FORMAT, "counts_per_nt", Value::Number(0.0)),
        with(&qtfm_gen1::FORMAT, "counts_per_nt", Value::Small(9)),
        with(&qtfm_gen2::FORMAT, "gen2_decimals", Value::Small(7)),
        with(&qtfm_gen2::FORMAT, "gen2_valid_mark", Value::Mark(b's')),
        with(&qtfm_gen2::FORMAT, "gen2_invalid_mark", Value::Mark(b'_')),
        with(&seaspy::FORMAT, "seaspy_digits", Value::Small(4)),
    ] {
        assert!(settings.build().is_err(), "{settings:?}");
    }
    // A narrower range turns a lost digit into an invalid reading.
    let narrow = ScalarSettings { lowest_nt: 30_000.0, highest_nt: 60_000.0, ..GEN1 };
    assert!(!read(&narrow, b"!30046707\r\n").0[0].valid);
}

#[test]
fn reader_pumps_counts_errors_and_gives_up_the_sentence() {
    let mut script = vec![];
    script.extend(b"$ 49895.131,1249\r".map(Transaction::read));
    script.push(Transaction::read(b'\n'));
    script.push(Transaction::read_error(nb::Error::WouldBlock));
    for kind in [ErrorKind::Overrun, ErrorKind::FrameFormat, ErrorKind::Noise, ErrorKind::Parity] {
        script.extend(b"$ 498".map(Transaction::read));
        script.push(Transaction::read_error(nb::Error::Other(kind)));
        script.extend(b"5.131,1249\r".map(Transaction::read));
    }
    script.extend(b"$ 49995.517,1245\r".map(Transaction::read));
    script.push(Transaction::read_error(nb::Error::WouldBlock));
    let mut reader = ScalarReader::new(Mock::new(&script), ScalarSettings::G882.build().unwrap());
    let first = reader.poll(7).unwrap();
    assert_eq!((first.scalar_pt, first.first_byte_us, first.last_byte_us), (49_895_131, 7, 7));
    assert_eq!(reader.poll(8), None);
    // A call takes 64 bytes at most.
    assert_eq!(reader.poll(9), None);
    let second = reader.poll(10).unwrap();
    assert_eq!((second.scalar_pt, second.last_byte_us), (49_995_517, 10));
    assert_eq!(reader.poll(11), None);
    let faults = reader.faults();
    assert_eq!((faults.overruns, faults.framing_errors, faults.other_receive_errors), (1, 1, 2));
    assert_eq!((faults.cut_lines, faults.rubbish_bytes), (4, 40));
    reader.release().0.done();
}

/// Rubbish with more than its share of the bytes that mean something.
fn rubbish() -> impl Strategy<Value = Vec<u8>> {
    let telling = proptest::sample::select(b"$!#*@^_=?>sXYZ.,0123456789 \r\n\0".to_vec());
    proptest::collection::vec(prop_oneof![telling, any::<u8>()], 0..300)
}

/// A sentence of a sensor in good order, in one of the forms that its format allows.
fn sentence(settings: &ScalarSettings, field_pt: i32, signal: u32, form: u8) -> String {
    let (nt, pt) = (field_pt / 1000, field_pt % 1000);
    let signal = 800 + signal % 9000;
    match settings.format.format().name {
        "g882" => {
            let ten = if nt >= 100_000 { '1' } else { ' ' };
            let more = ["", ",0112", ",0112,9900", ",D001H02M03S04_05"][usize::from(form % 4)];
            format!("${ten}{:05}.{pt:03},{signal:04}{more}\r\n", nt % 100_000)
        }
        "qtfm-gen1" => {
            let counts = (f64::from(field_pt) / 1000.0 * GEN1_COUNTS_PER_NT).round() as u32;
            let more = [String::new(), format!("@{signal}"), format!("@{signal}^{form}")];
            format!("!{counts}{}\r\n", more[usize::from(form % 3)])
        }
        "qtfm-gen2" => {
            let more = ["", "X17130.334=", "Y-0.1?@12", ">141949"][usize::from(form % 4)];
            format!("!{nt}.{pt:03}_{more}s{signal:03}v076\r\n")
        }
        _ => settings.format.build().unwrap().encode(field_pt).unwrap().to_string(),
    }
}

proptest! {
    /// Whatever comes: no panic, and the same readings however the calls are spread.
    #[test]
    fn any_bytes_do_no_harm(which in 0..FORMATS.len(), bytes in rubbish(), errors in proptest::collection::vec(any::<bool>(), 300)) {
        let mut parser = ScalarSettings::of(FORMATS[which]).build().unwrap();
        for (byte, error) in bytes.iter().zip(errors) {
            if let Some(reading) = parser.push(*byte, 0) {
                prop_assert!(!reading.valid || (1_000_000..=100_000_000).contains(&reading.scalar_pt));
            }
            if error && *byte > 250 {
                parser.receive_error(ErrorKind::Overrun);
            }
        }
    }

    /// After any rubbish every good sentence is read, from the first on, and unchanged.
    #[test]
    fn good_sentences_survive_rubbish(
        which in 0..FORMATS.len(),
        pieces in proptest::collection::vec((rubbish(), 1_000_000..=100_000_000_i32, any::<u16>(), any::<u8>()), 1..6),
    ) {
        let settings = &ScalarSettings::of(FORMATS[which]);
        let mut parser = settings.build().unwrap();
        for (rubbish, field_pt, signal, form) in pieces {
            for byte in rubbish {
                parser.push(byte, 1);
            }
            let line = sentence(settings, field_pt, signal.into(), form);
            let readings: Vec<_> = line.bytes().filter_map(|byte| parser.push(byte, 2)).collect();
            // The rubbish may end in a whole sentence that only lacks its end, but then the start byte cuts it.
            prop_assert_eq!(readings.len(), 1, "{}", line);
            prop_assert_eq!(readings[0].scalar_pt, field_pt, "{}", line);
            prop_assert!(readings[0].valid && readings[0].first_byte_us == 2);
        }
    }

    /// What a format encodes it decodes to within half of its resolution, whatever its parameters.
    #[test]
    fn every_format_decodes_what_it_encodes(field_pt in 1_000_000..=100_000_000_i32, small in 0..=6_u8, number in 1.0..=1e6) {
        for format in FORMATS {
            let mut settings = ScalarSettings::of(format);
            let defaults = settings.format;
            for parameter in format.parameters {
                match settings.format.value_mut(parameter.name).unwrap() {
                    Value::Number(value) => *value = number,
                    Value::Small(value) => *value = small,
                    Value::Mark(_) | Value::Switch(_) => {}
                }
            }
            // What a check refuses, and counts that do not fit into 32 bits, no sensor sends.
            let counts = settings.format.value("counts_per_nt") == Some(Value::Number(number));
            if settings.build().is_err() || counts && f64::from(field_pt) / 1e3 * number >= 4e9 {
                settings.format = defaults;
            }
            let sensor = settings.format.build().unwrap();
            let sentence = sensor.encode(field_pt).unwrap();
            let reading = one(&settings, &sentence);
            let off_pt = f64::from((reading.scalar_pt - field_pt).abs());
            let half_pt = sensor.scale.resolution_pt() / 2.0;
            // And to within half a picotesla, which the decoder rounds to.
            prop_assert!(off_pt <= half_pt || off_pt < half_pt + 0.5, "{}: {off_pt} pT, {sentence:?}", format.name);
        }
    }

    /// Losing any one byte of a G-882 line is noticed: its form has fixed widths.
    #[test]
    fn g882_notices_a_lost_byte(field_pt in 1_000_000..=99_999_999_i32, signal in any::<u16>(), form in any::<u8>(), lost in 0..16_usize) {
        let mut line = sentence(&ScalarSettings::G882, field_pt, signal.into(), form).into_bytes();
        line.remove(lost);
        let (readings, faults) = read(&ScalarSettings::G882, &line);
        prop_assert!(readings.is_empty());
        prop_assert!(faults != ScalarFaults::default());
    }
}
