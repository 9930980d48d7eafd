//! A survey in plain words: how many contacts, which to dive for first, what else would have been found.

use std::cmp::Ordering;

use towmag_survey::{Contact, Estimate, Place, Survey};

use super::diagnosis::listed;
use super::number::{short, three_digits};
use crate::diagnosis::EffectOnScalar;

/// Magnetic moment of iron and steel objects, A m^2 a kilogram: 10^5 to 10^6 cgs units a ton (Breiner, Applications
/// manual for portable magnetometers, 1973), of which 1 is 10^-3 A m^2. Shape, steel and permanent magnetisation decide.
pub const IRON_AM2_PER_KG: [f64; 2] = [0.1, 1.0];

/// A contact is sure when it is no target in at most this share of cases: one dive in a hundred for nothing.
const SURE: f64 = 0.01;

/// What a diagnosis named in a recording, and what a survey made of it; `None` where nothing was named.
pub fn taken_off(recording: &str, effects: &[EffectOnScalar]) -> Option<String> {
    let (random, added): (Vec<&EffectOnScalar>, Vec<&EffectOnScalar>) =
        effects.iter().partition(|effect| effect.is_random);
    let what = |effects: Vec<&EffectOnScalar>, made: &str, then: &str| {
        let told = |effect: &&EffectOnScalar| format!("{} ({made}{} nT rms)", effect.title, two_digits(effect.rms_nt));
        let told: Vec<String> = effects.iter().map(told).collect();
        let told: Vec<&str> = told.iter().map(String::as_str).collect();
        (!told.is_empty()).then(|| format!("{}, {then}", listed(&told)))
    };
    let parts = [
        what(added, "", "taken off before contacts were looked for"),
        what(random, "noise of ", "whose rows count less"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("{recording}: host-sim diagnose names {}.", parts.join("; ")))
}

/// That a recording holds more than noise, of a cause that nobody knows, nT rms.
pub fn left_over(recording: &str, unexplained_nt: f64) -> String {
    format!(
        "{recording}: {} nT rms in the scalar are neither noise nor any known effect: contacts may be of them. host-sim diagnose says \
         where they are.",
        two_digits(unexplained_nt)
    )
}

/// In the order of what to dive for: the sure ones first, by the moment that is there at least, which is what iron is
/// counted by; then those whose moment is not known, by signal to noise; last those that may be nothing.
pub fn dive_order(contacts: &[Contact]) -> Vec<&Contact> {
    let mut order: Vec<&Contact> = contacts.iter().collect();
    order.sort_by(|a, b| {
        is_sure(b).cmp(&is_sure(a)).then_with(|| descending(least(a), least(b))).then_with(|| descending(a.snr, b.snr))
    });
    order
}

/// Whether it is hardly a false alarm.
pub fn is_sure(contact: &Contact) -> bool {
    contact.false_alarm_probability < SURE
}

fn least(contact: &Contact) -> f64 {
    contact.moment_am2.map_or(-1.0, |moment| moment.low)
}

fn descending(a: f64, b: f64) -> Ordering {
    b.total_cmp(&a)
}

/// Why the smallest moment is not there.
pub const NO_SMALLEST: &str = "not known without positions and altitude_m";

/// The answer: how many, and the first to dive for with all that a diver asks.
pub fn headline(survey: &Survey) -> String {
    let Some(first) = dive_order(&survey.contacts).first().copied() else {
        return match survey.smallest_moment_am2.filter(|moment| moment.is_finite()) {
            Some(moment) => format!(
                "No contact. Of iron of {} and more right below the track, 9 in 10 would have been found.",
                kilograms([moment, moment])
            ),
            None => format!("No contact. How small iron may be that would have been found is {NO_SMALLEST}."),
        };
    };
    let count = match survey.contacts.len() {
        1 => "1 contact".into(),
        count => format!("{count} contacts"),
    };
    if !is_sure(first) {
        return format!(
            "{count}, none of them sure. The likeliest is no.\u{a0}{}{}.",
            first.number,
            where_and_what(first)
        );
    }
    format!("{count}. Dive for no.\u{a0}{} first{}.", first.number, where_and_what(first))
}

/// ": 54° 10.1234′ N 7° 53.4567′ E, 6.1 m from the sensor, 20 to 300 kg of iron".
fn where_and_what(contact: &Contact) -> String {
    let said: Vec<String> = [
        contact.place.as_ref().map(position),
        contact.distance_m.map(|distance| format!("{} m from the sensor", two_digits(distance.value))),
        contact.moment_am2.map(|moment| format!("{} of iron", iron(&moment))),
    ]
    .into_iter()
    .flatten()
    .collect();
    if said.is_empty() { format!(": {} nT", signed(contact.peak_nt)) } else { format!(": {}", said.join(", ")) }
}

/// The mass of iron that a moment may stand for: "20 to 300 kg".
pub fn iron(moment_am2: &Estimate) -> String {
    kilograms([moment_am2.low, moment_am2.high])
}

/// The same of a range of moments, A m^2.
pub fn kilograms([low_am2, high_am2]: [f64; 2]) -> String {
    let (low_kg, high_kg) = (low_am2 / IRON_AM2_PER_KG[1], high_am2 / IRON_AM2_PER_KG[0]);
    let (scale, unit) = if high_kg < 1.0 {
        (1e3, "g")
    } else if low_kg >= 1000.0 {
        (1e-3, "t")
    } else {
        (1.0, "kg")
    };
    format!("{} to {}\u{a0}{unit}", two_digits(scale * low_kg), two_digits(scale * high_kg))
}

/// `54° 10.1234′ N 7° 53.4567′ E`.
pub fn position(place: &Place) -> String {
    latitude_longitude(place).join(" ")
}

/// Both by themselves.
pub fn latitude_longitude(place: &Place) -> [String; 2] {
    [degrees(place.latitude_deg, ["N", "S"]), degrees(place.longitude_deg, ["E", "W"])]
}

/// Degrees and minutes, to a fifth of a metre, in one piece.
fn degrees(value: f64, sides: [&str; 2]) -> String {
    let minutes_e4 = (value.abs() * 60.0 * 1e4).round();
    let whole = (minutes_e4 / 60e4).floor();
    let minutes = (minutes_e4 - whole * 60e4) / 1e4;
    format!("{whole}°\u{a0}{minutes:07.4}′\u{a0}{}", sides[usize::from(value < 0.0)])
}

/// A chance, as far as it can be believed: "under 0.1 %".
pub fn chance(probability: f64) -> String {
    match 100.0 * probability {
        percent if percent < 0.1 => "under 0.1 %".into(),
        percent if percent < 10.0 => format!("{percent:.1} %"),
        percent => format!("{percent:.0} %"),
    }
}

/// "6.1 (5.2 to 7.4)": a value with its interval.
pub fn with_interval(estimate: &Estimate) -> String {
    two_digits(estimate.value) + &interval(estimate)
}

/// " (5.2 to 7.4)".
pub fn interval(estimate: &Estimate) -> String {
    format!(" ({} to {})", two_digits(estimate.low), two_digits(estimate.high))
}

/// With a sign, three digits.
pub fn signed(value: f64) -> String {
    format!("{}{}", if value > 0.0 { "+" } else { "" }, three_digits(value))
}

/// As many digits as an interval bears that is never narrower than some percent.
pub fn two_digits(value: f64) -> String {
    if !(value.is_finite() && value != 0.0) {
        return short(value);
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-6..-3).contains(&exponent) {
        // Among weights and lengths a power of ten is read wrong.
        return format!("{value:.*}", (1 - exponent) as usize).trim_end_matches('0').replace('-', "−");
    }
    let unit = 10_f64.powi(exponent - 1);
    short((value / unit).round() * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_carry_over_at_sixty_minutes() {
        let place =
            |latitude_deg, longitude_deg| Place { latitude_deg, longitude_deg, easting_m: 0.0, northing_m: 0.0 };
        assert_eq!(position(&place(54.168_723, 7.5)), "54°~10.1234′~N 7°~30.0000′~E".replace('~', "\u{a0}"));
        assert_eq!(position(&place(-33.999_999_99, -0.008)), "34°~00.0000′~S 0°~00.4800′~W".replace('~', "\u{a0}"));
    }

    #[test]
    fn what_was_taken_off_and_what_only_counts_less_are_told_apart() {
        let effect =
            |title, is_random, rms_nt| EffectOnScalar { name: "n", title, probability: 0.9, is_random, rms_nt };
        assert_eq!(taken_off("a.csv", &[]), None);
        assert_eq!(
            taken_off("a.csv", &[effect("a delay", false, 1.23), effect("a dead zone", true, 0.52), effect("a step", false, 2.1)]),
            Some(
                "a.csv: host-sim diagnose names a delay (1.2 nT rms) and a step (2.1 nT rms), taken off before contacts were looked \
                 for; a dead zone (noise of 0.52 nT rms), whose rows count less."
                    .into()
            )
        );
    }

    #[test]
    fn iron_is_a_range_a_tenfold_wide_at_least() {
        let moment = |value, low, high| Estimate { value, low, high };
        assert_eq!(iron(&moment(20.0, 15.0, 26.0)), "15 to 260\u{a0}kg");
        assert_eq!(iron(&moment(0.01, 0.008, 0.02)), "8 to 200\u{a0}g");
        assert_eq!(iron(&moment(9000.0, 4000.0, 20_000.0)), "4 to 200\u{a0}t");
    }

    #[test]
    fn chances_and_digits() {
        assert_eq!([1e-9, 0.004, 0.31].map(chance), ["under 0.1 %", "0.4 %", "31 %"]);
        assert_eq!([6.149, 0.0312, 1234.0, 0.0, 9.96].map(two_digits), ["6.1", "0.031", "1,200", "0", "10"]);
        assert_eq!([0.00074, -5.1e-5].map(two_digits), ["0.00074", "−0.000051"]);
    }
}
