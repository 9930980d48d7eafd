//! Connections: each has a place, and a time within which it must have asked.

use std::convert::Infallible;
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::Request;
use axum::response::Response;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use socket2::SockRef;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{sleep, timeout};

use crate::places::{Place, Places};

/// Longest head of a request, bytes: hyper takes no less. Browsers send less than one thousand.
const LONGEST_HEAD: usize = 8 * 1024;

/// What the system keeps for a viewer that does not follow, bytes. It would let this grow to megabytes, most of an hour of
/// epochs, and the page of a slow link would be that late without knowing.
const ON_THE_WAY: usize = 64 * 1024;

/// After an error of accepting, such as too many open files, the next try waits.
const REST: Duration = Duration::from_millis(100);

/// So many times the time of a request is what an answer may take, too.
const ANSWER: u32 = 6;

/// Whose connection a request came by. A viewer that stays holds it.
#[derive(Clone, Debug)]
pub(crate) struct Caller {
    pub(crate) address: IpAddr,
    place: Arc<Place>,
}

impl Caller {
    /// Keep the connection's place as long as this lives.
    pub(crate) fn into_place(self) -> Arc<Place> {
        self.place
    }
}

/// Accept connections for ever; those that have no place are closed at once.
pub(crate) async fn accept(listener: TcpListener, router: Router, places: Arc<Places>) {
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                if let Some(caller) = caller(&places, peer) {
                    tokio::spawn(answer(stream, router.clone(), caller, places.limits().request));
                }
            }
            Err(_) => sleep(REST).await,
        }
    }
}

fn caller(places: &Arc<Places>, peer: SocketAddr) -> Option<Caller> {
    Some(Caller { address: peer.ip(), place: Arc::new(places.take(peer.ip())?) })
}

/// Answer the requests of a connection.
async fn answer(stream: TcpStream, router: Router, caller: Caller, request: Duration) {
    // An epoch waits for no other, and the system for no old ones: where it cannot, that is no reason not to serve.
    _ = stream.set_nodelay(true);
    _ = SockRef::from(&stream).set_send_buffer_size(ON_THE_WAY);
    let service = service_fn(move |mut request: Request<Incoming>| {
        request.extensions_mut().insert(caller.clone());
        call(router.clone(), request)
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(request)
        .max_buf_size(LONGEST_HEAD)
        .serve_connection(TokioIo::new(stream), service)
        .with_upgrades();
    // One that has become a viewer has left this by then.
    _ = timeout(ANSWER * request, connection).await;
}

async fn call(router: Router, request: Request<Incoming>) -> Result<Response, Infallible> {
    use hyper::service::Service;
    TowerToHyperService::new(router).call(request.map(Body::new)).await
}
