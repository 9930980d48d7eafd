//! The battery: its voltage as the mean of some conversions, and when it is low.

use super::alarm::Alarm;

/// A battery that was low is no longer so at this many times its limit: loads that come and go move its voltage by less.
const WELL_AGAIN: f32 = 1.05;

/// Conversions that wait to be averaged.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Conversions {
    sum: u32,
    count: u32,
}

impl Conversions {
    /// One more.
    pub(super) fn add(&mut self, counts: u16) {
        self.sum += u32::from(counts);
        self.count += 1;
    }

    /// The voltage that they mean, V; `None` when there are none. Then they begin anew.
    pub(super) fn take_v(&mut self, v_per_count: f64) -> Option<f32> {
        let Self { sum, count } = core::mem::take(self);
        (count > 0).then(|| (f64::from(sum) / f64::from(count) * v_per_count) as f32)
    }
}

/// Whether the battery is low.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Charge {
    is_low: bool,
}

impl Charge {
    /// A voltage, and the limit below which it is low, V; what is to be told of it.
    pub(super) fn step(&mut self, battery_v: f32, low_v: f32) -> Option<Alarm> {
        let limit_v = if self.is_low { low_v * WELL_AGAIN } else { low_v };
        let is_low = battery_v < limit_v;
        let has_changed = core::mem::replace(&mut self.is_low, is_low) != is_low;
        has_changed.then_some(if is_low { Alarm::BatteryLow { battery_v } } else { Alarm::BatteryWell { battery_v } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_voltage_is_the_mean_of_what_was_converted() {
        let mut conversions = Conversions::default();
        assert_eq!(conversions.take_v(0.01), None);
        [1_000, 1_003].into_iter().for_each(|counts| conversions.add(counts));
        assert_eq!(conversions.take_v(0.01), Some(10.015));
        assert_eq!(conversions.take_v(0.01), None, "each counts once");
    }

    #[test]
    fn a_voltage_that_trembles_about_its_limit_is_told_once() {
        let mut charge = Charge::default();
        assert_eq!(charge.step(11.1, 11.0), None);
        assert_eq!(charge.step(10.9, 11.0), Some(Alarm::BatteryLow { battery_v: 10.9 }));
        assert!([11.2, 10.8, 11.5].into_iter().all(|battery_v| charge.step(battery_v, 11.0).is_none()));
        assert_eq!(charge.step(11.6, 11.0), Some(Alarm::BatteryWell { battery_v: 11.6 }));
        assert_eq!(Charge::default().step(0.0, 0.0), None, "no limit, no warning");
    }
}
