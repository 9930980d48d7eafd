//! Values of the parameters at which a formula must have a value: the file's own, and the ends of every range.

use towmag_effect_file::{EffectFile, Parameter};

pub(super) fn trial_values(file: &EffectFile) -> Vec<Vec<f64>> {
    let all = |value: fn(&Parameter) -> f64| file.parameters.iter().map(value).collect::<Vec<f64>>();
    let (low, high, own) = (all(|p| p.low), all(|p| p.high), all(|p| p.default));
    let middle = all(|p| 0.5 * (p.low + p.high));
    let mut values = vec![own.clone(), middle, low.clone(), high.clone()];
    for index in 0..file.parameters.len() {
        for end in [&low, &high] {
            let mut at = own.clone();
            at[index] = end[index];
            values.push(at);
        }
    }
    values
}
