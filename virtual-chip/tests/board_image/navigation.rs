//! The third UART, and the pulse per second.

use crate::Scenario;
use crate::bench::{Body, SMALL_FILES, sensors};
use towmag::link::TimerTold;
use towmag_virtual_body::sentence::sealed;
use towmag_virtual_chip::time::{fs, seconds};
use towmag_virtual_chip::wires::pulses::Pulses;

pub(crate) static SENTENCES: Scenario = Scenario::new(sentences);
pub(crate) static PULSE: Scenario = Scenario::new(pulse);
pub(crate) static OVERRUN: Scenario = Scenario::new(wrong_rate);

/// USART3 among the lines.
const NMEA: usize = 2;

#[test]
fn sentences_reach_the_ship() {
    Scenario::force(&SENTENCES);
}

#[test]
fn a_pulse_per_second_makes_the_time_exact() {
    Scenario::force(&PULSE);
}

#[test]
fn a_wrong_rate_is_counted() {
    Scenario::force(&OVERRUN);
}

fn sentences() {
    let mut board = sensors();
    board.lines[NMEA].talk(fs(0.3), fs(1.0), |count| {
        let sentences = [format!("SDDPT,{}.5,0.0", 20 + count), "GPGGA,1,4807.038,N,01131.000,E,2".to_string()];
        sentences.iter().flat_map(|sentence| sealed(sentence)).collect()
    });
    let mut body = Body::start(board, SMALL_FILES.clone());
    body.live(10.0);
    let told = body.received().navigation;
    assert!((16..=20).contains(&told.len()), "twice a second: {}", told.len());
    let last = told.last().unwrap().navigation;
    assert_eq!((last.altitude_m, last.position.unwrap().latitude_e7), (Some(29.5), 481_173_000));
}

/// The pulses are at whole seconds of virtual time; the ship sets the time 30 ms off, and knows that it may be 40.
fn pulse() {
    const ASK: &str = "time ask\r";
    let mut body = Body::start(sensors(), SMALL_FILES.clone());
    body.chip.bus_mut().pulses = Pulses::new(fs(1.0), fs(1.0));
    body.live(5.2);
    body.received();
    let came_s = seconds(body.chip.machine().now_fs) + ASK.len() as f64 * 10.0 / 115_200.0;
    body.send(ASK);
    body.live(0.5);
    let told = TimerTold::parse(&body.received().texts[0]).expect("an answer");
    let unix_s = 1_780_000_000.03 + came_s;
    assert_eq!(body.answer(&format!("time set {unix_s:.6}@{}+-40000", told.came_us)), ["time set"]);
    body.live(5.0);
    let telemetry = body.received().telemetry;
    assert_eq!(telemetry.last().unwrap().time_error_ms, Some(1));
}

/// 9,600 baud where 4,800 are expected.
fn wrong_rate() {
    let mut board = sensors();
    board.lines[NMEA].baud = 9_600.0;
    board.lines[NMEA].talk(fs(0.3), fs(1.0), |_| sealed("SDDPT,20.5,0.0"));
    let mut body = Body::start(board, SMALL_FILES.clone());
    body.live(5.0);
    assert!(body.received().navigation.is_empty());
    let status = body.answer("status");
    assert!(status.iter().any(|line| line.starts_with("fault: nmea receive errors")), "{status:?}");
}
