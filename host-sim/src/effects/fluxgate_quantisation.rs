//! `fluxgate_quantisation`: each component of the fluxgate is rounded to a multiple of a step, noise and all.

use super::parts::real;
use crate::effects::{Change, Channel, Draw, Effect, Kind, Parameter, Readings, Search, Spec};
use crate::simulator::signals::Signals;

/// The effect `fluxgate_quantisation`.
#[derive(Debug)]
pub struct FluxgateQuantisation;

const PARAMETERS: &[Parameter] = &[real("step_nT", "nT", [0.0, 10_000.0], [0.5, 100.0], Kind::Searched)];

const SPEC: Spec = Spec {
    name: "fluxgate_quantisation",
    title: "coarse steps of the fluxgate",
    what: "the fluxgate is read in coarse steps",
    origin: "a converter of few bits, or a log with few digits",
    source: "16 bits over +-100,000 nT are steps of 3.05 nT",
    model: "components rounded to multiples of the step",
    parameters: PARAMETERS,
    channel: Channel::Fluxgate,
    random: true,
    search: Search::ExactMultiples,
    injectable: true,
    ..Spec::BASE
};

impl Effect for FluxgateQuantisation {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, _: &Signals, _: &[f64], _: &mut Draw) -> Change {
        Change::default()
    }

    fn after_noise(&self, _: &Signals, parameters: &[f64], readings: &mut Readings, _: &mut Draw) {
        let step_nt = parameters[0];
        if step_nt > 0.0 {
            readings.flux_nt.iter_mut().flatten().for_each(|nt| *nt = (*nt / step_nt).round() * step_nt);
        }
    }

    /// Of a component that crosses many steps: a twelfth of the step's square.
    fn variance(&self, signals: &Signals, parameters: &[f64]) -> Option<Change> {
        Some(Change::of_flux(vec![[parameters[0] * parameters[0] / 12.0; 3]; signals.len()]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{change_of_clean, no_draw};
    use crate::simulator::signals::tests::signals;

    #[test]
    fn readings_are_multiples_of_the_step_and_as_far_off_as_they_can_be() {
        let signals = signals();
        let change = change_of_clean(&FluxgateQuantisation, &signals, &[3.05], &mut no_draw());
        let (mut sum, mut largest) = (0.0, 0.0_f64);
        for (change, f) in change.flux_nt.iter().zip(&signals.rows().flux_nt) {
            for i in 0..3 {
                let steps = (f[i] + change[i]) / 3.05;
                assert!((steps - steps.round()).abs() < 1e-6);
                (sum, largest) = (sum + change[i] * change[i], largest.max(change[i].abs()));
            }
        }
        assert!(largest <= 1.525 + 1e-9);
        let expected = FluxgateQuantisation.variance(&signals, &[3.05]).unwrap().flux_nt[0][0];
        assert!((sum / 1800.0 / expected - 1.0).abs() < 0.1);
    }
}
