//! Finds contacts one after another: what is found is fitted jointly and taken off, until noise explains the rest.

mod chosen;
mod fitting;
mod judging;
mod left;
mod pruning;

use std::ops::Range;

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::alternatives::Alternative;
use super::body;
use super::dipole::Dipole;
use super::levelled::{Levelled, Options, RATE_HZ};
use super::noise::Noise;
use super::null::NullRate;
use super::scan::Peak;
use super::stretch::{Stretch, stretches};
use super::way::Way;
use super::whitening::{Transform, Whitener};
use super::window::Fitted;
use crate::level::{Coefficients, MODEL_ERROR, TOLD, combine};

/// Candidates are told from noise less strictly than contacts: what is left in would be noise to all others, and a false one
/// costs nothing.
const CANDIDATES_PER_HOUR: f64 = 10.0;
/// Of the false contacts that are stated, the share that noise makes; what strong iron and slow rock leave makes the others. Set by hand on
/// seeds 61 to 160 of the trial, 33 hours at a stated one an hour: of 37 false ones 18 had a signal to noise above 5.7, beyond that of noise.
const SHARE_OF_NOISE: f64 = 0.3;
/// Rounds at most; each finds all that stand apart, so that a round serves one more of each group of neighbours.
const MOST_ROUNDS: usize = 12;
/// And before them so many at most in the noise of the quietest pieces: on laps past strong iron all others have some, and it would be
/// the noise that hides the rest of it. What was found so has to stand out of the noise of all pieces then.
const MOST_QUIET_ROUNDS: usize = 8;
/// Times that fits and noise take turns before the next are looked for.
const SETTLED: usize = 2;
/// Peaks of one round are further apart than so many of the larger distance: nearer, one may be the flank of the other.
const APART: f64 = 2.5;
/// Dipoles nearer than so many of both distances are fitted jointly.
const JOINT: f64 = 4.0;
/// Half the window in which a contact is held against what else it may be, rows: two periods of a swell.
const JUDGED_ROWS: f64 = 150.0;
/// Of the threshold, what a contact must explain beyond its neighbours: found in what others left, the joint fit shares it anew.
const LEAST_SHARE: f64 = 0.7;

/// A contact at work.
#[derive(Clone, Debug)]
pub(super) struct Located {
    pub(super) stretch: usize,
    pub(super) fitted: Fitted,
    /// What one that is as likely differs from it by, in its columns.
    deviation: [f64; 5],
    /// What of its anomaly it may not describe, as a share.
    model_error: f64,
}

/// What was looked at and is no contact: it is not looked at again.
#[derive(Clone, Debug)]
struct Rejected {
    stretch: usize,
    cells: Range<usize>,
    /// Peaks of smaller distances are other objects: slow rock is no reason to pass over iron that lies on it.
    least_distance_s: f64,
}

/// A search at work, and its result.
pub(super) struct Search<'a> {
    levelled: &'a Levelled<'a>,
    pub(super) options: Options,
    pub(super) way: Way,
    /// The combinations of the 18 terms that can be told, less their means, in units of their spread.
    terms: Vec<[f64; TOLD]>,
    pub(super) stretches: Vec<Stretch>,
    transforms: Vec<Transform>,
    /// The field, less steps; NaN where a reading was false.
    field_nt: Vec<f64>,
    /// What compensation has wrong, a row each, to be taken off the field.
    body_nt: Vec<f64>,
    pub(super) found: Vec<Located>,
    rejected: Vec<Rejected>,
    pub(super) noise: Noise,
    pub(super) null: NullRate,
}

impl<'a> Search<'a> {
    pub(super) fn new(levelled: &'a Levelled<'a>, options: Options) -> Self {
        Self::on(Way::by(options.way_by, levelled), levelled, options)
    }

    /// On the way that `options` ask for.
    pub(super) fn on(way: Way, levelled: &'a Levelled<'a>, options: Options) -> Self {
        let stretches = stretches(levelled);
        let transforms: Vec<Transform> = stretches.iter().map(|s| Transform::of(s.rows.len())).collect();
        let noise = Noise::measured(&stretches, &transforms, true, options.coefficients == Coefficients::Still);
        let null = NullRate::of(&noise.spectrum, options.distances_s);
        let terms = scaled(levelled.terms.iter().map(combine).collect());
        let field_nt = levelled.field_nt.to_vec();
        let body_nt = vec![0.0; field_nt.len()];
        let (found, rejected) = (Vec::new(), Vec::new());
        Self { levelled, options, way, terms, stretches, transforms, field_nt, body_nt, found, rejected, noise, null }
    }

    pub(super) fn run(&mut self) {
        // Where coefficients move it is the noise itself that changes.
        let quiet_rounds = if self.is_still() { MOST_QUIET_ROUNDS } else { 1 };
        for _ in 0..quiet_rounds {
            self.tell_apart();
            if !self.found.is_empty() {
                self.refit();
                self.tell_apart();
            }
            if !self.finds_more() {
                break;
            }
        }
        self.settle();
        self.null = NullRate::of(&self.noise.spectrum, self.options.distances_s);
        self.prune();
        for round in 0..MOST_ROUNDS {
            if round > 0 {
                self.settle();
            }
            if !self.finds_more() {
                break;
            }
        }
    }

    /// Takes what stands out of the noise, all that is apart at once.
    fn finds_more(&mut self) -> bool {
        let left = self.left();
        let peaks = self.peaks(&left);
        self.null = NullRate::of(&self.noise.spectrum, self.options.distances_s);
        self.scale_null(&peaks);
        let chosen = self.chosen(&peaks);
        if chosen.is_empty() {
            return false;
        }
        let judged: Vec<_> = chosen.par_iter().map(|peak| self.judged(&left, peak, &peaks)).collect();
        chosen.iter().zip(judged).for_each(|(peak, judged)| self.take(peak, judged));
        self.refit();
        self.prune();
        true
    }

    /// Fits and noise agree: fits made with too much noise miss, and what they miss is noise to the next.
    fn settle(&mut self) {
        for _ in 0..SETTLED {
            self.measure_noise(false);
            self.fit_body();
            self.refit();
        }
        self.measure_noise(false);
    }

    /// Body and noise beside what is known, which may not be fitted well yet.
    fn tell_apart(&mut self) {
        self.fit_body();
        self.measure_noise(true);
    }

    /// `is_first`: before contacts are fitted in it.
    fn measure_noise(&mut self, is_first: bool) {
        let left = if is_first { self.left() } else { self.left_as_noise() };
        self.noise = Noise::measured(&left, &self.transforms, is_first, self.is_still());
    }

    /// A body whose coefficients do not move leaves nothing behind once they are right.
    fn is_still(&self) -> bool {
        self.options.coefficients == Coefficients::Still
    }

    /// The body beside the contacts.
    fn fit_body(&mut self) {
        if !self.is_still() {
            return;
        }
        self.body_nt.fill(0.0);
        let whiteners: Vec<Whitener<'_>> =
            self.transforms.iter().map(|transform| Whitener::new(transform, &self.noise.spectrum)).collect();
        let coefficients = body::coefficients(&self.terms, &self.left(), &whiteners);
        let interference = |terms: &[f64; TOLD]| terms.iter().zip(coefficients).map(|(a, b)| a * b).sum();
        self.body_nt = self.terms.iter().map(interference).collect();
    }

    /// What a candidate has to explain.
    fn threshold(&self) -> f64 {
        self.null.threshold(CANDIDATES_PER_HOUR.max(self.options.false_alarms_per_hour))
    }

    /// What a contact has to explain.
    pub(super) fn threshold_of_contacts(&self) -> f64 {
        self.null.inside_threshold(SHARE_OF_NOISE * self.options.false_alarms_per_hour)
    }

    /// Begin with what was found in another level.
    pub(super) fn begin_with(&mut self, dipoles: &[Dipole]) {
        let located = |dipole: &Dipole| {
            let row = self.way.row_at(dipole.at);
            let stretch = self.stretches.iter().position(|stretch| stretch.cell_near(row).is_some())?;
            let fitted = Fitted { dipole: *dipole, glrt: f64::INFINITY, gram: Matrix3::identity() };
            Some(Located { stretch, fitted, deviation: [0.0; 5], model_error: MODEL_ERROR })
        };
        self.found = dipoles.iter().filter_map(located).collect();
        if !self.found.is_empty() {
            self.tell_apart();
            self.settle();
        }
    }

    fn take(&mut self, peak: &Peak, judged: Option<Result<Fitted, Alternative>>) {
        let Peak { stretch, cell, distance_s, .. } = *peak;
        match judged {
            Some(Ok(fitted)) => {
                self.found.push(Located { stretch, fitted, deviation: [0.0; 5], model_error: MODEL_ERROR })
            }
            Some(Err(Alternative::Spike(start))) => {
                let rows = &self.stretches[stretch].rows;
                rows[start..(start + 2).min(rows.len())]
                    .iter()
                    .flatten()
                    .for_each(|row| self.field_nt[*row] = f64::NAN);
                self.reject(stretch, cell, 1.0, 0.0);
            }
            Some(Err(Alternative::Step(start, nt))) => {
                self.stretches[stretch].rows[start..].iter().flatten().for_each(|row| self.field_nt[*row] -= nt);
                self.reject(stretch, cell, 1.0, 0.0);
            }
            // Where compensation is wrong, it is so for a while.
            Some(Err(Alternative::Terms(_))) => {
                self.reject(stretch, cell, (APART * distance_s * RATE_HZ).max(JUDGED_ROWS), 0.0);
            }
            None => self.reject_alike(stretch, cell, distance_s),
        }
    }

    /// What is as far away as one that was no dipole, or further.
    fn reject_alike(&mut self, stretch: usize, cell: usize, distance_s: f64) {
        self.reject(stretch, cell, APART * distance_s * RATE_HZ, self.options.alike * distance_s);
    }

    fn reject(&mut self, stretch: usize, cell: usize, rows: f64, least_distance_s: f64) {
        let cells = cell.saturating_sub(rows as usize)..cell + rows as usize + 1;
        self.rejected.push(Rejected { stretch, cells, least_distance_s });
    }

    pub(super) fn levelled(&self) -> &'a Levelled<'a> {
        self.levelled
    }
}

/// The terms less their means, in units of their spread.
fn scaled(terms: Vec<[f64; TOLD]>) -> Vec<[f64; TOLD]> {
    let known = || terms.iter().filter(|row| row.iter().all(|x| x.is_finite()));
    let count = known().count().max(1) as f64;
    let mean: [f64; TOLD] = std::array::from_fn(|k| known().map(|row| row[k]).sum::<f64>() / count);
    let spread: [f64; TOLD] =
        std::array::from_fn(|k| (known().map(|row| (row[k] - mean[k]).powi(2)).sum::<f64>() / count).sqrt());
    let scale = |x: f64, k: usize| if spread[k] > 0.0 && x.is_finite() { (x - mean[k]) / spread[k] } else { 0.0 };
    terms.iter().map(|row| std::array::from_fn(|k| scale(row[k], k))).collect()
}
