//! Values that stand for "missing", found among the readings.

use towmag_recording::{Column, FIELD_RANGE_NT};

use crate::draft::{Draft, DraftValues};
use crate::finding::Finding;
use crate::source::FindingKind;

/// A dummy lies this many times as far from the median as the farthest tenth of the values.
const FAR: f64 = 5.0;
/// No component of the Earth's field is as large, nT.
const NO_FIELD_NT: f64 = 90_000.0;

/// Values that stand for "missing" become missing; `asked` are some whatever they look like.
pub(crate) fn remove(draft: &mut Draft, asked: &[f64]) -> Vec<Finding> {
    let mut told: Vec<String> = Vec::new();
    let mut rows = 0;
    for column in &mut draft.columns {
        let DraftValues::Numbers(numbers) = &mut column.values else { continue };
        let is_field = column.known.is_some_and(is_field);
        let found = dummies(numbers, is_field, asked);
        for dummy in found {
            let hits = numbers.iter_mut().filter(|number| **number == dummy).map(|number| *number = f64::NAN).count();
            rows = rows.max(hits);
            told.push(format!("{dummy} in \"{}\" ({hits} times)", column.name));
        }
    }
    no_fix(draft, &mut told);
    if told.is_empty() {
        return Vec::new();
    }
    let more = if told.len() > 6 { format!(" and {} more", told.len() - 6) } else { String::new() };
    told.truncate(6);
    let text = format!("these values stand for \"missing\": {}{more}", told.join(", "));
    vec![Finding::new(FindingKind::Dummies, text).with("--dummy VALUE")]
}

fn is_field(column: Column) -> bool {
    Column::FLUX.contains(&column) || [Column::Scalar, Column::Scalar2, Column::Base].contains(&column)
}

/// Nines, powers of ten beyond all reason, and what was asked for: far from everything else in the column.
fn dummies(numbers: &[f64], is_field: bool, asked: &[f64]) -> Vec<f64> {
    let mut found: Vec<f64> = asked.iter().copied().filter(|dummy| numbers.contains(dummy)).collect();
    let mut candidates: Vec<f64> = Vec::new();
    for number in numbers {
        if is_a_dummy_by_its_digits(*number) && !candidates.contains(number) && candidates.len() < 16 {
            candidates.push(*number);
        }
    }
    candidates.retain(|candidate| !found.contains(candidate));
    if candidates.is_empty() {
        return found;
    }
    let mut rest: Vec<f64> =
        numbers.iter().copied().filter(|number| number.is_finite() && !candidates.contains(number)).collect();
    if rest.is_empty() {
        found.extend(candidates.iter().filter(|_| is_field));
        return found;
    }
    rest.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| rest[((rest.len() - 1) as f64 * share) as usize];
    let (median, spread) = (at(0.5), (at(0.99) - at(0.01)).max(at(0.5).abs() * 1e-3).max(1e-9));
    let is_far = |dummy: &f64| (dummy - median).abs() > FAR * spread || is_field && dummy.abs() > NO_FIELD_NT;
    found.extend(candidates.into_iter().filter(is_far));
    found
}

/// -99999, 9999.99, 1e32, -1e30, -32768.
fn is_a_dummy_by_its_digits(number: f64) -> bool {
    let size = number.abs();
    if size >= 1e30 || number == -32_768.0 {
        return number.is_finite();
    }
    if !(99.0..1e12).contains(&size) {
        return false;
    }
    // All digits nine, before and after the point: a whole number of nines, but for the last digit.
    let digits = format!("{size}");
    let plain: Vec<u8> = digits.bytes().filter(|byte| *byte != b'.').collect();
    plain.len() >= 3 && plain.iter().all(|byte| *byte == b'9')
}

/// A receiver without a fix writes zeros: both at once, where the track is elsewhere.
fn no_fix(draft: &mut Draft, told: &mut Vec<String>) {
    let (Some(latitude), Some(longitude)) = (draft.numbers(Column::Latitude), draft.numbers(Column::Longitude)) else {
        return;
    };
    let zero: Vec<bool> = latitude.iter().zip(longitude).map(|(lat, lon)| *lat == 0.0 && *lon == 0.0).collect();
    let elsewhere = latitude.iter().zip(longitude).any(|(lat, lon)| lat.abs() > 1.0 || lon.abs() > 1.0);
    let hits = zero.iter().filter(|zero| **zero).count();
    if hits == 0 || !elsewhere {
        return;
    }
    for column in [Column::Latitude, Column::Longitude] {
        if let Some(DraftValues::Numbers(numbers)) = draft.column_mut(column).map(|column| &mut column.values) {
            numbers.iter_mut().zip(&zero).filter(|(_, zero)| **zero).for_each(|(number, _)| *number = f64::NAN);
        }
    }
    told.push(format!("a position of 0, 0 ({hits} times)"));
}

/// Rows that lack a reading which others have.
pub(crate) fn invalidate_missing(draft: &mut Draft) {
    let sensors = Column::FLUX.into_iter().chain([Column::Scalar]);
    let there: Vec<Vec<bool>> = sensors
        .filter_map(|column| draft.numbers(column))
        .filter(|numbers| numbers.iter().any(|number| number.is_finite()))
        .map(|numbers| numbers.iter().map(|number| number.is_finite()).collect())
        .collect();
    for (row, invalid) in draft.invalid.iter_mut().enumerate() {
        *invalid |= there.iter().any(|there| !there[row]);
    }
}

/// Rows whose scalar or fluxgate is none that the Earth has: how many were made invalid.
pub(crate) fn invalidate_out_of_range(draft: &mut Draft) -> usize {
    let scalar = draft.numbers(Column::Scalar).map(<[f64]>::to_vec);
    let flux = draft.flux().map(|axes| axes.map(<[f64]>::to_vec));
    let mut count = 0;
    for row in 0..draft.len() {
        let bad_scalar =
            scalar.as_ref().is_some_and(|scalar| scalar[row].is_finite() && !FIELD_RANGE_NT.contains(&scalar[row]));
        let bad_flux = flux.as_ref().is_some_and(|axes| {
            let size = axes.iter().map(|axis| axis[row] * axis[row]).sum::<f64>().sqrt();
            size.is_finite() && !FIELD_RANGE_NT.contains(&size)
        });
        if (bad_scalar || bad_flux) && !draft.invalid[row] {
            draft.invalid[row] = true;
            count += 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dummies_have_their_digits_and_stand_far_off() {
        let mut numbers: Vec<f64> = (0..200).map(|row| 51_000.0 + f64::from(row % 17)).collect();
        for (at, dummy) in [-99_999.0, 99_999.0, 1e32, -9999.99].into_iter().enumerate() {
            numbers[at * 10] = dummy;
        }
        let mut found = dummies(&numbers, true, &[]);
        found.sort_by(f64::total_cmp);
        assert_eq!(found, [-99_999.0, -9999.99, 99_999.0, 1e32]);
        let wide: Vec<f64> = (0..3000).map(f64::from).collect();
        assert!(dummies(&wide, false, &[]).is_empty(), "999 is one of many");
        assert_eq!(dummies(&wide, false, &[17.0]), [17.0]);
        assert_eq!(dummies(&[99_999.0; 20], true, &[]), [99_999.0]);
    }
}
