//! The operator's lines on their way to the body: numbered and with a CRC, and sent again until the body acknowledges them.

use std::io::{BufRead, Write};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use super::ship_time::ShipTime;
use towmag::link::{LONGEST_LINE, NumberedLine, acknowledged, numbered};

/// Silence after which a line counts as lost. While the body sends an answer, the next command waits for its turn.
const PATIENCE: Duration = Duration::from_secs(2);

/// How often a line is sent before the operator is told.
const ATTEMPTS: u32 = 4;

/// A line that the body has not acknowledged.
struct Waiting {
    number: u16,
    line: NumberedLine,
    attempts: u32,
    /// Of the last attempt, or of a sign of life since.
    since: Instant,
}

/// Sends one line after the other.
pub(super) struct Commands<W> {
    typed: Receiver<String>,
    /// The way in for others than the keyboard.
    sender: Sender<String>,
    writer: W,
    /// Of the last line.
    number: u16,
    waiting: Option<Waiting>,
    ship_time: ShipTime,
}

impl<W: Write> Commands<W> {
    /// Send what comes from `lines`, in a thread that ends with the program: nothing waits for a person at a keyboard.
    /// `number` should differ from those of an earlier session, whose last one the body still knows.
    pub(super) fn new(lines: impl BufRead + Send + 'static, writer: W, number: u16, ship_time: ShipTime) -> Self {
        let (sender, typed) = channel();
        let keyboard = sender.clone();
        std::thread::spawn(move || {
            for line in lines.lines().map_while(Result::ok).filter(|line| !line.trim().is_empty()) {
                if keyboard.send(line).is_err() {
                    return;
                }
            }
        });
        Self { typed, sender, writer, number, waiting: None, ship_time }
    }

    /// Send a line when its turn comes.
    pub(super) fn queue(&self, line: String) {
        // The receiver is beside it.
        _ = self.sender.send(line);
    }

    /// Send what is due. Something comes out for the operator to know. `unix_us` is the ship's time.
    pub(super) fn poll(&mut self, now: Instant, unix_us: u64) -> Option<String> {
        match &mut self.waiting {
            Some(waiting) if now.duration_since(waiting.since) < PATIENCE => None,
            Some(waiting) if waiting.attempts < ATTEMPTS => {
                waiting.attempts += 1;
                waiting.since = now;
                let line = waiting.line.clone();
                self.write(&line);
                None
            }
            Some(_) => {
                self.waiting = None;
                Some(format!("the body does not answer: the command was sent {ATTEMPTS} times, and may not be done"))
            }
            None => self.begin(now, unix_us),
        }
    }

    /// A line of text from the body: whether it is an acknowledgement, or about the clock, and not
    /// for the operator.
    pub(super) fn heard(&mut self, text: &str, now: Instant, unix_us: u64) -> bool {
        let number = acknowledged(text);
        if let Some(waiting) = &mut self.waiting {
            waiting.since = now;
            if number == Some(waiting.number) {
                self.waiting = None;
            }
        }
        number.is_some() || self.ship_time.heard(text, unix_us)
    }

    /// The body has started anew.
    pub(super) fn restart(&mut self) {
        self.ship_time.restart();
    }

    /// The next line: what somebody has typed before what is asked for the clock's sake.
    fn begin(&mut self, now: Instant, unix_us: u64) -> Option<String> {
        let typed = self.typed.try_recv().ok();
        let is_own = typed.is_none();
        let command = typed.or_else(|| self.ship_time.due(unix_us))?;
        self.number = self.number.wrapping_add(1);
        let Some(line) = numbered(self.number, command.trim()) else {
            return Some(format!("not sent: with its number a command has {LONGEST_LINE} characters at most"));
        };
        if is_own {
            self.ship_time.goes(self.number, line.len() + 1, unix_us);
        }
        self.write(&line);
        self.waiting = Some(Waiting { number: self.number, line, attempts: 1, since: now });
        None
    }

    /// One write, so that a slow line does not see half a command; a port that is gone is the reader's to report.
    fn write(&mut self, line: &str) {
        _ = self.writer.write_all(format!("{line}\n").as_bytes()).and_then(|()| self.writer.flush());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Has asked in vain, and waits for its next turn.
    fn silent() -> ShipTime {
        let mut ship_time = ShipTime::new(None);
        while ship_time.due(1).is_some() {}
        ship_time
    }

    /// Commands of an operator who has typed everything, and the instant from which on they are sent.
    fn typed(lines: &'static str) -> (Commands<Vec<u8>>, Instant) {
        let mut commands = Commands::new(lines.as_bytes(), Vec::new(), 6, silent());
        let mut now = Instant::now();
        while commands.waiting.is_none() {
            assert_eq!(commands.poll(now, 0), None);
            std::thread::yield_now();
            now = Instant::now();
        }
        (commands, now)
    }

    fn sent(commands: &Commands<Vec<u8>>) -> Vec<String> {
        String::from_utf8(commands.writer.clone()).unwrap().lines().map(str::to_string).collect()
    }

    #[test]
    fn the_next_goes_when_the_last_has_arrived() {
        let (mut commands, now) = typed("status\n\nget\n");
        let status = numbered(7, "status").unwrap();
        assert_eq!(sent(&commands), [status.as_str()]);
        assert!(!commands.heard("towmag 0.1.0", now, 0) && !commands.heard("#8 ok, or what", now, 0));
        assert!(commands.heard("#9 ok", now, 0) && commands.waiting.is_some(), "of an older line");
        assert!(commands.heard("#7 ok", now, 0) && commands.waiting.is_none());
        while commands.waiting.is_none() {
            assert_eq!(commands.poll(now, 0), None);
        }
        assert_eq!(sent(&commands)[1], numbered(8, "get").unwrap().as_str());
    }

    #[test]
    fn a_lost_line_is_sent_again_and_in_the_end_told() {
        let (mut commands, mut now) = typed("status\n");
        for attempt in 1..=ATTEMPTS as usize {
            assert_eq!(sent(&commands).len(), attempt);
            now += PATIENCE / 2;
            assert_eq!(commands.poll(now, 0), None);
            // While an answer comes, nothing is lost.
            commands.heard("name = value", now, 0);
            now += PATIENCE / 2 + Duration::from_millis(1);
            assert_eq!(commands.poll(now, 0), None);
            assert_eq!(sent(&commands).len(), attempt);
            now += PATIENCE;
            let told = commands.poll(now, 0);
            assert_eq!(told.is_some(), attempt == ATTEMPTS as usize);
        }
        assert!(sent(&commands).iter().all(|line| *line == sent(&commands)[0]));
    }

    #[test]
    fn what_is_too_long_is_said() {
        let long: &'static str = Box::leak("x".repeat(200).into_boxed_str());
        let mut commands = Commands::new(long.as_bytes(), Vec::new(), 6, silent());
        let told = std::iter::repeat_with(|| commands.poll(Instant::now(), 0)).find_map(|told| told).unwrap();
        assert!(told.starts_with("not sent"), "{told}");
        assert!(sent(&commands).is_empty());
    }
}
