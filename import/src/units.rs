//! Units, as people write them, and their factors.

/// What a unit measures, with the unit of this project's columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dimension {
    /// nT
    Field,
    /// s
    Time,
    /// m
    Length,
    /// deg
    Angle,
    /// degC
    Temperature,
    /// A
    Current,
    /// V
    Voltage,
    /// m/s
    Speed,
    /// Hz
    Frequency,
    /// None.
    Number,
}

/// A unit that is known: value in this project's unit = value * factor + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// To this project's unit of that dimension.
    pub factor: f64,
    /// Added after the factor: Kelvin and Fahrenheit.
    pub offset: f64,
}

const FOOT_M: f64 = 0.3048;
const KNOT_M_PER_S: f64 = 1852.0 / 3600.0;

use Dimension::{Angle, Current, Field, Frequency, Length, Number, Speed, Temperature, Time, Voltage};

/// Spellings in lower case (of those that differ by case alone, see [`of`]), without blanks and degree signs turned to `deg`.
const UNITS: &[(&str, Dimension, f64)] = &[
    ("nt", Field, 1.0),
    ("nanotesla", Field, 1.0),
    ("nanoteslas", Field, 1.0),
    ("gamma", Field, 1.0),
    ("gammas", Field, 1.0),
    ("pt", Field, 1e-3),
    ("picotesla", Field, 1e-3),
    ("ut", Field, 1e3),
    ("\u{b5}t", Field, 1e3),
    ("\u{3bc}t", Field, 1e3),
    ("microtesla", Field, 1e3),
    ("microteslas", Field, 1e3),
    ("mt", Field, 1e6),
    ("t", Field, 1e9),
    ("tesla", Field, 1e9),
    ("g", Field, 1e5),
    ("gauss", Field, 1e5),
    ("mg", Field, 1e2),
    ("mgauss", Field, 1e2),
    ("milligauss", Field, 1e2),
    ("s", Time, 1.0),
    ("sec", Time, 1.0),
    ("secs", Time, 1.0),
    ("second", Time, 1.0),
    ("seconds", Time, 1.0),
    ("ms", Time, 1e-3),
    ("msec", Time, 1e-3),
    ("millisecond", Time, 1e-3),
    ("milliseconds", Time, 1e-3),
    ("us", Time, 1e-6),
    ("\u{b5}s", Time, 1e-6),
    ("\u{3bc}s", Time, 1e-6),
    ("usec", Time, 1e-6),
    ("microseconds", Time, 1e-6),
    ("ns", Time, 1e-9),
    ("nanoseconds", Time, 1e-9),
    ("min", Time, 60.0),
    ("minutes", Time, 60.0),
    ("h", Time, 3600.0),
    ("hours", Time, 3600.0),
    ("days", Time, 86_400.0),
    ("m", Length, 1.0),
    ("metre", Length, 1.0),
    ("metres", Length, 1.0),
    ("meter", Length, 1.0),
    ("meters", Length, 1.0),
    ("cm", Length, 1e-2),
    ("mm", Length, 1e-3),
    ("km", Length, 1e3),
    ("ft", Length, FOOT_M),
    ("feet", Length, FOOT_M),
    ("fathoms", Length, 6.0 * FOOT_M),
    ("deg", Angle, 1.0),
    ("degree", Angle, 1.0),
    ("degrees", Angle, 1.0),
    ("decimaldegrees", Angle, 1.0),
    ("decimaldegree", Angle, 1.0),
    ("dd", Angle, 1.0),
    ("rad", Angle, 57.295_779_513_082_32),
    ("radians", Angle, 57.295_779_513_082_32),
    ("arcmin", Angle, 1.0 / 60.0),
    ("1e-7deg", Angle, 1e-7),
    ("degc", Temperature, 1.0),
    ("c", Temperature, 1.0),
    ("celsius", Temperature, 1.0),
    ("degf", Temperature, 5.0 / 9.0),
    ("k", Temperature, 1.0),
    ("kelvin", Temperature, 1.0),
    ("a", Current, 1.0),
    ("amp", Current, 1.0),
    ("amps", Current, 1.0),
    ("ma", Current, 1e-3),
    ("v", Voltage, 1.0),
    ("volt", Voltage, 1.0),
    ("volts", Voltage, 1.0),
    ("mv", Voltage, 1e-3),
    ("m/s", Speed, 1.0),
    ("ms-1", Speed, 1.0),
    ("m_per_s", Speed, 1.0),
    ("kn", Speed, KNOT_M_PER_S),
    ("kt", Speed, KNOT_M_PER_S),
    ("kts", Speed, KNOT_M_PER_S),
    ("knots", Speed, KNOT_M_PER_S),
    ("km/h", Speed, 1.0 / 3.6),
    ("kmh", Speed, 1.0 / 3.6),
    ("hz", Frequency, 1.0),
    ("1", Number, 1.0),
    ("%", Number, 1.0),
    ("-", Number, 1.0),
    ("counts", Number, 1.0),
    ("hh:mm:ss", Number, 1.0),
    ("hh:mm:ss.s", Number, 1.0),
    ("hh:mm:ss.sss", Number, 1.0),
    ("yyyy/mm/dd", Number, 1.0),
    ("yyyy-mm-dd", Number, 1.0),
    ("dd.mm.yyyy", Number, 1.0),
    ("utc", Number, 1.0),
];

/// What a unit means; `None` when nobody knows it.
pub(crate) fn of(unit: &str) -> Option<Unit> {
    let trimmed = unit.trim().trim_matches(['[', ']', '(', ')', '.']);
    let spelled: String = trimmed.replace(['\u{b0}', '\u{ba}'], "deg").split_whitespace().collect();
    let lower = spelled.to_lowercase();
    let (_, dimension, factor) = *UNITS.iter().find(|(name, ..)| *name == lower)?;
    let offset = match lower.as_str() {
        "k" | "kelvin" => -273.15,
        "degf" => -32.0 * 5.0 / 9.0,
        _ => 0.0,
    };
    Some(Unit { dimension, factor, offset })
}

/// Whether a field of a header is a unit and no name.
pub(crate) fn is_unit(field: &str) -> bool {
    of(field).is_some()
}

/// The unit at the end of a name: `depth_m`, `scalar_nT`, `time_ms`. One letter may as well be the end of a name (`flux_a`,
/// `mag_c`), so that only `m` and `s` count.
pub(crate) fn suffix(name: &str) -> Option<Unit> {
    let (stem, last) = name.rsplit_once(['_', ' '])?;
    let lower = last.to_lowercase();
    if lower == "s" && stem.ends_with("_per") {
        return of("m/s");
    }
    (last.len() > 1 || ["m", "s"].contains(&lower.as_str())).then(|| of(last)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_many_spellings() {
        for (unit, dimension, factor) in [
            ("nT", Field, 1.0),
            (" [\u{b5}T] ", Field, 1e3),
            ("Gauss", Field, 1e5),
            ("ms", Time, 1e-3),
            ("\u{b0}", Angle, 1.0),
            ("\u{b0}C", Temperature, 1.0),
            ("Decimal Degrees", Angle, 1.0),
            ("kn", Speed, 1852.0 / 3600.0),
        ] {
            let found = of(unit).unwrap();
            assert_eq!((found.dimension, found.factor), (dimension, factor), "{unit}");
        }
        assert!(of("leg").is_none() && !is_unit("mag"));
        let kelvin = of("K").unwrap();
        assert_eq!(293.15 * kelvin.factor + kelvin.offset, 20.0);
        assert!((68.0 * of("\u{b0}F").unwrap().factor + of("degF").unwrap().offset - 20.0).abs() < 1e-12);
    }

    #[test]
    fn a_name_may_end_in_its_unit() {
        assert_eq!(suffix("time_ms").map(|unit| unit.factor), Some(1e-3));
        assert!(suffix("flux_a").is_none() && suffix("mag_1_uc").is_none() && suffix("depth_m").is_some());
        assert_eq!(suffix("speed_m_per_s").map(|unit| unit.dimension), Some(Speed));
    }
}
