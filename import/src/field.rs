//! The Earth's field as sensors have it.

/// From the weakest place to the strongest, with room for what stands near the sensor, nT.
pub(crate) const EARTH_NT: std::ops::RangeInclusive<f64> = 15_000.0..=90_000.0;

/// Magnitude of each row of a vector; not a number where an axis is none.
pub(crate) fn magnitudes([x, y, z]: [&[f64]; 3]) -> Vec<f64> {
    x.iter().zip(y).zip(z).map(|((x, y), z)| (x * x + y * y + z * z).sqrt()).collect()
}
