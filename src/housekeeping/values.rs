//! What is told, and how it looks in bytes.

use crate::bytes::{Put, Take, put_some, take_some};

/// How the body itself is.
///
/// In bytes, the field in brackets only when its flag is set: `flags u8, [0: battery_v f32]`; flag 1 tells that a leak
/// contact is fitted, flag 2 that it is wet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Housekeeping {
    /// Voltage of the battery, V, the mean of a second; `None` where it is not measured.
    pub battery_v: Option<f32>,
    /// Whether there is water at the leak contact; `None` where none is fitted.
    pub has_leak: Option<bool>,
}

const BATTERY: u8 = 1 << 0;
const LEAK_FITTED: u8 = 1 << 1;
const LEAK: u8 = 1 << 2;
const KNOWN_FLAGS: u8 = BATTERY | LEAK_FITTED | LEAK;

impl Housekeeping {
    /// Longest form in bytes.
    pub const MAX_LEN: usize = 5;

    pub(crate) fn put(&self, put: &mut Put<'_>) {
        put.u8(self.flags());
        put_some(self.battery_v, |battery_v| put.f32(battery_v));
    }

    pub(crate) fn take(take: &mut Take<'_>) -> Option<Self> {
        let flags = take.u8()?;
        let has = |flag| flags & flag != 0;
        if flags & !KNOWN_FLAGS != 0 || (has(LEAK) && !has(LEAK_FITTED)) {
            return None;
        }
        let battery_v = take_some(has(BATTERY), || take.f32())?;
        Some(Self { battery_v, has_leak: has(LEAK_FITTED).then_some(has(LEAK)) })
    }

    fn flags(&self) -> u8 {
        let flag = |is_set: bool, flag| if is_set { flag } else { 0 };
        flag(self.battery_v.is_some(), BATTERY)
            | flag(self.has_leak.is_some(), LEAK_FITTED)
            | flag(self.has_leak == Some(true), LEAK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back() {
        for battery_v in [None, Some(12.34)] {
            for has_leak in [None, Some(false), Some(true)] {
                let housekeeping = Housekeeping { battery_v, has_leak };
                let mut bytes = [0; Housekeeping::MAX_LEN];
                let mut put = Put::new(&mut bytes);
                housekeeping.put(&mut put);
                let len = put.finish().unwrap();
                assert_eq!(Housekeeping::take(&mut Take(&bytes[..len])), Some(housekeeping));
            }
        }
        assert_eq!(Housekeeping::take(&mut Take(&[LEAK])), None, "wet, and not fitted");
        assert_eq!(Housekeeping::take(&mut Take(&[1 << 3])), None);
        assert_eq!(Housekeeping::take(&mut Take(&[BATTERY, 0, 0])), None);
    }
}
