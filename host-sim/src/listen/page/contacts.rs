//! Contacts as they come: the detector of the survey, on the last minutes of the compensated field, again and again.
//!
//! It sees nothing but what has come by then, and what it has told stands. A contact is told when what follows it has
//! come, too: half a pass later.

use std::collections::VecDeque;
use std::io;
use std::sync::mpsc::Sender;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, channel, sync_channel};
use std::time::{Duration, Instant};

use towmag_live::{Contact, Sample};
use towmag_survey::contacts::{Levelled, Options, Pass, find};

use crate::recording::{LONGEST_STEP_S, RATE_HZ};

/// The detector looks at so much, s: the noise is measured in it, over 45 s and more in each band.
const WINDOW_S: f64 = 300.0;
/// And it begins with so much.
const LEAST_S: f64 = 60.0;
/// Between two looks, s: a ship goes 10 m.
const STEP_S: f64 = 5.0;
/// Distance over speed that is looked for, s: 2 m at 4 m/s to 12 m at 2 m/s. What is wider is told by the desk.
const DISTANCES_S: [f64; 2] = [0.4, 6.0];
/// A contact is told when so many distances after it have come: the anomaly has less than a fifteenth of its peak there, and
/// the fit does not change any more.
const FOLLOWED_BY: f64 = 3.0;
/// And no earlier in the window than this, s: the spectrum's ends are tapered, and what was near the window's begin has been
/// looked at before.
const MARGIN_S: f64 = 20.0;
/// Two contacts closer than this, s, or than their widths, are one that was seen again.
const APART_S: f64 = 3.0;
/// So many are remembered, more than a window can hold.
const REMEMBERED: usize = 200;
/// False contacts an hour that the survey's threshold stands for where a recording is looked at once. Here each epoch is looked
/// at sixty times, with noise that is measured anew in a few minutes: with 0.01 there were 4 in 5 hours of noise, with this
/// none, as the test below counts.
const FALSE_ALARMS_PER_HOUR: f64 = 0.001;
/// Samples that may wait: more than six minutes.
const WAITING: usize = 4_096;
/// A look is followed by so many times its duration of rest: a tenth of a processor at most, however fast a recording is shown.
const REST: u32 = 10;

/// The detector, in a thread of its own.
pub(super) struct Detector {
    samples: SyncSender<Sample>,
    contacts: Receiver<Contact>,
}

impl Detector {
    /// Begin to look.
    pub(super) fn begin() -> io::Result<Self> {
        let (samples, inflow) = sync_channel(WAITING);
        let (outflow, contacts) = channel();
        std::thread::Builder::new().name("contacts".into()).spawn(move || look_on(&inflow, &outflow))?;
        Ok(Self { samples, contacts })
    }

    /// Take an epoch; one that there is no room for is missed, and one before the compensation has settled is not looked at.
    pub(super) fn take(&self, sample: &Sample, is_settled: bool) {
        let compensated_nt = sample.compensated_nt.filter(|_| is_settled);
        _ = self.samples.try_send(Sample { compensated_nt, ..*sample });
    }

    /// What was found since this was asked last.
    pub(super) fn found(&self) -> Vec<Contact> {
        self.contacts.try_iter().collect()
    }
}

fn look_on(samples: &Receiver<Sample>, contacts: &Sender<Contact>) {
    let (mut window, mut next_look) = (Window::default(), Instant::now());
    loop {
        match samples.recv_timeout(Duration::from_secs(1)) {
            Ok(sample) => window.push(sample),
            Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return,
        }
        if !window.is_due() || Instant::now() < next_look {
            continue;
        }
        let begin = Instant::now();
        if window.look().into_iter().any(|contact| contacts.send(contact).is_err()) {
            return;
        }
        next_look = Instant::now() + REST * begin.elapsed();
    }
}

/// The last minutes, and what was told of them.
#[derive(Default)]
struct Window {
    samples: VecDeque<Sample>,
    /// The latest of them.
    told: VecDeque<Contact>,
    count: u32,
    looked_s: f64,
}

impl Window {
    fn push(&mut self, sample: Sample) {
        // What is before a gap was of another pass; a detector that has to bridge it would see a step.
        if self.samples.back().is_some_and(|last| sample.time_s - last.time_s > 100.0 * LONGEST_STEP_S) {
            self.samples.clear();
        }
        self.samples.push_back(sample);
        let last_s = sample.time_s;
        while self.samples.front().is_some_and(|first| last_s - first.time_s > WINDOW_S) {
            self.samples.pop_front();
        }
    }

    fn is_due(&self) -> bool {
        let (Some(first), Some(last)) = (self.samples.front(), self.samples.back()) else { return false };
        last.time_s - first.time_s >= LEAST_S && last.time_s - self.looked_s >= STEP_S
    }

    /// What is new in it.
    fn look(&mut self) -> Vec<Contact> {
        let (first_s, last_s) = match (self.samples.front(), self.samples.back()) {
            (Some(first), Some(last)) => (first.time_s, last.time_s),
            _ => return Vec::new(),
        };
        self.looked_s = last_s;
        let mut new = Vec::new();
        for pass in self.passes(first_s) {
            let time_s = first_s + pass.time_s;
            // Without a track the dipole is in seconds.
            let is_followed = last_s - time_s >= FOLLOWED_BY * pass.dipole.distance;
            let is_inside = time_s - first_s >= MARGIN_S;
            if is_followed && is_inside && !self.is_told(time_s, pass.width_s) {
                let contact = self.contact(&pass, time_s);
                self.remember(contact);
                new.push(contact);
            }
        }
        new
    }

    fn remember(&mut self, contact: Contact) {
        self.count = contact.number;
        if self.told.len() == REMEMBERED {
            self.told.pop_front();
        }
        self.told.push_back(contact);
    }

    fn passes(&self, first_s: f64) -> Vec<Pass> {
        // Seconds from the window's begin: those since 1970 have few digits left for tenths.
        let time_s: Vec<f64> = self.samples.iter().map(|sample| sample.time_s - first_s).collect();
        let field_nt: Vec<f64> = self.samples.iter().map(|sample| sample.compensated_nt.unwrap_or(f64::NAN)).collect();
        let is_valid: Vec<bool> = field_nt.iter().map(|nt| nt.is_finite()).collect();
        if is_valid.iter().filter(|is_valid| **is_valid).count() < (LEAST_S * RATE_HZ) as usize {
            return Vec::new();
        }
        // The fluxgate does not come up the cable: what compensation takes along of a target is not accounted for.
        let (terms, direction) = (vec![[0.0; 18]; time_s.len()], vec![[0.0, 0.0, 1.0]; time_s.len()]);
        let levelled = Levelled {
            time_s: &time_s,
            is_valid: &is_valid,
            field_nt: &field_nt,
            variance_nt2: None,
            terms: &terms,
            direction: &direction,
            track: None,
            altitude_m: None,
            depth_m: None,
        };
        let options =
            Options { false_alarms_per_hour: FALSE_ALARMS_PER_HOUR, distances_s: DISTANCES_S, ..Options::default() };
        find(&levelled, &options).passes
    }

    fn is_told(&self, time_s: f64, width_s: f64) -> bool {
        let is_same = |told: &&Contact| (told.time_s - time_s).abs() < APART_S.max(width_s).max(told.width_s);
        self.told.iter().any(|told| is_same(&told))
    }

    fn contact(&self, pass: &Pass, time_s: f64) -> Contact {
        let row = self.samples.partition_point(|sample| sample.time_s < time_s);
        let number = self.count + 1;
        let position_deg = self.samples.get(row).and_then(|sample| sample.position_deg);
        Contact { number, time_s, peak_nt: pass.peak_nt, width_s: pass.width_s, snr: pass.snr, position_deg }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// An hour and more of noise as a tow has it, a slow walk and a white floor of 0.05 nT, with targets at these times.
    fn tow(seed: u64, hours: f64, targets: &[(f64, f64, f64)]) -> Vec<Sample> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        let mut slow_nt = 0.0;
        let row = |k: u32| {
            let time_s = 1.7e9 + 0.1 * f64::from(k);
            slow_nt = 0.9998 * slow_nt + 0.03 * normal();
            let dipole = |&(at_s, half_s, nt): &(f64, f64, f64)| {
                let u = (0.1 * f64::from(k) - at_s) / half_s;
                nt * (1.0 - 0.5 * u * u) / (1.0 + u * u).powf(2.5)
            };
            let nt = 49_000.0 + slow_nt + 0.05 * normal() + targets.iter().map(dipole).sum::<f64>();
            Sample { time_s, compensated_nt: Some(nt), position_deg: Some([54.0, 10.0]), ..Sample::default() }
        };
        (0..(hours * 36_000.0) as u32).map(row).collect()
    }

    /// What is told, and when.
    fn told(samples: &[Sample]) -> Vec<(Contact, f64)> {
        let mut window = Window::default();
        let mut all = Vec::new();
        for sample in samples {
            window.push(*sample);
            if window.is_due() {
                all.extend(window.look().into_iter().map(|contact| (contact, sample.time_s)));
            }
        }
        all
    }

    #[test]
    fn targets_are_told_once_and_soon() {
        // The last is told after the first has left the window.
        let targets = [(85.0, 1.5, 6.0), (230.0, 3.0, -4.0), (400.0, 0.8, 3.0)];
        let told = told(&tow(1, 0.125, &targets));
        assert_eq!(told.len(), 3, "{told:?}");
        for ((contact, when_s), (at_s, half_s, nt)) in told.iter().zip(targets) {
            assert!((contact.time_s - 1.7e9 - at_s).abs() < 0.5 && (contact.peak_nt - nt).abs() < 0.5, "{contact:?}");
            assert!(when_s - contact.time_s < 4.0 * half_s + 2.0 * STEP_S, "told {} s later", when_s - contact.time_s);
            assert_eq!(contact.position_deg, Some([54.0, 10.0]));
        }
        assert_eq!(told.iter().map(|(contact, _)| contact.number).collect::<Vec<_>>(), [1, 2, 3]);
    }

    #[test]
    fn holes_and_gaps_are_no_targets() {
        let mut samples = tow(2, 0.1, &[]);
        samples[1_000..1_030].iter_mut().for_each(|sample| sample.compensated_nt = None);
        samples[2_000..].iter_mut().for_each(|sample| sample.time_s += 100.0);
        samples[2_000..]
            .iter_mut()
            .for_each(|sample| sample.compensated_nt = sample.compensated_nt.map(|nt| nt + 80.0));
        assert_eq!(told(&samples), []);
    }

    #[test]
    #[ignore = "10 minutes: how often nothing is taken for a target, in 5 h of noise"]
    fn false_contacts_an_hour() {
        let hours = 1.0;
        let counts: Vec<usize> = (200..205).map(|seed| told(&tow(seed, hours, &[])).len()).collect();
        let all: usize = counts.iter().sum();
        println!("false contacts: {all} in {} h, {counts:?}", hours * counts.len() as f64);
        assert!(all as f64 <= hours * counts.len() as f64);
    }
}
