//! One viewer, from its first message to its last.

use std::time::{Duration, Instant};

use axum::extract::ws::{CloseFrame, Message as Frame, Utf8Bytes, WebSocket, close_code};
use tokio::sync::broadcast::error::RecvError;
use tokio::time::{interval, timeout};

use crate::guard::Rights;
use crate::hub::Hub;
use crate::message::Message;
use crate::notice::Order;
use crate::wish::Wish;

/// Wishes that a viewer may have at once; a person pressing keys has a few a second.
const WISHES: f64 = 30.0;
/// And so many more each second.
const WISHES_PER_S: f64 = 6.0;

/// A viewer.
pub(crate) struct Viewer<'a> {
    socket: WebSocket,
    hub: &'a Hub,
    rights: Rights,
    patience: Duration,
    /// Wishes that it still has, and when that was.
    wishes: (f64, Instant),
}

/// The viewer is gone, or has to go.
struct Gone;

impl<'a> Viewer<'a> {
    pub(crate) fn new(socket: WebSocket, hub: &'a Hub, rights: Rights, patience: Duration) -> Self {
        Self { socket, hub, rights, patience, wishes: (WISHES, Instant::now()) }
    }

    /// Until it is gone.
    pub(crate) async fn run(mut self) {
        _ = self.talk().await;
    }

    async fn talk(&mut self) -> Result<(), Gone> {
        let (hello, mut news) = self.hub.join(self.rights.may_mark(), self.rights.may_command());
        self.send(hello.into()).await?;
        let mut ping = interval(self.patience / 2);
        let mut heard = Instant::now();
        loop {
            tokio::select! {
                new = news.recv() => match new {
                    Ok(message) => self.send(message).await?,
                    Err(RecvError::Lagged(messages)) => self.tell(&Message::Lost { messages }).await?,
                    Err(RecvError::Closed) => return Ok(()),
                },
                frame = self.socket.recv() => {
                    heard = Instant::now();
                    match frame.ok_or(Gone)?.map_err(|_| Gone)? {
                        Frame::Text(text) => self.wish(&text).await?,
                        Frame::Binary(_) => return self.dismiss(close_code::UNSUPPORTED, "text only").await,
                        Frame::Close(_) => return Ok(()),
                        Frame::Ping(_) | Frame::Pong(_) => {}
                    }
                }
                _ = ping.tick() => {
                    if heard.elapsed() > 2 * self.patience {
                        return Err(Gone);
                    }
                    self.give(Frame::Ping(Default::default())).await?;
                }
            }
        }
    }

    async fn wish(&mut self, text: &str) -> Result<(), Gone> {
        let (left, since) = self.wishes;
        let left = (left + WISHES_PER_S * since.elapsed().as_secs_f64()).min(WISHES) - 1.0;
        self.wishes = (left, Instant::now());
        if left < 0.0 {
            return self.dismiss(close_code::POLICY, "too many wishes").await;
        }
        let Some(wish) = Wish::parse(text) else { return self.dismiss(close_code::POLICY, "no such wish").await };
        if let Wish::History { window_s, since_s } = wish {
            let history = self.hub.state().history(window_s, since_s);
            return self.send(history.into()).await;
        }
        match self.carry_out(wish) {
            Ok(()) => Ok(()),
            Err(text) => self.tell(&Message::Refused { text }).await,
        }
    }

    fn carry_out(&self, wish: Wish) -> Result<(), &'static str> {
        let order = match wish {
            Wish::Mark { .. } | Wish::Acknowledge { .. } if !self.rights.may_mark() => {
                return Err("this viewer may only look: marks and alarms are for the machine that listens");
            }
            Wish::Command { .. } if !self.rights.may_command() => {
                return Err("no commands from here: start with --allow-commands, on the machine that listens");
            }
            Wish::Mark { time_s, label } => Order::Mark(self.hub.state().mark(time_s, label)),
            Wish::Acknowledge { alarm } => {
                let seen = self.hub.state().acknowledge(&alarm, &mut |message| self.hub.tell(message));
                let Some(text) = seen else { return Ok(()) };
                Order::Note(format!("alarm seen: {text}"))
            }
            Wish::Command { line } => Order::Command(line),
            Wish::History { .. } => return Ok(()),
        };
        if self.hub.order(order) { Ok(()) } else { Err("not done: too much at once") }
    }

    async fn tell(&mut self, message: &Message<'_>) -> Result<(), Gone> {
        self.send(message.json().into()).await
    }

    async fn send(&mut self, text: Utf8Bytes) -> Result<(), Gone> {
        self.give(Frame::Text(text)).await
    }

    /// Who takes nothing for so long is gone; meanwhile it misses news, and is told so.
    async fn give(&mut self, frame: Frame) -> Result<(), Gone> {
        timeout(self.patience, self.socket.send(frame)).await.map_err(|_| Gone)?.map_err(|_| Gone)
    }

    async fn dismiss(&mut self, code: u16, reason: &'static str) -> Result<(), Gone> {
        self.give(Frame::Close(Some(CloseFrame { code, reason: reason.into() }))).await?;
        Err(Gone)
    }
}
