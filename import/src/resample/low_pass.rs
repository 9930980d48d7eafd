//! The filter against aliases.

/// Half of the power goes at this frequency, Hz; what the 10 Hz cannot show begins at 5.
pub(super) const CUT_HZ: f64 = 4.5;
/// From the last frequency that passes to the first that is stopped, Hz: 4 to 5.
const TRANSITION_HZ: f64 = 1.0;
/// What is stopped is this much weaker, dB.
const STOPPED_DB: f64 = 90.0;
/// A low-pass of finite length, linear phase, centred: Kaiser's window over the ideal one (Kaiser 1974; Oppenheim and Schafer,
/// Discrete-Time Signal Processing, section 7.5.3).
#[derive(Clone, Debug)]
pub(super) struct LowPass {
    /// It reaches so far to either side, s.
    pub(super) half_s: f64,
    beta: f64,
    at_zero: f64,
}

impl LowPass {
    pub(super) fn new() -> Self {
        let beta = 0.1102 * (STOPPED_DB - 8.7);
        let half_s = (STOPPED_DB - 7.95) / (14.36 * TRANSITION_HZ) / 2.0;
        Self { half_s, beta, at_zero: bessel_i0(beta) }
    }

    /// Of a reading that is `t_s` away.
    pub(super) fn weight(&self, t_s: f64) -> f64 {
        let x = t_s / self.half_s;
        if x.abs() >= 1.0 {
            return 0.0;
        }
        let window = bessel_i0(self.beta * (1.0 - x * x).sqrt()) / self.at_zero;
        let phase = 2.0 * std::f64::consts::PI * CUT_HZ * t_s;
        let ideal = if phase == 0.0 { 1.0 } else { phase.sin() / phase };
        window * ideal
    }
}

/// The modified Bessel function of order 0, by its series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        term *= quarter / f64::from(k * k);
        sum += term;
        if term < 1e-16 * sum {
            break;
        }
    }
    sum
}
