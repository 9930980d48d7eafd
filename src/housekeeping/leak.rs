//! The leak contact, debounced.

use super::alarm::Alarm;

/// For so many samples in a row, a second, the contact must show the same before it is believed: drops that run over it
/// come and go.
const STEADY_SAMPLES: u32 = 10;

/// Samples between two warnings while the leak lasts: a minute.
const WARN_AGAIN_SAMPLES: u32 = 600;

/// The contact, as far as it is believed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LeakContact {
    pub(super) is_wet: bool,
    /// Samples in a row that show the contrary.
    contrary: u32,
    /// Samples since it is wet.
    wet_for: u32,
}

impl LeakContact {
    /// One sample; what is to be told of it.
    pub(super) fn step(&mut self, is_wet: bool) -> Option<Alarm> {
        self.contrary = if is_wet == self.is_wet { 0 } else { self.contrary + 1 };
        if self.contrary == STEADY_SAMPLES {
            *self = Self { is_wet, ..Self::default() };
            return Some(if is_wet { Alarm::Leak } else { Alarm::LeakOver });
        }
        if !self.is_wet {
            return None;
        }
        self.wet_for = self.wet_for.saturating_add(1);
        let minutes = self.wet_for / WARN_AGAIN_SAMPLES;
        self.wet_for.is_multiple_of(WARN_AGAIN_SAMPLES).then_some(Alarm::StillLeak { minutes })
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    #[test]
    fn drops_are_no_leak_and_a_leak_is_told_every_minute() {
        let mut contact = LeakContact::default();
        for _ in 0..100 {
            // Nine wet, one dry.
            assert!((0..10).all(|sample| contact.step(sample < 9).is_none()) && !contact.is_wet);
        }
        let told: Vec<_> = (1..=1_300).filter_map(|sample| Some((sample, contact.step(true)?))).collect();
        let (first, second) = (Alarm::StillLeak { minutes: 1 }, Alarm::StillLeak { minutes: 2 });
        assert_eq!(told, [(10, Alarm::Leak), (610, first), (1_210, second)]);
        let told: Vec<_> = (1..=1_300).filter_map(|sample| Some((sample, contact.step(false)?))).collect();
        assert_eq!(told, [(10, Alarm::LeakOver)]);
    }
}
