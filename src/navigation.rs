//! Where the body is: depth, altitude, position and heading, for log and cable. The core never sees them.
//!
//! ```text
//! third UART  -> NmeaParser -> NavigationReport --+
//!                                                 +-> Navigator -> event of the log, frame of the cable
//! scalar sensor's own channels -> EpochMarks -----+
//! ```

use crate::bytes::{Put, Take, put_some, take_some};
use heapless::spsc::Queue;

/// A value that nothing has renewed for longer than this is no longer known, s.
pub const LONGEST_AGE_S: u32 = 3;

const LONGEST_AGE_US: i32 = LONGEST_AGE_S as i32 * 1_000_000;

/// Where the body is, as far as it is known.
///
/// In bytes, fields in brackets only when their flag is set: `flags u8, [0: depth_m f32], [1: altitude_m f32], [2:
/// latitude i32, longitude i32, fix u8], [3: heading_deg f32]`; flag 4 tells that the heading is magnetic.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Navigation {
    /// Depth below the surface, m, positive down.
    pub depth_m: Option<f32>,
    /// Height above the bottom, m.
    pub altitude_m: Option<f32>,
    /// Position of the antenna, or of the body where a ship's system sends that.
    pub position: Option<Position>,
    /// Where the bow points to.
    pub heading: Option<Heading>,
}

/// A position, WGS 84.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Latitude, 1e-7 degrees, positive to the north.
    pub latitude_e7: i32,
    /// Longitude, 1e-7 degrees, positive to the east.
    pub longitude_e7: i32,
    /// Quality of the fix as GGA has it: 1 GPS, 2 differential, 4 RTK, 5 float RTK, 6 estimated, 7 typed, 8 simulated.
    pub fix: u8,
}

/// A heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading {
    /// From north by east, degrees, 0 to 360.
    pub deg: f32,
    /// North is the compass's own, and nothing told how far that is from true north.
    pub is_magnetic: bool,
}

/// What a sensor has told, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationReport {
    /// What it has told.
    pub navigation: Navigation,
    /// Timer at the first byte of the sentence, microseconds.
    pub stamp_us: u32,
}

/// Reports on their way to the log: those of some 0.2 s, until the epoch that they belong to is there.
pub type NavigationQueue = Queue<NavigationReport, 32>;

const DEPTH: u8 = 1 << 0;
const ALTITUDE: u8 = 1 << 1;
const POSITION: u8 = 1 << 2;
const HEADING: u8 = 1 << 3;
const MAGNETIC: u8 = 1 << 4;
const KNOWN_FLAGS: u8 = DEPTH | ALTITUDE | POSITION | HEADING | MAGNETIC;

impl Navigation {
    /// Longest form in bytes.
    pub const MAX_LEN: usize = 22;

    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    pub(crate) fn put(&self, put: &mut Put<'_>) {
        put.u8(self.flags());
        put_some(self.depth_m, |depth_m| put.f32(depth_m));
        put_some(self.altitude_m, |altitude_m| put.f32(altitude_m));
        put_some(self.position, |position| {
            put.i32(position.latitude_e7);
            put.i32(position.longitude_e7);
            put.u8(position.fix);
        });
        put_some(self.heading, |heading| put.f32(heading.deg));
    }

    pub(crate) fn take(take: &mut Take<'_>) -> Option<Self> {
        let flags = take.u8()?;
        let has = |flag| flags & flag != 0;
        if flags & !KNOWN_FLAGS != 0 || (has(MAGNETIC) && !has(HEADING)) {
            return None;
        }
        Some(Self {
            depth_m: take_some(has(DEPTH), || take.f32())?,
            altitude_m: take_some(has(ALTITUDE), || take.f32())?,
            position: take_some(has(POSITION), || {
                Some(Position { latitude_e7: take.i32()?, longitude_e7: take.i32()?, fix: take.u8()? })
            })?,
            heading: take_some(has(HEADING), || Some(Heading { deg: take.f32()?, is_magnetic: has(MAGNETIC) }))?,
        })
    }

    fn flags(&self) -> u8 {
        let flag = |is_set: bool, flag| if is_set { flag } else { 0 };
        flag(self.depth_m.is_some(), DEPTH)
            | flag(self.altitude_m.is_some(), ALTITUDE)
            | flag(self.position.is_some(), POSITION)
            | flag(self.heading.is_some(), HEADING)
            | flag(self.heading.is_some_and(|heading| heading.is_magnetic), MAGNETIC)
    }
}

/// How much a value counts against another that is as young.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// A channel of the scalar sensor, or a magnetic heading.
    Second,
    /// A sentence of a sensor of its own.
    First,
}

#[derive(Clone, Copy, Debug)]
struct Kept<T> {
    value: T,
    stamp_us: u32,
    rank: Rank,
    is_news: bool,
}

/// The latest of each value, from whatever sensor it came.
#[derive(Clone, Debug, Default)]
pub struct Navigator {
    depth_m: Option<Kept<f32>>,
    altitude_m: Option<Kept<f32>>,
    position: Option<Kept<Position>>,
    heading: Option<Kept<Heading>>,
}

impl Navigator {
    /// Take over what a sensor on the third UART has told.
    pub fn take(&mut self, report: &NavigationReport) {
        let NavigationReport { navigation, stamp_us } = *report;
        let Navigation { depth_m, altitude_m, position, heading } = navigation;
        offer(&mut self.depth_m, depth_m, stamp_us, Rank::First);
        offer(&mut self.altitude_m, altitude_m, stamp_us, Rank::First);
        offer(&mut self.position, position, stamp_us, Rank::First);
        let rank = if heading.is_some_and(|heading| heading.is_magnetic) { Rank::Second } else { Rank::First };
        offer(&mut self.heading, heading, stamp_us, rank);
    }

    /// Take over what the scalar sensor has told beside the field: it counts where no sensor of its own tells the same.
    pub fn take_channels(&mut self, depth_m: Option<f32>, altitude_m: Option<f32>, stamp_us: u32) {
        offer(&mut self.depth_m, depth_m, stamp_us, Rank::Second);
        offer(&mut self.altitude_m, altitude_m, stamp_us, Rank::Second);
    }

    /// What is known at an epoch. What has become too old is forgotten: to be called at every epoch, as stamps wrap.
    pub fn at(&mut self, instant_us: u32) -> Navigation {
        Navigation {
            depth_m: fresh(&mut self.depth_m, instant_us),
            altitude_m: fresh(&mut self.altitude_m, instant_us),
            position: fresh(&mut self.position, instant_us),
            heading: fresh(&mut self.heading, instant_us),
        }
    }

    /// What has come since the last call and is still known.
    pub fn news(&mut self) -> Navigation {
        Navigation {
            depth_m: news(&mut self.depth_m),
            altitude_m: news(&mut self.altitude_m),
            position: news(&mut self.position),
            heading: news(&mut self.heading),
        }
    }
}

fn offer<T>(place: &mut Option<Kept<T>>, value: Option<T>, stamp_us: u32, rank: Rank) {
    if let Some(value) = value
        && place.as_ref().is_none_or(|kept| kept.rank <= rank)
    {
        *place = Some(Kept { value, stamp_us, rank, is_news: true });
    }
}

/// A value may have come a little after the instant.
fn fresh<T: Copy>(place: &mut Option<Kept<T>>, instant_us: u32) -> Option<T> {
    *place = place.take().filter(|kept| instant_us.wrapping_sub(kept.stamp_us) as i32 <= LONGEST_AGE_US);
    place.as_ref().map(|kept| kept.value)
}

fn news<T: Copy>(place: &mut Option<Kept<T>>) -> Option<T> {
    let kept = place.as_mut()?;
    core::mem::take(&mut kept.is_news).then_some(kept.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depth(depth_m: f32, stamp_us: u32) -> NavigationReport {
        NavigationReport { navigation: Navigation { depth_m: Some(depth_m), ..Navigation::default() }, stamp_us }
    }

    #[test]
    fn a_value_is_news_once_and_known_for_three_seconds() {
        let mut navigator = Navigator::default();
        // Across the wrap of the timer.
        let begin_us = u32::MAX - 1_000_000;
        navigator.take(&depth(12.5, begin_us));
        assert_eq!(navigator.at(begin_us.wrapping_sub(90_000)).depth_m, Some(12.5), "it came after the instant");
        assert_eq!(navigator.news().depth_m, Some(12.5));
        assert!(navigator.news().is_empty());
        assert_eq!(navigator.at(begin_us.wrapping_add(3_000_000)).depth_m, Some(12.5));
        assert!(navigator.at(begin_us.wrapping_add(3_000_001)).is_empty());
        assert!(navigator.at(begin_us).is_empty(), "what is forgotten does not come back when the timer has wrapped");
    }

    #[test]
    fn a_sensor_of_its_own_goes_before_the_channels_of_the_scalar_sensor_while_it_talks() {
        let mut navigator = Navigator::default();
        navigator.take(&depth(12.5, 0));
        navigator.take_channels(Some(13.0), Some(4.0), 1_000_000);
        let both = navigator.at(1_000_000);
        assert_eq!((both.depth_m, both.altitude_m), (Some(12.5), Some(4.0)));
        navigator.at(3_500_000);
        navigator.take_channels(Some(13.0), None, 3_500_000);
        assert_eq!(navigator.at(3_500_000).depth_m, Some(13.0));
        navigator.take(&depth(12.6, 3_600_000));
        assert_eq!(navigator.at(3_600_000).depth_m, Some(12.6));
    }

    #[test]
    fn a_true_heading_goes_before_a_magnetic_one() {
        let told = |deg, is_magnetic, stamp_us| {
            let heading = Some(Heading { deg, is_magnetic });
            NavigationReport { navigation: Navigation { heading, ..Navigation::default() }, stamp_us }
        };
        let mut navigator = Navigator::default();
        navigator.take(&told(91.0, true, 0));
        navigator.take(&told(95.0, false, 10));
        navigator.take(&told(91.0, true, 20));
        assert_eq!(navigator.at(20).heading, Some(Heading { deg: 95.0, is_magnetic: false }));
    }

    #[test]
    fn bytes_come_back() {
        let position = Some(Position { latitude_e7: -337_654_321, longitude_e7: 1_512_345_678, fix: 4 });
        let heading = Some(Heading { deg: 359.5, is_magnetic: true });
        let all = Navigation { depth_m: Some(12.5), altitude_m: Some(3.25), position, heading };
        for navigation in [all, Navigation::default(), Navigation { depth_m: None, heading: None, ..all }] {
            let mut bytes = [0; Navigation::MAX_LEN];
            let mut put = Put::new(&mut bytes);
            navigation.put(&mut put);
            let len = put.finish().unwrap();
            assert_eq!(Navigation::take(&mut Take(&bytes[..len])), Some(navigation));
            assert!(navigation != all || len == Navigation::MAX_LEN);
        }
        assert_eq!(Navigation::take(&mut Take(&[MAGNETIC])), None);
        assert_eq!(Navigation::take(&mut Take(&[1 << 5])), None);
    }
}
