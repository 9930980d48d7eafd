//! Standard deviation by heading: one set of coefficients may suit one heading and not another.

use super::running_std::RunningStd;

/// The eight sectors of the compass.
pub const SECTORS: [&str; 8] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];

/// Standard deviation in each sector, in the order of [`SECTORS`].
pub type HeadingStd = [SectorStd; 8];

/// Standard deviation of the samples taken on the headings of one sector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectorStd {
    /// Population standard deviation, nT; not meaningful when `count` is zero.
    pub std_nt: f64,
    /// Number of samples.
    pub count: u64,
}

/// Running standard deviation in the eight sectors of the compass, each 45 degrees wide and centred on its name.
#[derive(Clone, Copy, Debug, Default)]
pub struct HeadingSectors([RunningStd; 8]);

impl HeadingSectors {
    /// Take in a value measured on `heading_deg`, in any turn of the circle; left out when that is not finite.
    pub fn push(&mut self, heading_deg: f64, value: f64) {
        if heading_deg.is_finite() {
            self.0[Self::sector(heading_deg)].push(value);
        }
    }

    /// Which sector of [`SECTORS`] a finite heading is in.
    pub(super) fn sector(heading_deg: f64) -> usize {
        // The remainder may round up to 360 itself, hence the second one.
        ((heading_deg + 22.5).rem_euclid(360.0) / 45.0) as usize % 8
    }

    /// Standard deviation and number of samples in each sector.
    pub fn std(&self) -> HeadingStd {
        self.0.map(|sector| SectorStd {
            std_nt: if sector.count() > 0 { sector.std() } else { 0.0 },
            count: sector.count(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_fall_into_their_sectors() {
        for (heading_deg, sector) in
            [(0.0, 0), (22.4, 0), (22.6, 1), (337.6, 0), (359.9, 0), (-1e-18, 0), (-90.0, 6), (540.0, 4), (315.0, 7)]
        {
            let mut sectors = HeadingSectors::default();
            sectors.push(heading_deg, 1.0);
            let counts = sectors.std().map(|sector| sector.count);
            assert_eq!((counts[sector], counts.iter().sum::<u64>()), (1, 1), "{heading_deg}");
        }
    }

    #[test]
    fn each_sector_has_its_own_spread() {
        let mut sectors = HeadingSectors::default();
        for i in 0..800 {
            let sign = if (i / 8) % 2 == 0 { 1.0 } else { -1.0 };
            sectors.push(f64::from(i % 8) * 45.0, sign * f64::from(1 + i % 8));
        }
        sectors.push(f64::NAN, 1e9);
        for (i, sector) in sectors.std().iter().enumerate() {
            assert!((sector.std_nt - (1 + i) as f64).abs() < 1e-12 && sector.count == 100);
        }
    }
}
