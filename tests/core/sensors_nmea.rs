//! NMEA 0183 in: the sentences of the makers' manuals, damaged ones, and any bytes.

use embedded_hal_nb::serial::ErrorKind;
use proptest::prelude::*;
use towmag::navigation::{Heading, Navigation, Position};
use towmag::sensors::nmea::{DepthIs, LONGEST_NMEA, NmeaFaults, NmeaSettings};

fn read(settings: &NmeaSettings, bytes: &[u8]) -> (Vec<Navigation>, NmeaFaults) {
    let mut parser = settings.build().unwrap();
    let reports = (0..).zip(bytes).filter_map(|(now_us, &byte)| parser.push(byte, now_us));
    (reports.map(|report| report.navigation).collect(), *parser.faults())
}

/// What one sentence tells, which has no fault.
fn told(settings: &NmeaSettings, sentence: &str) -> Navigation {
    let (told, faults) = read(settings, format!("{sentence}\r\n").as_bytes());
    assert_eq!(faults, NmeaFaults::default(), "{sentence}");
    told.into_iter().next().unwrap_or_default()
}

/// The sentence around its content.
fn sealed(content: &str) -> String {
    format!("${content}*{:02X}", content.bytes().fold(0, |sum, byte| sum ^ byte))
}

fn depth(depth_m: f32) -> Navigation {
    Navigation { depth_m: Some(depth_m), ..Navigation::default() }
}

fn altitude(altitude_m: f32) -> Navigation {
    Navigation { altitude_m: Some(altitude_m), ..Navigation::default() }
}

#[test]
fn metres_below_the_transducer_are_what_the_setting_says() {
    let sounder = NmeaSettings::default();
    let pressure = NmeaSettings { depth_is: DepthIs::Depth, ..sounder };
    for (sentence, below_m) in [
        ("$SDDPT,2.4,,*53", 2.4),
        // NOAA's description of its ships' files, scs_dpt.
        ("$SDDPT,0006.29,002.40*6C", 6.29),
        ("$SDDBT,7.8,f,2.4,M,1.3,F*0D", 2.4),
        // Valeport VA500, manual 0430831e, p. 4.
        ("$SDDBT,0.4,f,0.1,M,0.1,F*02", 0.1),
    ] {
        assert_eq!(told(&sounder, sentence), altitude(below_m), "{sentence}");
        assert_eq!(told(&pressure, sentence), depth(below_m), "{sentence}");
    }
    assert_eq!(told(&sounder, &sealed("SDDBT,,f,,M,,F")), Navigation::default(), "no bottom in reach");
}

#[test]
fn sentences_of_towed_bodies() {
    // In air: the sensor shows the pressure of the atmosphere.
    let in_air = NmeaSettings { surface_dbar: 10.073, ..NmeaSettings::default() };
    let valeport = told(&in_air, "$PRVAT,00.115,M,0010.073,dBar*39");
    assert_eq!(valeport, Navigation { depth_m: Some(0.0), ..altitude(0.115) });
    let deep = told(&NmeaSettings::default(), &sealed("PRVAT, 12.500,M, 0100.000, dBar"));
    assert_eq!(deep, Navigation { depth_m: Some(99.484), ..altitude(12.5) });
    assert_eq!(told(&in_air, &sealed("PRVAT,12.500,M")), altitude(12.5));
    // miniIPS2, p. 20 and 21: without its unit the value may be a pressure.
    let default = NmeaSettings::default();
    assert_eq!(told(&default, "$PIPS,0001.00,M*78"), depth(1.0));
    assert_eq!(told(&default, &sealed("PIPS,0100.00,dBar")), depth(99.484));
    assert_eq!(told(&default, "$PIPS,0001.00*19"), Navigation::default());
    assert_eq!(told(&default, "$PVIPS2,01,45687,10.996,d,10.988,M*61"), depth(10.988));
    assert_eq!(told(&default, "$PVIPS2,01,45687,10.996,d,10.988,*2c"), Navigation::default());
}

#[test]
fn positions() {
    let at = |content: &str| told(&NmeaSettings::default(), &sealed(content)).position;
    let position = |latitude_e7, longitude_e7, fix| Some(Position { latitude_e7, longitude_e7, fix });
    let known = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47";
    assert_eq!(told(&NmeaSettings::default(), known).position, position(481_173_000, 115_166_667, 1));
    let south = "GNGGA,092750.000,3321.6802,S,15130.3372,W,4,8,1.03,61.7,M,55.2,M,,";
    assert_eq!(at(south), position(-333_613_367, -1_515_056_200, 4));
    assert_eq!(at("GPGGA,,,,,,0,00,,,,,,,"), None);
    assert_eq!(at("GPGGA,123519,4807.038,N,01131.000,E,0,08,0.9,545.4,M,46.9,M,,"), None, "no fix");
    assert_eq!(at("GPGGA,1,9000,N,18000,E,1"), position(900_000_000, 1_800_000_000, 1));
}

#[test]
fn headings() {
    let at = |content: &str| told(&NmeaSettings::default(), &sealed(content)).heading;
    let heading = |deg, is_magnetic| Some(Heading { deg, is_magnetic });
    assert_eq!(at("HEHDT,275.4,T"), heading(275.4, false));
    assert_eq!(at("HCHDM,238.5,M"), heading(238.5, true));
    assert_eq!(at("HCHDG,101.1,,,7.1,W"), heading(94.0, false));
    assert_eq!(at("HCHDG,355.0,2.0,E,7.0,E"), heading(4.0, false));
    assert_eq!(at("HCHDG,1.0,2.0,W,,"), heading(359.0, true));
    assert_eq!(at("HCHDG,,,,,"), None);
    assert_eq!(at("GPVTG,054.7,T,034.4,M,005.5,N,010.2,K"), None);
}

#[test]
fn what_is_not_right_is_refused_and_counted() {
    let default = NmeaSettings::default();
    for sentence in ["$SDDPT,2.4,,*54", "$SDDPT,2.4,,", "$SDDPT,3.4,,*53", "$SDDPT,2.4,,*5", "$", "$*0g"] {
        let (told, faults) = read(&default, format!("{sentence}\r\n").as_bytes());
        assert_eq!((told.len(), faults.bad_checksum, faults.malformed), (0, 1, 0), "{sentence}");
    }
    for content in [
        "SDDPT,2.4.1",
        "SDDPT,1e3",
        "SDDPT,-",
        "SDDPT,99999",
        "SDDPT,nan",
        "HEHDT,361,T",
        "HEHDT,275.4,M",
        "HCHDG,1.0,2.0,X,,",
        "PRVAT,12.5,F",
        "PRVAT,12.5,M,10.1,bar",
        "GPGGA,1,4860.0,N,01131.0,E,1",
        "GPGGA,1,9000.1,N,01131.0,E,1",
        "GPGGA,1,4807.0,E,01131.0,E,1",
        "GPGGA,1,4807.0,N,01131.0,E,",
        "GPGGA,1,4807.0,N,01131.0,E,9",
    ] {
        let (told, faults) = read(&default, format!("{}\n", sealed(content)).as_bytes());
        assert_eq!((told.len(), faults.bad_checksum, faults.malformed), (0, 0, 1), "{content}");
    }
    let cut = format!("ab$SDDPT,2.4$SD\u{1}\r\n!AIVDM,1,1,,A*00\r\n${}\r\n", "x".repeat(LONGEST_NMEA + 1));
    let (_, faults) = read(&default, cut.as_bytes());
    assert_eq!((faults.malformed, faults.rubbish_bytes, faults.bad_checksum), (3, 2, 0));
}

#[test]
fn an_error_of_the_receiver_costs_its_sentence() {
    let mut parser = NmeaSettings::default().build().unwrap();
    let mut depths = 0;
    for (at, byte) in b"$SDDPT,2.4,,*53\r\n$SDDPT,2.4,,*53\r\n".iter().enumerate() {
        if at == 8 {
            parser.receive_error(ErrorKind::Overrun);
        }
        depths += u32::from(parser.push(*byte, 0).is_some());
    }
    assert_eq!((depths, parser.faults().receive_errors, parser.faults().malformed), (1, 1, 1));
}

#[test]
fn the_stamp_is_that_of_the_first_byte() {
    let mut parser = NmeaSettings::default().build().unwrap();
    let sentence = b"\r\n$SDDPT,2.4,,*53\r\n";
    let stamps = (100..).zip(sentence).filter_map(|(now_us, &byte)| parser.push(byte, now_us));
    assert_eq!(stamps.map(|report| report.stamp_us).collect::<Vec<_>>(), [102]);
}

#[test]
fn settings_have_their_ranges() {
    let default = NmeaSettings::default();
    for wrong in [
        NmeaSettings { baud: 4_799, ..default },
        NmeaSettings { baud: 115_201, ..default },
        NmeaSettings { surface_dbar: -0.1, ..default },
        NmeaSettings { surface_dbar: f64::NAN, ..default },
    ] {
        assert!(wrong.build().is_err(), "{wrong:?}");
    }
}

/// Bytes that come near to sentences.
fn near_sentences() -> impl Strategy<Value = Vec<u8>> {
    let address = prop::sample::select(vec!["DPT", "DBT", "GGA", "HDT", "HDG", "HDM", "RVAT", "IPS", "VIPS2", "ZZZ"]);
    let content = (prop::sample::select(vec!["SD", "P", "GN"]), address, "[-+0-9.,NSEWMTd ]{0,70}");
    let sentence =
        content.prop_map(|(talker, address, fields)| format!("{}\r\n", sealed(&format!("{talker}{address},{fields}"))));
    let piece = prop_oneof![
        3 => sentence.prop_map(String::into_bytes),
        1 => prop::collection::vec(any::<u8>(), 0..40),
    ];
    prop::collection::vec(piece, 0..8).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic_or_deaf_and_no_value_is_beyond_its_range(bytes in near_sentences()) {
        let (told, _) = read(&NmeaSettings::default(), &bytes);
        for Navigation { depth_m, altitude_m, position, heading } in told {
            prop_assert!(depth_m.into_iter().chain(altitude_m).all(|metres| (-200.0..=12_000.0).contains(&metres)));
            prop_assert!(position.is_none_or(|position| position.latitude_e7.abs() <= 900_000_000
                && position.longitude_e7.abs() <= 1_800_000_000 && (1..=8).contains(&position.fix)));
            prop_assert!(heading.is_none_or(|heading| (0.0..=360.0).contains(&heading.deg)));
        }
        let after = [&bytes[..], b"\r\n$SDDPT,2.4,,*53\r\n"].concat();
        let (told, _) = read(&NmeaSettings::default(), &after);
        prop_assert_eq!(told.last(), Some(&altitude(2.4)));
    }

    #[test]
    fn a_flipped_bit_is_never_another_depth(place in 1..16_usize, bit in 0..8_u8) {
        let mut sentence = format!("{}\r\n", sealed("SDDPT,12.4,,")).into_bytes();
        prop_assert_eq!(read(&NmeaSettings::default(), &sentence).0, [altitude(12.4)]);
        sentence[place] ^= 1 << bit;
        prop_assert!(read(&NmeaSettings::default(), &sentence).0.is_empty());
    }

    #[test]
    fn positions_come_back(latitude_e7 in -900_000_000..=900_000_000_i32, longitude_e7 in -1_800_000_000..=1_800_000_000_i32) {
        // Five decimals of a minute are 1.7e-7 degrees.
        let angle = |angle_e7: i32, width: usize| {
            let minutes_e5 = (f64::from(angle_e7.abs()) * 60.0 / 100.0).round() as u64;
            let (deg, minutes) = (minutes_e5 / 6_000_000, (minutes_e5 % 6_000_000) as f64 / 1e5);
            format!("{deg:0width$}{minutes:08.5}")
        };
        let (ns, ew) = (if latitude_e7 < 0 { 'S' } else { 'N' }, if longitude_e7 < 0 { 'W' } else { 'E' });
        let content = format!("GPGGA,1,{},{ns},{},{ew},1", angle(latitude_e7, 2), angle(longitude_e7, 3));
        let position = told(&NmeaSettings::default(), &sealed(&content)).position.unwrap();
        prop_assert!(position.latitude_e7.abs_diff(latitude_e7) <= 1 && position.longitude_e7.abs_diff(longitude_e7) <= 1);
    }
}
