//! Viewers that are no browsers.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::Value;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// A viewer of the WebSocket.
pub(crate) struct Viewer(pub(crate) WebSocket<TcpStream>);

impl Viewer {
    /// Connect to `host:port`, with more headers.
    pub(crate) fn connect(
        host: &str,
        path: &str,
        headers: &[(&'static str, &str)],
    ) -> Result<Self, tungstenite::Error> {
        let stream = TcpStream::connect(host)?;
        stream.set_read_timeout(Some(Duration::from_secs(10)))?;
        let mut request = format!("ws://{host}{path}").into_client_request()?;
        for (name, value) in headers {
            request.headers_mut().insert(*name, value.parse().unwrap());
        }
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(Self(socket)),
            Err(tungstenite::HandshakeError::Failure(error)) => Err(error),
            Err(tungstenite::HandshakeError::Interrupted(_)) => {
                Err(std::io::Error::from(std::io::ErrorKind::TimedOut).into())
            }
        }
    }

    /// Connect and be greeted.
    pub(crate) fn greeted(host: &str) -> (Self, Value) {
        let mut viewer = Self::connect(host, "/live", &[]).unwrap();
        let hello = viewer.next("hello");
        (viewer, hello)
    }

    pub(crate) fn send(&mut self, json: &str) {
        self.0.send(Message::text(json)).unwrap();
    }

    /// The next message of a kind; others are passed over.
    pub(crate) fn next(&mut self, kind: &str) -> Value {
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_secs(10) {
            if let Message::Text(text) = self.0.read().unwrap() {
                let value: Value = serde_json::from_str(&text).unwrap();
                if value["kind"] == kind {
                    return value;
                }
            }
        }
        panic!("no {kind} came");
    }
}

/// The whole answer to some bytes, as far as it comes within a while; empty when the connection was closed.
pub(crate) fn answer(host: &str, request: &[u8]) -> String {
    let mut stream = TcpStream::connect(host).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
    // The server may have closed it by then.
    _ = stream.write_all(request);
    let mut bytes = Vec::new();
    _ = stream.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A request for a path, that ends the connection.
pub(crate) fn get(host: &str, path: &str) -> String {
    answer(host, format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").as_bytes())
}
