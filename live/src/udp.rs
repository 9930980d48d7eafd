//! Each epoch as a datagram of JSON: what PlotJuggler's UDP server and anybody's ten lines of Python read.

use std::io;
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs, UdpSocket};

use serde_json::{Map, Value, json};

use crate::error::LiveError;
use crate::sample::{SERIES_NAMES, Sample};

/// Where datagrams go to.
pub(crate) struct Udp(UdpSocket);

impl Udp {
    /// Send to `target`, `host:port`.
    pub(crate) fn open(target: &str) -> Result<Self, LiveError> {
        Self::connect(target).map_err(|source| LiveError::Udp { target: target.into(), source })
    }

    fn connect(target: &str) -> io::Result<Self> {
        let nowhere = || io::Error::new(io::ErrorKind::NotFound, "no such host");
        let address = target.to_socket_addrs()?.next().ok_or_else(nowhere)?;
        let any: SocketAddr =
            if address.is_ipv4() { (Ipv4Addr::UNSPECIFIED, 0).into() } else { (Ipv6Addr::UNSPECIFIED, 0).into() };
        let socket = UdpSocket::bind(any)?;
        socket.connect(address)?;
        // A full queue loses a datagram, as UDP does anyway.
        socket.set_nonblocking(true)?;
        Ok(Self(socket))
    }

    /// Send an epoch; nobody may listen.
    pub(crate) fn send(&self, sample: &Sample) {
        _ = self.0.send(datagram(sample).to_string().as_bytes());
    }
}

/// `timestamp` is the sender's where it knows the time, so that whatever delays the way here does not bend the curves.
fn datagram(sample: &Sample) -> Value {
    let mut fields = Map::new();
    fields.insert("timestamp".into(), json!(sample.sent_s.unwrap_or(sample.time_s)));
    let series = SERIES_NAMES.into_iter().zip(sample.series());
    fields.extend(series.filter_map(|(name, value)| Some((name.to_string(), json!(value?)))));
    if let Some([latitude_deg, longitude_deg]) = sample.place_deg() {
        fields.insert("latitude_deg".into(), json!(latitude_deg));
        fields.insert("longitude_deg".into(), json!(longitude_deg));
    }
    if let Some(battery_v) = sample.battery_v.filter(|volts| volts.is_finite()) {
        fields.insert("battery_v".into(), json!(battery_v));
    }
    Value::Object(fields)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_datagram_has_the_senders_stamp_and_what_is_known() {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let udp = Udp::open(&socket.local_addr().unwrap().to_string()).unwrap();
        let sample = Sample {
            time_s: 7.0,
            sent_s: Some(1.5e9),
            raw_nt: Some(50_000.5),
            depth_m: Some(f64::NAN),
            ..Sample::default()
        };
        udp.send(&sample);
        let mut bytes = [0; 1500];
        let count = socket.recv(&mut bytes).unwrap();
        let json: Value = serde_json::from_slice(&bytes[..count]).unwrap();
        assert_eq!(json, json!({"timestamp": 1.5e9, "raw_nt": 50_000.5}));
        assert_eq!(datagram(&Sample { sent_s: None, ..sample })["timestamp"], 7.0);
        assert!(Udp::open("no port").is_err());
    }

    /// What the JSON parser of PlotJuggler 4 wants (its official plugins, `parser_json` 1.2): one object, its stamp a number of
    /// seconds at the top. A column keeps the type of its first value, so 15 V must not be a whole number once; a message that
    /// cannot be read ends the stream; a datagram that a network cuts in two may come as none.
    #[test]
    fn plotjuggler_reads_every_datagram() {
        let whole = Sample {
            time_s: 1.7e9,
            sent_s: Some(1.7e9),
            heard_s: Some(1.7e9),
            raw_nt: Some(50_000.0),
            compensated_nt: Some(49_000.0),
            residual_nt: Some(-0.0),
            depth_m: Some(1e-30),
            altitude_m: Some(3.0),
            position_deg: Some([-54.0, 180.0]),
            has_leak: Some(true),
            battery_v: Some(15.0),
        };
        let unknown = Sample { raw_nt: Some(f64::INFINITY), battery_v: Some(f64::NAN), ..Sample::default() };
        for (sample, fields) in [(whole, 10), (unknown, 1)] {
            let text = datagram(&sample).to_string();
            let read: Map<String, Value> = serde_json::from_str(&text).unwrap();
            assert!(read.values().all(Value::is_f64) && read["timestamp"].is_f64(), "{text}");
            assert_eq!((read.len(), text.len() < 500), (fields, true), "{text}");
        }
    }
}
