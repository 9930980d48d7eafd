//! Whether a peak is a dipole, or what else it may be.

use super::pruning::is_same;
use super::{JUDGED_ROWS, LEAST_SHARE, Search};
use crate::contacts::alternatives::{self, Alternative};
use crate::contacts::dipole::Dipole;
use crate::contacts::fit::{climb, modes};
use crate::contacts::levelled::RATE_HZ;
use crate::contacts::scan::Peak;
use crate::contacts::stretch::Stretch;
use crate::contacts::window::{Fitted, Source, Window};

/// What else than a dipole a contact may be is looked for within so many distances of it.
const ABOUT: f64 = 2.5;
/// Where a climb begins about the track: below, or to a side.
const SIDES_RAD: [f64; 3] = [0.0, -1.0, 1.0];
/// What lies beside a candidate is looked for at so many peaks, and so many are taken at most.
const MOST_TRIED: usize = 6;
const MOST_BESIDE: usize = 2;
/// Together they leave at most this share of what the terms leave: of a compensation that is wrong the terms leave noise, and that no
/// dipoles halve. Set by hand; with the evidence of both in its place 60 tows over land had four objects fewer (docs/tried.md).
const MOST_OF_TERMS: f64 = 0.5;

impl Search<'_> {
    /// The dipole of a peak, or what else it is. `peaks` are all that there are, the largest first.
    pub(super) fn judged(&self, left: &[Stretch], peak: &Peak, peaks: &[Peak]) -> Option<Result<Fitted, Alternative>> {
        let site = Site::of(self, left, peak)?;
        let mut fitted = site.start.climb(&site.window)?;
        // The rate of noise is that of peaks: the best of several distances is above the threshold more often.
        if fitted.glrt > self.threshold_of_contacts() {
            fitted = modes(&site.window, fitted, site.start.range).swap_remove(0);
        }
        let is_known = site.neighbours.iter().any(|other| is_same(other, &fitted.dipole));
        if fitted.glrt < LEAST_SHARE * self.threshold() || is_known {
            return None;
        }
        let Some(alternative) = site.better(fitted.glrt) else { return Some(Ok(fitted)) };
        match alternative {
            Alternative::Terms(left) => {
                Some(site.beside_others(fitted.dipole, MOST_OF_TERMS * left, peaks).ok_or(alternative))
            }
            Alternative::Spike(_) | Alternative::Step(..) => Some(Err(alternative)),
        }
    }

    /// Where the fit of a peak begins.
    fn start(&self, peak: &Peak) -> Start {
        let row = self.stretches[peak.stretch].row_near(peak.cell);
        let per_s = self.way.per_s[row];
        Start { at: self.way.at[row], distance: peak.distance_s * per_s, range: self.range(per_s) }
    }
}

/// Where a fit begins, on the way, and the bounds of its distance.
struct Start {
    at: f64,
    distance: f64,
    range: [f64; 2],
}

impl Start {
    fn climb(&self, window: &Window<'_>) -> Option<Fitted> {
        climb(window, (self.at, self.distance), &SIDES_RAD, self.range)
    }

    fn is_same(&self, other: &Dipole) -> bool {
        is_same(&Dipole { at: self.at, distance: self.distance, ..*other }, other)
    }
}

/// A peak where it is judged.
struct Site<'s> {
    search: &'s Search<'s>,
    source: Source<'s>,
    peak: &'s Peak,
    start: Start,
    /// Contacts that are fitted jointly.
    neighbours: Vec<Dipole>,
    /// Beside them.
    window: Window<'s>,
}

impl<'s> Site<'s> {
    fn of(search: &'s Search<'_>, left: &'s [Stretch], peak: &'s Peak) -> Option<Self> {
        let (source, start) = (search.source(left, peak.stretch, false), search.start(peak));
        let neighbours = search.neighbours(start.at, start.distance, None);
        let window = window(&source, peak, &neighbours)?;
        Some(Self { search, source, peak, start, neighbours, window })
    }

    /// What does as well as a dipole that explains `glrt`.
    fn better(&self, glrt: f64) -> Option<Alternative> {
        let off = ABOUT * self.peak.distance_s * RATE_HZ;
        let about = [self.peak.cell as f64 - off, self.peak.cell as f64 + off + 1.0];
        let about = about.map(|cell| self.window.starts.partition_point(|start| (*start as f64) < cell));
        alternatives::better(&self.window, glrt, about, &self.search.terms)
    }

    /// The dipole beside others that are not taken off yet: what these leave, many terms explain better than one dipole does. `None` where
    /// all together leave more than `most` whitened squares.
    fn beside_others(&self, mut own: Dipole, most: f64, peaks: &[Peak]) -> Option<Fitted> {
        let mut others: Vec<Dipole> = Vec::new();
        while others.len() < MOST_BESIDE {
            others.push(self.next(&[&others[..], &[own]].concat(), peaks)?);
            let joint = self.beside(&others)?;
            let fitted = self.start.climb(&joint)?;
            if joint.z.norm_squared() - fitted.glrt < most {
                return Some(fitted);
            }
            own = fitted.dipole;
        }
        None
    }

    /// What explains most beside these.
    fn next(&self, taken: &[Dipole], peaks: &[Peak]) -> Option<Dipole> {
        let window = self.beside(taken)?;
        let cells = *window.starts.first()?..=*window.starts.last()?;
        let is_near = |peak: &&Peak| peak.stretch == self.peak.stretch && cells.contains(&peak.cell);
        let starts = peaks.iter().filter(is_near).map(|peak| self.search.start(peak));
        let apart = starts.filter(|start| !taken.iter().any(|other| start.is_same(other))).take(MOST_TRIED);
        let fits = apart.filter_map(|start| start.climb(&window));
        let fits = fits.filter(|fitted| !taken.iter().any(|other| is_same(other, &fitted.dipole)));
        fits.max_by(|a, b| a.glrt.total_cmp(&b.glrt)).map(|fitted| fitted.dipole)
    }

    /// The same window, where these are fitted too.
    fn beside(&self, others: &[Dipole]) -> Option<Window<'s>> {
        window(&self.source, self.peak, &[&self.neighbours, others].concat())
    }
}

fn window<'s>(source: &Source<'s>, peak: &Peak, neighbours: &[Dipole]) -> Option<Window<'s>> {
    Window::about(source, &source.stretch.values, (peak.cell, peak.distance_s, JUDGED_ROWS), neighbours)
}
