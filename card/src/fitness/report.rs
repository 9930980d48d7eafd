//! What the trial of a card says: fit or not and why in one line, then the figures.

use std::fmt;
use std::time::Duration;

use super::capacity::Capacity;
use super::waits::Waits;

/// A card that is busy for longer may be waited for, but SD's own rules allow a write no more: specification 4.6.2.2.
const LONGEST_WAIT: Duration = Duration::from_millis(500);

/// What came of a trial.
#[derive(Clone, Debug)]
pub struct Report {
    pub(super) capacity: Capacity,
    pub(super) slow: Waits,
    pub(super) burst: Waits,
    /// Free space that could have been tried; 0 where that is not known.
    pub(super) free_bytes: u64,
    /// Whether all of it was, at least in samples.
    pub(super) is_whole: bool,
}

impl Report {
    /// Why the card is not fit; empty when it is.
    pub fn reasons(&self) -> Vec<String> {
        let Capacity { bad_blocks, wraps_after_bytes, .. } = self.capacity;
        let mut reasons = Vec::new();
        if let Some(bytes) = wraps_after_bytes {
            reasons.push(format!("it lies about its size: it starts again from its beginning after {} MB", mb(bytes)));
        } else if bad_blocks > 0 {
            reasons.push(format!("{bad_blocks} blocks do not hold what was written to them"));
        }
        let worst = self.slow.worst.max(self.burst.worst);
        if worst > LONGEST_WAIT {
            let (worst_ms, limit_ms) = (worst.as_millis(), LONGEST_WAIT.as_millis());
            reasons.push(format!("a write of one block took {worst_ms} ms, and {limit_ms} ms is the most"));
        }
        reasons
    }

    /// What the trial could not find out.
    fn doubts(&self) -> Vec<&'static str> {
        let doubts = [
            (!self.is_whole, "only a part of the free space was tried: without --quick all of it is"),
            (
                !self.capacity.is_from_card,
                "what was read back may come from this computer's memory: try it on Linux, or on the device itself",
            ),
        ];
        doubts.into_iter().filter(|(is_so, _)| *is_so).map(|(_, doubt)| doubt).collect()
    }
}

fn mb(bytes: u64) -> u64 {
    bytes / 1_000_000
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reasons = self.reasons();
        let because = if reasons.is_empty() { self.doubts().join("; ") } else { reasons.join("; ") };
        let verdict = if reasons.is_empty() { "fit" } else { "not fit" };
        let colon = if because.is_empty() { "" } else { ": " };
        writeln!(f, "{verdict}{colon}{because}")?;
        let Capacity { tried_bytes, bad_blocks, write_bytes_per_s, read_bytes_per_s, .. } = self.capacity;
        writeln!(f, "free space                {:>10} MB", mb(self.free_bytes))?;
        writeln!(f, "written and read back     {:>10} MB, {bad_blocks} bad blocks", mb(tried_bytes))?;
        writeln!(
            f,
            "speed, one piece          {:>10.1} MB/s written, {:.1} MB/s read",
            write_bytes_per_s / 1e6,
            read_bytes_per_s / 1e6
        )?;
        writeln!(f, "one block, made safe           p50 ms     p99 ms   worst ms     writes")?;
        for (name, Waits { count, p50, p99, worst }) in [("once a second", self.slow), ("in a row", self.burst)] {
            let [p50, p99, worst] = [p50, p99, worst].map(|wait| wait.as_secs_f64() * 1e3);
            writeln!(f, "  {name:<24} {p50:>10.1} {p99:>10.1} {worst:>10.1} {count:>10}")?;
        }
        Ok(())
    }
}
