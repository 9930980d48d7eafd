//! From samples to what is told.

use super::alarm::Alarm;
use super::battery::{Charge, Conversions};
use super::leak::LeakContact;
use super::settings::HousekeepingSettings;
use super::values::Housekeeping;

/// Samples between two times that everything is told: a second.
const SAMPLES_TO_TELL: u32 = 10;

/// Leak contact and battery at an epoch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HousekeepingSample {
    /// Whether the leak contact is wet at this moment.
    pub is_wet: bool,
    /// The divider of the battery, counts of the chip's converter, 0 to 4,095; `None` while no conversion is done.
    pub battery_counts: Option<u16>,
}

/// What is to be told after a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HousekeepingNews {
    /// Leak and battery as they are.
    pub housekeeping: Housekeeping,
    /// Of the leak contact.
    pub leak: Option<Alarm>,
    /// Of the battery.
    pub battery: Option<Alarm>,
}

/// Watches leak contact and battery.
#[derive(Clone, Debug)]
pub struct Housekeeper {
    settings: HousekeepingSettings,
    contact: LeakContact,
    conversions: Conversions,
    charge: Charge,
    battery_v: Option<f32>,
    /// Since everything was told.
    samples: u32,
}

impl Housekeeper {
    /// Nothing is known yet.
    pub fn new(settings: HousekeepingSettings) -> Self {
        let (contact, conversions, charge) = (LeakContact::default(), Conversions::default(), Charge::default());
        Self { settings, contact, conversions, charge, battery_v: None, samples: 0 }
    }

    /// Whether there is anything to sample.
    pub fn is_fitted(&self) -> bool {
        self.settings.is_leak_fitted || self.settings.is_battery_fitted()
    }

    /// Whether there is water at the contact, for a second at least.
    pub fn has_leak(&self) -> bool {
        self.contact.is_wet
    }

    /// The sample of an epoch, ten a second; what is to be told, once a second, and at once when the leak contact has changed.
    pub fn step(&mut self, sample: HousekeepingSample) -> Option<HousekeepingNews> {
        let leak = if self.settings.is_leak_fitted { self.contact.step(sample.is_wet) } else { None };
        if let Some(counts) = sample.battery_counts {
            self.conversions.add(counts);
        }
        self.samples += 1;
        let is_second_over = self.samples == SAMPLES_TO_TELL;
        if !is_second_over && leak.is_none() {
            return None;
        }
        let battery = if is_second_over { self.weigh() } else { None };
        self.samples %= SAMPLES_TO_TELL;
        Some(HousekeepingNews { housekeeping: self.housekeeping(), leak, battery })
    }

    /// The voltage of this second.
    fn weigh(&mut self) -> Option<Alarm> {
        let HousekeepingSettings { battery_v_per_count, battery_low_v, .. } = self.settings;
        let is_fitted = self.settings.is_battery_fitted();
        self.battery_v = self.conversions.take_v(battery_v_per_count).filter(|_| is_fitted);
        self.battery_v.and_then(|battery_v| self.charge.step(battery_v, battery_low_v as f32))
    }

    fn housekeeping(&self) -> Housekeeping {
        let has_leak = self.settings.is_leak_fitted.then_some(self.contact.is_wet);
        Housekeeping { battery_v: self.battery_v, has_leak }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    const BOTH: HousekeepingSettings =
        HousekeepingSettings { battery_v_per_count: 0.01, battery_low_v: 11.0, is_leak_fitted: true };

    fn sample(is_wet: bool, counts: u16) -> HousekeepingSample {
        HousekeepingSample { is_wet, battery_counts: Some(counts) }
    }

    #[test]
    fn everything_is_told_once_a_second_and_a_leak_at_once() {
        let mut keeper = Housekeeper::new(BOTH);
        let mut told = |is_wet, samples: usize| -> Vec<(usize, Housekeeping, Option<Alarm>)> {
            let news = (0..samples).map(|_| keeper.step(sample(is_wet, 1_200)));
            let told = news.enumerate().filter_map(|(at, news)| news.map(|news| (at, news.housekeeping, news.leak)));
            told.collect()
        };
        let with = |has_leak| Housekeeping { battery_v: Some(12.0), has_leak: Some(has_leak) };
        assert_eq!(told(false, 25), [(9, with(false), None), (19, with(false), None)]);
        // Five samples into a second.
        let (begins, lasts) = ((9, with(true), Some(Alarm::Leak)), (14, with(true), None));
        assert_eq!(told(true, 20), [(4, with(false), None), begins, lasts]);
        assert!(keeper.has_leak());
    }

    #[test]
    fn what_is_not_fitted_is_not_told() {
        let mut keeper = Housekeeper::new(HousekeepingSettings { battery_v_per_count: 0.0, ..BOTH });
        let told = (0..10).filter_map(|_| keeper.step(sample(true, 1_200))).next_back().unwrap();
        assert_eq!(told.housekeeping, Housekeeping { battery_v: None, has_leak: Some(true) });
        let mut keeper = Housekeeper::new(HousekeepingSettings { is_leak_fitted: false, ..BOTH });
        let told = (0..10).filter_map(|_| keeper.step(sample(true, 1_000))).next_back().unwrap();
        assert_eq!(told.housekeeping, Housekeeping { battery_v: Some(10.0), has_leak: None });
        assert_eq!(told.battery, Some(Alarm::BatteryLow { battery_v: 10.0 }));
        assert!(!keeper.has_leak() && !Housekeeper::new(HousekeepingSettings::default()).is_fitted());
    }

    #[test]
    fn a_converter_that_gives_nothing_leaves_the_voltage_unknown() {
        let mut keeper = Housekeeper::new(BOTH);
        (0..10).for_each(|_| _ = keeper.step(sample(false, 1_200)));
        let silent = HousekeepingSample::default();
        let told = (0..10).filter_map(|_| keeper.step(silent)).next_back().unwrap();
        assert_eq!(told.housekeeping, Housekeeping { battery_v: None, has_leak: Some(false) });
    }
}
