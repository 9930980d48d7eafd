//! That the body does not run from its crystal.

use crate::health::{Count, Health};
use crate::log::{Event, EventKind, TEXT_LEN};
use crate::microcontroller::ClockFault;
use core::fmt::Write as _;
use heapless::spsc::Producer;

/// Count it, so that cable, `status` and the red light tell it, and have the log say why. First of all after a start, while
/// the queue is empty.
pub fn tell_clock(fault: Option<ClockFault>, health: &Health, notices: &mut Producer<'_, Event>) {
    let Some(fault) = fault else { return };
    health.counts.add(Count::CrystalFailed, 1);
    let mut text = heapless::String::<TEXT_LEN>::new();
    // Its longest text has half that length.
    _ = write!(text, "{fault}");
    _ = notices.enqueue(Event { tick: 0, kind: EventKind::Notice(text) });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::console::NoticeQueue;

    #[test]
    fn the_log_gets_the_whole_reason() {
        let (health, mut queue) = (Health::new(), NoticeQueue::new());
        let (mut notices, mut log) = queue.split();
        tell_clock(None, &health, &mut notices);
        assert_eq!((log.dequeue(), health.counts.get(Count::CrystalFailed)), (None, 0));
        for fault in [ClockFault::WrongFrequency { khz: u32::MAX }, ClockFault::NotMeasured] {
            tell_clock(Some(fault), &health, &mut notices);
            let Some(Event { kind: EventKind::Notice(text), .. }) = log.dequeue() else { panic!("no notice") };
            assert!(text.starts_with("the crystal") && text.ends_with("per cent"), "{text}");
        }
    }
}
