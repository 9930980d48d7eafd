//! What can be done to the body on purpose.

use std::ops::Range;
use std::str::FromStr;

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// The scalar sensor's sentence does not come.
    Drop,
    /// A byte of the sentence is another.
    Damage,
    /// The sentence comes one conversion late.
    Late,
    /// A bit of the converter's frame is another.
    Crc,
    /// The scalar sensor repeats what it sent last.
    Stuck,
    /// The scalar sensor's line picks up noise: rubbish instead of the sentence.
    Noise,
    /// The converter's plug is out: its bus reads zeros, and it must be set up again afterwards.
    Unplug,
    /// The body is reset.
    Reset,
    /// The body's power fails for an instant.
    Power,
    /// The firmware panics.
    Panic,
}

/// A fault and the rows that it befalls: `KIND@ROW` or `KIND@ROW+COUNT`, rows from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What happens.
    pub kind: FaultKind,
    /// When.
    pub rows: Range<u64>,
}

impl Fault {
    /// Whether one of `faults` of this kind befalls a row.
    pub(crate) fn any(faults: &[Self], kind: FaultKind, row: u64) -> bool {
        faults.iter().any(|fault| fault.kind == kind && fault.rows.contains(&row))
    }
}

impl FromStr for Fault {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let usage = "drop, damage, late, stuck, noise, crc, unplug, reset, power or panic, then @ROW or @ROW+COUNT, such as drop@1000+20";
        let (kind, rows) = text.split_once('@').ok_or(usage)?;
        let kind = match kind {
            "drop" => FaultKind::Drop,
            "damage" => FaultKind::Damage,
            "late" => FaultKind::Late,
            "crc" => FaultKind::Crc,
            "stuck" => FaultKind::Stuck,
            "noise" => FaultKind::Noise,
            "unplug" => FaultKind::Unplug,
            "reset" => FaultKind::Reset,
            "power" => FaultKind::Power,
            "panic" => FaultKind::Panic,
            _ => return Err(usage.into()),
        };
        let (first, count) = rows.split_once('+').unwrap_or((rows, "1"));
        let (first, count) = (first.parse::<u64>(), count.parse::<u64>());
        let (Ok(first), Ok(count)) = (first, count) else { return Err(usage.into()) };
        Ok(Self { kind, rows: first..first.saturating_add(count) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_read() {
        assert_eq!("drop@10+5".parse(), Ok(Fault { kind: FaultKind::Drop, rows: 10..15 }));
        assert_eq!("stuck@7".parse(), Ok(Fault { kind: FaultKind::Stuck, rows: 7..8 }));
        assert_eq!("reset@7".parse(), Ok(Fault { kind: FaultKind::Reset, rows: 7..8 }));
        assert!(
            "reset".parse::<Fault>().is_err() && "x@1".parse::<Fault>().is_err() && "drop@a".parse::<Fault>().is_err()
        );
    }
}
