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
}
