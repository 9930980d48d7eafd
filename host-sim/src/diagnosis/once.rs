//! What is made when it is first asked for, by several threads.

use std::sync::OnceLock;

/// What a cell holds, made before if it holds nothing.
///
/// Not made under the cell's lock, as [`OnceLock::get_or_init`] does: a thread that waits for others to do their share of the work takes up
/// other work meanwhile, and would wait for itself if that asks for the same cell. Two threads at once may make it twice.
pub(crate) fn made_once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(made) = cell.get() {
        return made;
    }
    let made = make();
    cell.get_or_init(|| made)
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;

    #[test]
    fn work_that_is_taken_up_in_between_may_ask_for_the_same() {
        let cell = OnceLock::new();
        let sum = || (0..1000_u64).into_par_iter().map(std::hint::black_box).sum::<u64>();
        let asked: Vec<u64> = (0..64).into_par_iter().map(|_| *made_once(&cell, sum)).collect();
        assert!(asked.iter().all(|sum| *sum == 499_500));
    }
}
