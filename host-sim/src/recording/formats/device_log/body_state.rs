//! Where and how the body was, from what its events tell: a value holds until a newer one comes, or for three seconds.

use towmag::EPOCH_US;
use towmag::housekeeping::Housekeeping;
use towmag::navigation::{LONGEST_AGE_S, Navigation, NavigationReport, Navigator};

use crate::recording::rate::RATE_HZ;
use towmag_recording::Column;

/// Latitude and longitude are logged in 1e-7 degrees.
const ANGLE_STEP_DEG: f64 = 1e-7;

const LONGEST_AGE_TICKS: u32 = LONGEST_AGE_S * RATE_HZ as u32;

/// What the body knew at an epoch beside its readings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BodyState {
    pub(super) navigation: Navigation,
    pub(super) housekeeping: Housekeeping,
}

impl From<Navigation> for BodyState {
    fn from(navigation: Navigation) -> Self {
        Self { navigation, ..Self::default() }
    }
}

impl From<Housekeeping> for BodyState {
    fn from(housekeeping: Housekeeping) -> Self {
        Self { housekeeping, ..Self::default() }
    }
}

/// A column that only logs have in which the body knew the value at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StateColumn {
    Depth,
    Altitude,
    Latitude,
    Longitude,
    Fix,
    Heading,
    MagneticHeading,
    Battery,
    Leak,
}

impl StateColumn {
    pub(super) const ALL: [Self; 9] = [
        Self::Depth,
        Self::Altitude,
        Self::Latitude,
        Self::Longitude,
        Self::Fix,
        Self::Heading,
        Self::MagneticHeading,
        Self::Battery,
        Self::Leak,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Fix => "position_fix",
            // Not the contract's heading, which is from true north.
            Self::MagneticHeading => "heading_magnetic_deg",
            _ => self.column().map_or("", Column::name),
        }
    }

    /// The column of the contract.
    pub(super) fn column(self) -> Option<Column> {
        match self {
            Self::Depth => Some(Column::Depth),
            Self::Altitude => Some(Column::Altitude),
            Self::Latitude => Some(Column::Latitude),
            Self::Longitude => Some(Column::Longitude),
            Self::Heading => Some(Column::Heading),
            Self::Battery => Some(Column::BatteryVoltage),
            Self::Leak => Some(Column::Leak),
            Self::Fix | Self::MagneticHeading => None,
        }
    }

    pub(super) fn value(self, state: &BodyState) -> Option<f64> {
        let Navigation { position, .. } = state.navigation;
        match self {
            Self::Latitude => position.map(|position| f64::from(position.latitude_e7) * ANGLE_STEP_DEG),
            Self::Longitude => position.map(|position| f64::from(position.longitude_e7) * ANGLE_STEP_DEG),
            Self::Fix => position.map(|position| position.fix.into()),
            Self::Leak => state.housekeeping.has_leak.map(|has_leak| u8::from(has_leak).into()),
            _ => self.single(state).map(f64::from),
        }
    }

    /// What is logged in `f32`.
    fn single(self, state: &BodyState) -> Option<f32> {
        let Navigation { depth_m, altitude_m, heading, .. } = state.navigation;
        let heading = |is_magnetic| heading.filter(|heading| heading.is_magnetic == is_magnetic);
        match self {
            Self::Depth => depth_m,
            Self::Altitude => altitude_m,
            Self::Battery => state.housekeeping.battery_v,
            Self::Heading => heading(false).map(|heading| heading.deg),
            Self::MagneticHeading => heading(true).map(|heading| heading.deg),
            Self::Latitude | Self::Longitude | Self::Fix | Self::Leak => None,
        }
    }

    /// In the fewest digits that give the same bits back.
    pub(super) fn text(self, state: &BodyState) -> String {
        match self {
            Self::Latitude | Self::Longitude => self.value(state).map(|deg| format!("{deg:.7}")).unwrap_or_default(),
            Self::Fix | Self::Leak => self.value(state).map(|whole| whole.to_string()).unwrap_or_default(),
            _ => self.single(state).map(|value| value.to_string()).unwrap_or_default(),
        }
    }

    pub(super) fn step(self, state: &BodyState) -> Option<f64> {
        match self {
            Self::Latitude | Self::Longitude => state.navigation.position.map(|_| ANGLE_STEP_DEG),
            Self::Fix | Self::Leak => None,
            _ => self.single(state).map(f32_step),
        }
    }
}

/// The events and epochs of a session, in their order.
#[derive(Debug, Default)]
pub(super) struct Track {
    navigator: Navigator,
    /// What was told last of leak and battery, and when.
    housekeeping: Option<(u32, Housekeeping)>,
    tick: Option<u32>,
}

impl Track {
    /// What an event has told of where the body was.
    pub(super) fn tell_navigation(&mut self, tick: u32, navigation: Navigation) {
        self.go_on_to(tick);
        self.navigator.take(&NavigationReport { navigation, stamp_us: stamp_us(tick) });
    }

    /// What an event has told of leak and battery.
    pub(super) fn tell_housekeeping(&mut self, tick: u32, housekeeping: Housekeeping) {
        self.go_on_to(tick);
        self.housekeeping = Some((tick, housekeeping));
    }

    /// What was known at an epoch.
    pub(super) fn at(&mut self, tick: u32) -> BodyState {
        self.go_on_to(tick);
        let told = self.housekeeping.filter(|(told, _)| tick.wrapping_sub(*told) <= LONGEST_AGE_TICKS);
        let housekeeping = told.map(|(_, housekeeping)| housekeeping).unwrap_or_default();
        BodyState { navigation: self.navigator.at(stamp_us(tick)), housekeeping }
    }

    /// Stamps wrap: what comes after a long pause must not look young.
    fn go_on_to(&mut self, tick: u32) {
        let is_apart = |last: u32| tick.wrapping_sub(last) > LONGEST_AGE_TICKS;
        if self.tick.replace(tick).is_some_and(is_apart) {
            (self.navigator, self.housekeeping) = (Navigator::default(), None);
        }
    }
}

fn stamp_us(tick: u32) -> u32 {
    tick.wrapping_mul(EPOCH_US)
}

/// From a finite value to the next larger one.
pub(super) fn f32_step(value: f32) -> f64 {
    f64::from(value.abs().next_up()) - f64::from(value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depth(depth_m: f32) -> Navigation {
        Navigation { depth_m: Some(depth_m), ..Navigation::default() }
    }

    #[test]
    fn a_value_holds_for_thirty_ticks_and_not_after_a_pause_of_any_length() {
        let mut track = Track::default();
        track.tell_navigation(u32::MAX - 3, depth(12.5));
        for ahead in 0..=30 {
            assert_eq!(track.at((u32::MAX - 3).wrapping_add(ahead)).navigation.depth_m, Some(12.5), "{ahead}");
        }
        assert_eq!(track.at(27).navigation.depth_m, None);
        // 42,949.67296 ticks are a turn of the stamps.
        for pause in [31, 21_000, 30_000, 42_950] {
            let mut track = Track::default();
            track.tell_navigation(5, depth(12.5));
            assert_eq!(
                (track.at(5).navigation.depth_m, track.at(5 + pause).navigation.depth_m),
                (Some(12.5), None),
                "{pause}"
            );
        }
    }

    #[test]
    fn leak_and_battery_hold_as_long() {
        let housekeeping = Housekeeping { battery_v: Some(12.5), has_leak: Some(true) };
        let mut track = Track::default();
        track.tell_housekeeping(5, housekeeping);
        // A depth that goes on coming does not keep them.
        for ahead in 0..=40 {
            track.tell_navigation(5 + ahead, depth(12.5));
            let expected = if ahead <= 30 { housekeeping } else { Housekeeping::default() };
            assert_eq!(track.at(5 + ahead).housekeeping, expected, "{ahead}");
        }
        assert_eq!(StateColumn::Leak.text(&housekeeping.into()), "1");
        assert_eq!(StateColumn::Battery.text(&housekeeping.into()), "12.5");
    }

    #[test]
    fn a_magnetic_heading_is_none_of_the_contract() {
        use towmag::navigation::Heading;
        let magnetic =
            Navigation { heading: Some(Heading { deg: 94.5, is_magnetic: true }), ..Navigation::default() }.into();
        assert_eq!(StateColumn::Heading.value(&magnetic), None);
        assert_eq!(StateColumn::MagneticHeading.text(&magnetic), "94.5");
        assert_eq!(StateColumn::MagneticHeading.column(), None);
    }
}
