//! The search of both channels of a recording: what each is asked, and in which order.

use towmag::model::TERMS;

use super::base::BaseFit;
use super::findings::ExactFindings;
use super::noise::blocks::Block;
use super::noise::model::IsNoise;
use super::recording::Recording;
use super::search::multiples::quantisation_grid;
use super::search::recorded::RecordedColumn;
use super::selection::{Asked, Selection, select};
use crate::effects::{self, Channel, Library, no_draw};
use crate::simulator::signals::Signals;

/// The search of both channels: the fluxgate first, whose correction gives the scalar its direction.
pub(super) struct Search<'a, 'b> {
    pub(super) recording: &'b Recording<'a>,
    pub(super) library: &'a Library,
    pub(super) base: &'b BaseFit,
    pub(super) withheld: &'b [String],
    /// Recorded columns that are taken off.
    pub(super) columns: &'b [RecordedColumn],
}

impl<'a> Search<'a, '_> {
    /// Whether two effects are one, or driven by the same recorded column.
    fn is_same_column(&self, one: usize, other: usize) -> bool {
        let column = |effect: usize| self.library[effect].recorded().map(|recorded| recorded.column);
        one == other || column(one).is_some_and(|of_one| column(other) == Some(of_one))
    }

    /// The fluxgate's magnitude, and the vector corrected by what was found.
    pub(super) fn fluxgate(&self, blocks: &[Block]) -> (Selection<'a>, Vec<[f64; 3]>) {
        let flux_nt = &self.recording.table.flux_nt;
        let coefficients = *self.recording.start.coefficients();
        let reading = self.base.fluxgate_magnitude_nt(self.recording.table, blocks);
        let select = |flux_nt| self.selected(Channel::Fluxgate, reading.clone(), flux_nt, coefficients, blocks);
        let first = select(flux_nt);
        if first.accepted.is_empty() {
            return (first, flux_nt.clone());
        }
        // Once more with the direction that the corrected fluxgate gives.
        let second = select(&corrected(flux_nt, &first));
        let corrected = corrected(flux_nt, &second);
        (second, corrected)
    }

    /// What needs no fit of an effect, of the effects that may be named: readings that repeat, or come in steps, beyond what
    /// any recorder's rounding makes of them. Repeats are told in the rows that `is_known` says the model knows.
    pub(super) fn exact(&self, fluxgate: &Selection<'_>, is_known: &[bool]) -> ExactFindings {
        let Recording { table, rounding, .. } = self.recording;
        let found_by = |search: effects::Search| {
            (0..self.library.len()).find(|&index| {
                let spec = self.library[index].spec();
                spec.search == search && self.is_allowed(spec)
            })
        };
        let grid = || quantisation_grid(table, rounding, fluxgate.noise.std_nt()?.powi(2));
        ExactFindings {
            repeats: found_by(effects::Search::ExactRepeats)
                .and_then(|index| Some((index, self.base.repeats(table, rounding, is_known)?))),
            multiples: found_by(effects::Search::ExactMultiples).and_then(|index| Some((index, grid()?))),
        }
    }

    fn is_allowed(&self, spec: &effects::Spec) -> bool {
        !self.withheld.iter().any(|name| name == spec.name)
    }

    /// The scalar, with the direction of a fluxgate.
    pub(super) fn scalar(&self, flux_nt: &[[f64; 3]], blocks: &[Block]) -> Selection<'a> {
        let mut reading = self.recording.table.to_explain_nt();
        for column in self.columns {
            reading.iter_mut().zip(&column.column_nt).for_each(|(reading, nt)| *reading -= nt);
        }
        self.selected(Channel::Scalar, reading, flux_nt, self.base.coefficients, blocks)
    }

    fn selected(
        &self,
        channel: Channel,
        reading: Vec<f64>,
        flux_nt: &[[f64; 3]],
        coefficients: [f64; TERMS],
        blocks: &[Block],
    ) -> Selection<'a> {
        let Recording { table, reconstruction, .. } = self.recording;
        let is_allowed = |&index: &usize| {
            let spec = self.library[index].spec();
            let is_taken_off = self.columns.iter().any(|column| self.is_same_column(column.term.effect, index));
            spec.channel == channel && self.is_allowed(spec) && !is_taken_off
        };
        let trajectory = reconstruction.trajectory(table, flux_nt, &self.base.field_nt);
        select(Asked {
            library: self.library,
            channel,
            signals: Signals::new(trajectory, coefficients),
            reading,
            blocks,
            allowed: &(0..self.library.len()).filter(is_allowed).collect::<Vec<_>>(),
            direction_noise: Some(self.recording.direction_noise.clone()),
            is_noise: IsNoise::OfASensor,
            holds_terms: table.beyond.held.is_some(),
            known: Vec::new(),
        })
    }
}

/// A fluxgate less what the named effects add to it.
fn corrected(flux_nt: &[[f64; 3]], selection: &Selection<'_>) -> Vec<[f64; 3]> {
    let mut flux_nt = flux_nt.to_vec();
    let problem = &selection.problem;
    for term in &selection.fit.terms {
        let effect = &problem.library[term.effect];
        let change = effect.change(&problem.signals, &term.parameters(problem.library), &mut no_draw());
        for (flux, change) in flux_nt.iter_mut().zip(&change.flux_nt) {
            flux.iter_mut().zip(change).for_each(|(component, change)| *component -= change);
        }
    }
    flux_nt
}
