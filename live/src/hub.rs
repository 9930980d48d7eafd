//! Who is told what is new. Runs in the server's thread; whoever records never sees it.

use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::extract::ws::Utf8Bytes;
use tokio::sync::broadcast::{Receiver, Sender, channel};
use tokio::time::{MissedTickBehavior, interval, sleep_until};

use crate::feed::{Inflow, Update};
use crate::message::{Epochs, Message};
use crate::notice::Order;
use crate::state::State;
use crate::udp::Udp;

/// Messages that a viewer may be behind by before it loses some: ten seconds at the fastest.
const BACKLOG: usize = 256;

/// Epochs of so long go into one message when they come fast: 25 pictures a second look smooth.
const FRAME: Duration = Duration::from_millis(40);

/// How often silence is looked for.
const WATCH: Duration = Duration::from_millis(250);

/// Updates that are taken before anybody else has a turn.
const AT_ONCE: usize = 256;

/// What viewers share.
pub(crate) struct Hub {
    state: Mutex<State>,
    news: Sender<Utf8Bytes>,
    orders: SyncSender<Order>,
    begin: Instant,
}

impl Hub {
    /// A hub whose viewers' orders go to `orders`.
    pub(crate) fn new(state: State, orders: SyncSender<Order>) -> Self {
        Self { state: Mutex::new(state), news: channel(BACKLOG).0, orders, begin: Instant::now() }
    }

    /// All that is known. It is held for a moment, by the server's thread alone; a panic under it leaves it whole enough.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A viewer's first message, and all news from then on.
    pub(crate) fn join(&self, may_mark: bool, may_command: bool) -> (String, Receiver<Utf8Bytes>) {
        let state = self.state();
        (state.hello(may_mark, may_command), self.news.subscribe())
    }

    /// Tell all viewers; nobody may be there.
    pub(crate) fn tell(&self, message: &Message<'_>) {
        if self.news.receiver_count() > 0 {
            _ = self.news.send(message.json().into());
        }
    }

    /// Give an order to whoever listens to the body; whether there was room for it.
    pub(crate) fn order(&self, order: Order) -> bool {
        self.orders.try_send(order).is_ok()
    }

    /// Take what comes until nothing more can.
    pub(crate) async fn run(self: Arc<Self>, mut inflow: Inflow, udp: Option<Udp>) {
        let mut watch = interval(WATCH);
        watch.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut updates = Vec::with_capacity(AT_ONCE);
        let mut next_frame = Instant::now();
        loop {
            tokio::select! {
                count = inflow.receiver.recv_many(&mut updates, AT_ONCE) => {
                    if count == 0 {
                        return;
                    }
                    self.take(&mut updates, udp.as_ref());
                }
                () = sleep_until(next_frame.into()), if !self.state().fresh.is_empty() => {}
                _ = watch.tick() => self.state().watch_silence(self.clock_s(), &mut |message| self.tell(message)),
            }
            if Instant::now() >= next_frame && self.send_fresh(inflow.lost.load(std::sync::atomic::Ordering::Relaxed)) {
                next_frame = Instant::now() + FRAME;
            }
        }
    }

    fn clock_s(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    fn take(&self, updates: &mut Vec<Update>, udp: Option<&Udp>) {
        let (clock_s, mut state) = (self.clock_s(), self.state());
        for update in updates.drain(..) {
            if let (Some(udp), Update::Sample(sample)) = (udp, &update) {
                udp.send(sample);
            }
            state.take(update, clock_s, &mut |message| self.tell(message));
        }
    }

    /// Whether there was anything to send.
    fn send_fresh(&self, lost: u64) -> bool {
        let mut state = self.state();
        if state.fresh.is_empty() {
            return false;
        }
        self.tell(&Message::Epochs(Epochs { rows: &state.fresh, lost }));
        state.fresh.clear();
        true
    }
}
