//! What `diagnose` names in a recording is taken off its scalar before the survey: an effect of the sensor is no contact.

use towmag_survey::Tow;

use super::diagnosed::Diagnosed;
use super::tows::Read;
use crate::diagnosis::{DiagnoseSettings, NamedChange, Prepared, named_change};
use crate::error::HostError;
use crate::recording::Input;

/// From this probability on an effect is taken off: it is likelier at work than not.
const LEAST_PROBABILITY: f64 = 0.5;

/// Diagnose each recording, and take what is named off its tow.
pub(super) fn take_off(read: &mut Read) {
    for (input, (tow, diagnosed)) in read.inputs.iter().zip(read.tows.iter_mut().zip(&mut read.diagnosed)) {
        // A recording that can be surveyed but not diagnosed is surveyed as it is.
        match diagnose(input) {
            Ok(change) => {
                take_off_tow(tow, &change);
                *diagnosed =
                    Diagnosed { effects: change.effects, unexplained_nt: change.unexplained_nt, refusal: None };
            }
            Err(error) => diagnosed.refusal = Some(error.to_string()),
        }
    }
}

fn diagnose(input: &Input) -> Result<NamedChange, HostError> {
    let settings = DiagnoseSettings::default();
    let table = Prepared::read_with(input, &settings.library.columns())?;
    named_change(&table, &settings, LEAST_PROBABILITY)
}

/// A diagnosis leaves out the rows without a time.
fn take_off_tow(tow: &mut Tow, change: &NamedChange) {
    let rows: Vec<usize> = (0..tow.len()).filter(|&row| !tow.time_s[row].is_nan()).collect();
    rows.iter().zip(&change.scalar_nt).for_each(|(&row, nt)| tow.scalar_nt[row] -= nt);
    if change.effects.iter().any(|effect| effect.is_random) {
        let mut variance_nt2 = vec![0.0; tow.len()];
        rows.iter().zip(&change.variance_nt2).for_each(|(&row, nt2)| variance_nt2[row] = *nt2);
        tow.scalar_variance_nt2 = Some(variance_nt2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::EffectOnScalar;

    #[test]
    fn rows_without_a_time_are_left_as_they_are() {
        let effect = |is_random| EffectOnScalar { name: "a", title: "a", probability: 1.0, is_random, rms_nt: 1.0 };
        let mut tow =
            Tow { time_s: vec![0.0, f64::NAN, 0.2], scalar_nt: vec![50_000.0, f64::NAN, 50_002.0], ..Tow::default() };
        let mut change = NamedChange {
            effects: vec![effect(false)],
            scalar_nt: vec![1.0, 2.0],
            variance_nt2: vec![0.0, 4.0],
            unexplained_nt: None,
        };
        take_off_tow(&mut tow, &change);
        assert_eq!((tow.scalar_nt[0], tow.scalar_nt[2], tow.scalar_variance_nt2.clone()), (49_999.0, 50_000.0, None));
        assert!(tow.scalar_nt[1].is_nan());
        change.effects.push(effect(true));
        take_off_tow(&mut tow, &change);
        assert_eq!(tow.scalar_variance_nt2, Some(vec![0.0, 0.0, 4.0]));
    }
}
