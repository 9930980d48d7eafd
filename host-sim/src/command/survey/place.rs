//! Whether a recording can have been made where its positions say, by the Earth's field there.

use statrs::statistics::{Data, OrderStatistics};
use towmag_import::earth_model::{TOLERANCE, north_east_down_nt, total_nt};
use towmag_survey::Tow;
use world_magnetic_model::time::{Date, Month};

/// What is odd about the positions, a sentence; `None` where they may be right, or there are none.
pub(super) fn doubt(tow: &Tow) -> Option<String> {
    let read_nt = median_of(&tow.scalar_nt, &tow.is_usable)?;
    let latitude_deg = median_of(tow.latitude_deg.as_ref()?, &tow.is_usable)?;
    let longitude_deg = median_of(tow.longitude_deg.as_ref()?, &tow.is_usable)?;
    let there_nt = field_nt([latitude_deg, longitude_deg])?;
    let may_be = |nt: &f64| (read_nt / nt - 1.0).abs() <= TOLERANCE;
    if may_be(&there_nt) {
        return None;
    }
    let exchanged_nt = field_nt([longitude_deg, latitude_deg]).filter(may_be);
    let hint = match exchanged_nt {
        Some(nt) => format!("with latitude and longitude exchanged it has {nt:.0} nT, so they may be"),
        None => "signs, and columns exchanged, are where to look".into(),
    };
    Some(format!(
        "{}: the scalar reads {read_nt:.0} nT, and the world magnetic model has {there_nt:.0} nT at its positions; {hint}.",
        tow.name
    ))
}

fn median_of(values: &[f64], is_usable: &[bool]) -> Option<f64> {
    let known: Vec<f64> =
        values.iter().zip(is_usable).filter(|(x, is_usable)| **is_usable && x.is_finite()).map(|(x, _)| *x).collect();
    (!known.is_empty()).then(|| Data::new(known).median())
}

/// In the middle of the model's years, at the surface.
fn field_nt(place_deg: [f64; 2]) -> Option<f64> {
    let day = Date::from_calendar_date(2027, Month::July, 1).ok()?;
    north_east_down_nt(place_deg, 0.0, day).ok().map(total_nt)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 100 readings in one place.
    fn tow(scalar_nt: f64, [latitude_deg, longitude_deg]: [f64; 2]) -> Tow {
        Tow {
            name: "rec.csv".into(),
            is_usable: vec![true; 100],
            scalar_nt: vec![scalar_nt; 100],
            latitude_deg: Some(vec![latitude_deg; 100]),
            longitude_deg: Some(vec![longitude_deg; 100]),
            ..Tow::default()
        }
    }

    #[test]
    fn positions_of_another_field_are_doubted() {
        // The German Bight, 49,900 nT in 2025.
        assert_eq!(doubt(&tow(49_900.0, [54.1, 8.2])), None);
        assert_eq!(doubt(&tow(48_000.0, [54.1, 8.2])), None);
        let exchanged = doubt(&tow(49_900.0, [8.2, 54.1])).expect("the Indian Ocean");
        assert!(exchanged.contains("latitude and longitude exchanged it has 50"), "{exchanged}");
        let elsewhere = doubt(&tow(30_000.0, [54.1, 8.2])).expect("no such field in Europe");
        assert!(elsewhere.contains("signs"), "{elsewhere}");
        assert_eq!(doubt(&Tow { latitude_deg: None, ..tow(30_000.0, [54.1, 8.2]) }), None);
    }
}
