//! The server: a thread of its own with all sockets in it.

use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener as StdListener, UdpSocket};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;

use crate::connection::accept;
use crate::error::LiveError;
use crate::feed::{Feed, Inflow};
use crate::guard::Guard;
use crate::hub::Hub;
use crate::notice::Order;
use crate::options::LiveOptions;
use crate::page::Page;
use crate::places::Places;
use crate::routes::{Served, router};
use crate::state::State;
use crate::udp::Udp;

/// Orders that may wait for whoever listens to the body.
const ORDERS: usize = 64;

/// What is still on its way to viewers when the server ends has so long.
const LAST_WORDS: Duration = Duration::from_millis(200);

/// A running server; it ends when this is dropped.
#[derive(Debug)]
pub struct Server {
    feed: Feed,
    orders: Option<Receiver<Order>>,
    address: Option<SocketAddr>,
    token: String,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Begin to serve.
    ///
    /// # Errors
    ///
    /// When the address is taken or not this machine's, or the system lacks something.
    pub fn start(options: LiveOptions) -> Result<Self, LiveError> {
        let listener = options.address.map(listen).transpose()?;
        let address = listener.as_ref().map(StdListener::local_addr).transpose()?;
        let udp = options.udp.as_deref().map(Udp::open).transpose()?;
        let runtime = Builder::new_current_thread().enable_all().build()?;
        let (token, nonce, session) = (random_name()?, random_name()?, random_name()?);
        let guard = Guard { token: token.clone(), allow_commands: options.allow_commands };
        let limits = options.limits;
        let (feed, inflow) = Feed::new();
        let (sender, orders) = sync_channel(ORDERS);
        let hub = Arc::new(Hub::new(State::new(options, session), sender));
        let served = Served { hub: Arc::clone(&hub), guard, page: Page::new(&nonce), patience: limits.patience };
        let (stop, stopped) = oneshot::channel();
        let thread = std::thread::Builder::new().name("live page".into()).spawn(move || {
            let accepting = listener.map(|listener| (listener, served, Places::new(limits)));
            serve(&runtime, hub, inflow, udp, accepting, stopped);
            runtime.shutdown_background();
        })?;
        Ok(Self { feed, orders: Some(orders), address, token, stop: Some(stop), thread: Some(thread) })
    }

    /// Where updates go.
    pub fn feed(&self) -> Feed {
        self.feed.clone()
    }

    /// What viewers want done; taken once.
    pub fn orders(&mut self) -> Option<Receiver<Order>> {
        self.orders.take()
    }

    /// Where it listens.
    pub fn address(&self) -> Option<SocketAddr> {
        self.address
    }

    /// What a person types into a browser: on this machine, then on others where they are let in.
    pub fn links(&self) -> Vec<String> {
        let Some(address) = self.address else { return Vec::new() };
        if address.ip().is_loopback() {
            return vec![format!("http://{address}/")];
        }
        let own = SocketAddr::new(own_address(address.ip()), address.port());
        let other = format!("http://{own}/?token={}", self.token);
        if !address.ip().is_unspecified() {
            return vec![other];
        }
        vec![format!("http://localhost:{}/", address.port()), other]
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Fails when the thread has ended already, which is as good.
        _ = self.stop.take().map(|stop| stop.send(()));
        _ = self.thread.take().map(JoinHandle::join);
    }
}

fn serve(
    runtime: &Runtime,
    hub: Arc<Hub>,
    inflow: Inflow,
    udp: Option<Udp>,
    accepting: Option<(StdListener, Served, Arc<Places>)>,
    stopped: oneshot::Receiver<()>,
) {
    runtime.block_on(async move {
        if let Some((listener, served, places)) = accepting
            && let Ok(listener) = TcpListener::from_std(listener)
        {
            tokio::spawn(accept(listener, router(served), places));
        }
        tokio::spawn(hub.run(inflow, udp));
        _ = stopped.await;
        tokio::time::sleep(LAST_WORDS).await;
    });
}

fn listen(address: SocketAddr) -> Result<StdListener, LiveError> {
    let open = || {
        let listener = StdListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(listener)
    };
    open().map_err(|source| LiveError::Address { address, source })
}

/// 128 random bits: nobody guesses them.
fn random_name() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(io::Error::other)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// The address that others reach this machine by, as far as it knows: of a socket that would send somewhere (a network
/// that is for documentation alone, RFC 5737). Nothing is sent.
fn own_address(bound: IpAddr) -> IpAddr {
    let towards = || {
        let socket = UdpSocket::bind(("0.0.0.0", 0))?;
        socket.connect(("192.0.2.1", 9))?;
        Ok::<_, io::Error>(socket.local_addr()?.ip())
    };
    if bound.is_unspecified() { towards().unwrap_or(bound) } else { bound }
}
