//! `sample_slip`: samples lost or counted twice shift the scalar for good. From `time_s` on, `s'(t) = s(t - 0.1 samples)`.

use super::parts::{TIME_S, has_begun, middle_s, real, retimed};
use crate::effects::{Change, CoefficientDependence, Domain, Draw, Effect, Kind, Parameter, Search, Spec};
use crate::simulator::signals::Signals;

/// The effect `sample_slip`.
#[derive(Debug)]
pub struct SampleSlip;

/// What one sample is, s.
const SAMPLE_S: f64 = 0.1;

const PARAMETERS: &[Parameter] = &[
    TIME_S,
    Parameter { domain: Domain::Whole, ..real("samples", "samples", [-20.0, 20.0], [-15.0, 15.0], Kind::Searched) },
];

const SPEC: Spec = Spec {
    name: "sample_slip",
    title: "a slip of the scalar by whole samples",
    what: "from one moment on, the scalar reading is shifted by whole samples",
    origin: "a sentence lost or a buffer read twice where samples are matched by their number",
    source: "one lost sample of a swing of 19 nT/s is 1.9 nT",
    model: "from `time_s` on, `s'(t) = s(t - 0.1 samples)`",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Proportional,
    // What lies between them is found from the next.
    search: Search::Onset { sizes: &[-1.0, 1.0, -2.0, 2.0, -3.0, 3.0, -5.0, 5.0, -8.0, 8.0, -12.0, 12.0] },
    portable: false,
    injectable: true,
    ..Spec::BASE
};

impl Effect for SampleSlip {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, signals: &Signals) -> Vec<f64> {
        vec![middle_s(signals), 1.0]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let (from_s, late_s) = (parameters[0], SAMPLE_S * parameters[1].round());
        retimed(signals, |row, time_s| if has_begun(signals, row, from_s) { time_s - late_s } else { time_s })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;

    #[test]
    fn rows_repeat_rows_of_before() {
        let signals = signals();
        // The recording's own axis starts at 100 s.
        let change = SampleSlip.change(&signals, &[130.05, 3.0], &mut no_draw()).scalar_nt;
        let clean_nt = signals.scalar_at_rows_nt();
        for row in 0..signals.len() {
            let expected_nt = if row <= 300 { 0.0 } else { clean_nt[row - 3] - clean_nt[row] };
            assert!((change[row] - expected_nt).abs() < 1e-3, "{row}");
        }
    }
}
