//! Parts of a series that a cross-validation holds out, fold by fold.

use std::ops::Range;

use crate::diagnosis::policy::{BOOTSTRAP_SAMPLES, FOLD_MOST_OF_SIGNAL, HELD_OUT_FOLDS, HELD_OUT_SAMPLES};
use crate::diagnosis::regression::products::dot;

/// Some successive samples of a block, which one fold holds out.
pub(crate) struct Part {
    pub(crate) samples: Range<usize>,
    pub(crate) block: usize,
    /// Piece of its block that a bootstrap draws as one.
    piece: usize,
    pub(crate) fold: usize,
}

/// Parts of `length` samples of some blocks, so short that none holds all of an event. Which fold has one turns round, so
/// that nothing periodic is always in the same.
pub(crate) fn parts(blocks: &[Range<usize>], length: usize) -> Vec<Part> {
    let of_block = |(block, range): (usize, &Range<usize>)| {
        let Range { start, end } = *range;
        let part = move |from: usize| (block, (from - start) / BOOTSTRAP_SAMPLES, from..(from + length).min(end));
        range.clone().step_by(length).map(part)
    };
    let all = blocks.iter().enumerate().flat_map(of_block);
    let fold = |index: usize| (index + index / HELD_OUT_FOLDS) % HELD_OUT_FOLDS;
    let of = |(index, (block, piece, samples))| Part { samples, block, piece, fold: fold(index) };
    all.enumerate().map(of).collect()
}

/// Parts so short that no fold holds most of a signal, which the others would not know then; the longest that are.
pub(crate) fn spread_parts(blocks: &[Range<usize>], signal: &[f64]) -> Vec<Part> {
    let cut = |length: usize| {
        let parts = parts(blocks, length);
        (most_of_one_fold(&parts, signal), parts)
    };
    let most = FOLD_MOST_OF_SIGNAL * dot(signal, signal);
    let mut best = cut(HELD_OUT_SAMPLES[0]);
    for &length in &HELD_OUT_SAMPLES[1..] {
        if best.0 <= most {
            break;
        }
        let shorter = cut(length);
        if shorter.0 < best.0 {
            best = shorter;
        }
    }
    best.1
}

/// Values of the parts, summed up by piece of a block: of each part by itself where they are so short because a block may hold all of an event.
pub(crate) fn by_unit<T>(parts: &[Part], values: Vec<T>, sum: impl Fn(&T, &T) -> T) -> Vec<T> {
    let is_once = parts.first().is_some_and(|part| part.samples.len() < HELD_OUT_SAMPLES[0]);
    if is_once {
        return values;
    }
    let mut units: Vec<((usize, usize), T)> = Vec::new();
    for (part, value) in parts.iter().zip(values) {
        let own = (part.block, part.piece);
        match units.last_mut() {
            Some((piece, unit)) if *piece == own => *unit = sum(unit, &value),
            _ => units.push((own, value)),
        }
    }
    units.into_iter().map(|(_, unit)| unit).collect()
}

/// Power of a signal in the fold that has most of it.
fn most_of_one_fold(parts: &[Part], signal: &[f64]) -> f64 {
    let mut folds = [0.0; HELD_OUT_FOLDS];
    for part in parts {
        let signal = &signal[part.samples.clone()];
        folds[part.fold] += dot(signal, signal);
    }
    folds.into_iter().fold(0.0, f64::max)
}

/// The part of a column that the parameters of a fold are fitted to.
pub(crate) fn training(parts: &[Part], column: &[f64], fold: usize) -> Vec<f64> {
    let used = parts.iter().filter(|part| part.fold != fold);
    used.flat_map(|part| column[part.samples.clone()].iter().copied()).collect()
}
