//! A tow that was never sailed.

use std::time::{SystemTime, UNIX_EPOCH};

use towmag_live::{Contact, Lamp, Lamps, Level, LiveOptions, Sample, Server, Update};

/// Seconds since 1970.
pub(crate) fn now_s() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64()
}

/// A server on any free port of this machine.
pub(crate) fn server(change: impl FnOnce(&mut LiveOptions)) -> Server {
    let mut options = LiveOptions::new("127.0.0.1:0".parse().unwrap(), "demo");
    change(&mut options);
    Server::start(options).unwrap()
}

/// The page's address as `host:port`.
pub(crate) fn host(server: &Server) -> String {
    server.address().unwrap().to_string()
}

/// An epoch at a time after the start: legs of four minutes with turns, swell, noise, and a target every two minutes.
pub(crate) fn sample(start_s: f64, tick: u32) -> Sample {
    let since_s = 0.1 * f64::from(tick);
    let turn = (since_s / 240.0).floor();
    let into_turn = ((since_s - 240.0 * turn) / 25.0).min(1.0);
    let heading = std::f64::consts::PI * (turn + into_turn);
    let swell = (since_s * 0.9).sin();
    let noise = (f64::from(tick.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5) * 0.06;
    let off_s = since_s % 120.0 - 60.0;
    let target_nt =
        9.0 / (1.0 + (off_s / 1.5).powi(2)).powf(1.5) - 5.0 / (1.0 + ((off_s - 2.0) / 1.6).powi(2)).powf(1.5);
    let deviation_nt = 55.0 * heading.cos() + 6.0 * swell;
    let compensated_nt = 49_870.0 + 4.0 * (since_s / 400.0).sin() + target_nt + noise;
    let along_m = 2.0 * (since_s - 240.0 * turn) - 240.0;
    let north_m = if turn as i64 % 2 == 0 { along_m } else { -along_m };
    Sample {
        time_s: start_s + since_s,
        sent_s: Some(start_s + since_s),
        heard_s: None,
        raw_nt: Some(compensated_nt + deviation_nt),
        compensated_nt: Some(compensated_nt),
        residual_nt: Some(noise + 0.2 * target_nt * (off_s / 3.0).sin()),
        depth_m: Some(12.0 + 0.4 * swell),
        altitude_m: Some(4.2 - 0.4 * swell + (since_s / 90.0).sin()),
        position_deg: Some([54.3 + north_m / 111_195.0, 10.2 + (30.0 * (turn + into_turn)) / 65_000.0]),
        has_leak: Some(false),
        battery_v: Some(15.8),
    }
}

/// All is well.
pub(crate) fn lamps() -> Lamps {
    let good = |word: &str| Lamp::new(Level::Good, word);
    Lamps {
        sensor: good("signal 1,180"),
        adaptation: good("adapting"),
        log: good("logging"),
        card: good("takes all"),
        cable: good("10/s, 0 lost"),
        time: good("set, ±12 ms"),
        ship: good("recorded"),
    }
}

/// A target that was found.
pub(crate) fn contact(number: u32, time_s: f64) -> Update {
    let position_deg = Some([54.3, 10.2]);
    Update::Contact(Contact { number, time_s, peak_nt: 8.7, width_s: 2.3, snr: 31.0, position_deg })
}
