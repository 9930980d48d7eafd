//! The ways in which a diagnosis finds first values of an effect. An effect says which one is its own; the diagnosis has
//! the algorithms, and knows no effect by name.

/// How the first values of an effect are found on what a fit leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// It is linear in all parameters: one least-squares fit.
    Linear,
    /// One parameter, to which the change is nearly in proportion: secant steps from each of these values.
    Secant {
        /// In the parameter's unit.
        starts: &'static [f64],
    },
    /// Any nonlinear effect: each of these points is tried, its linear coordinates fitted, and the best one refined by the
    /// joint fit. As many points as there are distinct shapes; each holds all parameters.
    Profile {
        /// Points of the parameters, the linear ones 0.
        starts: &'static [&'static [f64]],
    },
    /// Any effect of which nothing is known but the ranges of its parameters: points all over those of the nonlinear ones are
    /// tried, their linear coordinates fitted, and the best ones followed uphill.
    Ranges,
    /// It sets in at a moment, the first parameter, and stays: every row is tried. Its size is linear, or one of these
    /// values of the second parameter.
    Onset {
        /// In the second parameter's unit; empty where the size is linear.
        sizes: &'static [f64],
    },
    /// Third and fourth power of the cosine to an axis: azimuth and elevation, then the two linear parameters.
    Axis,
    /// A steady sine: its frequency is the first parameter; the linear coordinates are sine and cosine.
    Tone,
    /// A vector that is switched on and off: three linear parameters, then period, duty and phase.
    PulseTrain,
    /// Random, with a variance in proportion to the square of the first parameter: its size is fitted at each of these
    /// points, which hold all parameters, the first one 1.
    Variance {
        /// Points of the parameters.
        starts: &'static [&'static [f64]],
    },
    /// Random noise within a cone about an axis, in either sense: azimuth, elevation, half angle and noise.
    Cone,
    /// Readings that repeat the one before exactly: found before any fit. One parameter, the probability.
    ExactRepeats,
    /// Readings that are exact multiples of a step: found before any fit. One parameter, the step.
    ExactMultiples,
}

impl Search {
    /// Whether a moment, a period, a frequency or a cone is looked for, so that chance has many tries.
    pub(crate) fn tries_many(self) -> bool {
        matches!(self, Self::Onset { .. } | Self::Tone | Self::PulseTrain | Self::Cone)
    }
}
