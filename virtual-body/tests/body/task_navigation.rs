//! Depth, altitude, position and heading: from the third UART and the scalar sensor's channels to log and cable.

use towmag::health::Count;
use towmag::link::FAULT_NAMES;
use towmag::log::{Event, EventKind, Record};
use towmag::navigation::{Navigation, Position};
use towmag::sensors::nmea::DepthIs;
use towmag::store::Stored;
use towmag_virtual_body::board::Bench;
use towmag_virtual_body::body::{Body, store};
use towmag_virtual_body::fat::fat16;
use towmag_virtual_body::sentence::sealed;

fn body(change: impl FnOnce(&mut Stored)) -> Body {
    let bench = Bench::new();
    bench.card.replace(Some(fat16(8000)));
    store(&bench, change);
    Body::start(&bench)
}

/// Everything in the log by its order: epochs, and what was told of where the body is, with their ticks.
fn logged(body: &mut Body) -> Vec<(u32, Option<Navigation>)> {
    let told = |record| match record {
        Record::Epoch(record) => Some((record.epoch.tick, None)),
        Record::Event(Event { tick, kind: EventKind::Navigation(navigation) }) => Some((tick, Some(navigation))),
        _ => None,
    };
    body.logged().into_iter().filter_map(told).collect()
}

fn fault(body: &Body, name: &str) -> u32 {
    body.health.counts.faults().0[FAULT_NAMES.iter().position(|found| *found == name).unwrap()]
}

#[test]
fn sentences_end_up_in_log_and_cable_until_they_are_too_old() {
    let mut body = body(|stored| stored.settings.nmea.depth_is = DepthIs::Depth);
    body.live(3);
    assert!(body.received().navigation.is_empty(), "nothing is known");
    for second in 0..10_u16 {
        body.hear(&sealed(&format!("SDDPT,{}.5,0.0", 20 + second)));
        body.hear(&sealed("GPGGA,1,4807.038,N,01131.000,E,2"));
        body.live(1);
    }
    let told = body.received().navigation;
    assert!((19..=21).contains(&told.len()), "twice a second: {}", told.len());
    let position = Some(Position { latitude_e7: 481_173_000, longitude_e7: 115_166_667, fix: 2 });
    assert!(told.iter().all(|message| message.navigation.position == position));
    assert_eq!(told.last().unwrap().navigation.depth_m, Some(29.5));
    // Silence: known for three seconds more, then once that nothing is.
    body.live(10);
    let told = body.received().navigation;
    let (last, known) = told.split_last().unwrap();
    assert!(last.navigation.is_empty() && known.iter().all(|message| message.navigation.depth_m == Some(29.5)));
    assert!((4..=7).contains(&known.len()), "{}", known.len());

    let logged = logged(&mut body);
    let news: Vec<_> = logged.iter().filter_map(|(tick, told)| told.map(|told| (*tick, told))).collect();
    assert_eq!(news.len(), 10, "what is new, once");
    for (second, (tick, told)) in news.iter().enumerate() {
        let expected = Navigation { depth_m: Some(20.5 + second as f32), position, ..Navigation::default() };
        assert_eq!(*told, expected);
        let place = logged.iter().position(|entry| *entry == (*tick, Some(*told))).unwrap();
        assert_eq!(logged[place + 1], (*tick, None), "before its epoch");
    }
}

#[test]
fn garbage_does_no_harm_and_is_counted() {
    let mut body = body(|_| ());
    for step in 0..50_u8 {
        let noise: Vec<u8> = (0..60).map(|k: u8| k.wrapping_mul(37).wrapping_add(step.wrapping_mul(91))).collect();
        body.hear(&noise);
        body.bench.nmea_bytes.borrow_mut().push_back(None);
        body.hear(b"$SDDPT,2.4,,*54\r\n");
        body.live(1);
    }
    body.hear(b"\r\n$SDDPT,2.4,,*53\r\n");
    body.live(1);
    let received = body.received();
    assert_eq!((received.navigation.last().unwrap().navigation.altitude_m, received.bad), (Some(2.4), 0));
    assert!(fault(&body, "nmea bad checksum") >= 50 && fault(&body, "nmea receive errors") == 50);
    assert!(fault(&body, "nmea rubbish bytes") > 50);
    assert_eq!(body.health.counts.get(Count::ReadingsLost) + body.health.counts.get(Count::RecordsLost), 0);
    let epochs = body.health.tasks.epochs();
    let logged = logged(&mut body);
    assert!(logged.iter().filter(|(_, told)| told.is_none()).count() as u32 + 2 >= epochs);
    assert_eq!(logged.iter().filter_map(|(_, told)| *told).count(), 1);
}

#[test]
fn a_flood_costs_sentences_and_nothing_else() {
    let mut body = body(|_| ());
    body.live(1);
    for _ in 0..20 {
        body.hear(&b"$SDDPT,2.4,,*53\r\n".repeat(200));
        body.live(1);
    }
    assert!(body.health.counts.get(Count::ReadingsLost) > 0);
    assert_eq!(body.health.counts.get(Count::RecordsLost), 0);
    assert_eq!(body.received().navigation.last().unwrap().navigation.altitude_m, Some(2.4));
}

#[test]
fn the_channels_of_the_scalar_sensor_count_where_they_are_set() {
    let mut silent = body(|_| ());
    silent.scalar_sentence = "$ 49800.131,1249,0612,9900\r\n";
    silent.live(5);
    assert!(silent.received().navigation.is_empty(), "no sensor is fitted");
    let mut body = body(|stored| {
        stored.settings.channels.depth_m_per_count = 0.05;
        stored.settings.channels.depth_bias_m = -112.0 * 0.05;
    });
    body.scalar_sentence = silent.scalar_sentence;
    body.live(5);
    body.hear(&sealed("SDDPT,7.5,0.0"));
    body.live(5);
    let told = body.received().navigation;
    assert!(told.iter().all(|message| message.navigation.depth_m == Some(25.0)));
    assert!(told.iter().any(|message| message.navigation.altitude_m == Some(7.5)), "from the other sensor");
    let logged = logged(&mut body);
    let depths = logged.iter().filter(|(_, told)| told.is_some_and(|told| told.depth_m == Some(25.0))).count();
    assert!((90..=110).contains(&depths), "with every epoch: {depths}");
}

#[test]
fn the_slowest_cable_carries_it_with_everything_else() {
    let mut body = body(|stored| {
        stored.settings.cable_baud = 9_600;
        stored.settings.housekeeping.battery_v_per_count = 0.01;
        stored.settings.housekeeping.is_leak_fitted = true;
    });
    body.live(3);
    body.received();
    let all = [
        sealed("SDDPT,7.5,0.0"),
        sealed("PIPS,0020.00,M"),
        sealed("GPGGA,1,4807.038,N,01131.000,E,2"),
        sealed("HEHDT,275.4,T"),
    ];
    for _ in 0..20 {
        body.hear(&all.concat());
        body.live(1);
    }
    let bytes = body.bench.to_ship.borrow().len();
    assert!(bytes < 20 * 960, "{bytes} bytes in 20 s, 19,200 are carried");
    assert_eq!(body.health.counts.get(Count::FramesDropped), 0);
}
