//! Parts of a series that a cross-validation holds out, fold by fold.

use std::ops::Range;

use crate::diagnosis::policy::HELD_OUT_FOLDS;

/// Some successive samples of a block, which one fold holds out.
pub(crate) struct Part {
    pub(crate) samples: Range<usize>,
    pub(crate) block: usize,
    pub(crate) fold: usize,
}

/// Parts of `length` samples of some blocks, so short that none holds all of an event. Which fold has one turns round, so
/// that nothing periodic is always in the same.
pub(crate) fn parts(blocks: &[Range<usize>], length: usize) -> Vec<Part> {
    let of_block = |(block, range): (usize, &Range<usize>)| {
        let range = range.clone();
        range.clone().step_by(length).map(move |start| (block, start..(start + length).min(range.end)))
    };
    let all = blocks.iter().enumerate().flat_map(of_block);
    let fold = |index: usize| (index + index / HELD_OUT_FOLDS) % HELD_OUT_FOLDS;
    all.enumerate().map(|(index, (block, samples))| Part { samples, block, fold: fold(index) }).collect()
}

/// The part of a column that the parameters of a fold are fitted to.
pub(crate) fn training(parts: &[Part], column: &[f64], fold: usize) -> Vec<f64> {
    let used = parts.iter().filter(|part| part.fold != fold);
    used.flat_map(|part| column[part.samples.clone()].iter().copied()).collect()
}
