//! How strong effects are that are hidden: their rms over that of the noise.

/// The strengths that are asked for, each met within a fifth.
pub(crate) const STRENGTHS: [f64; 3] = [1.0, 3.0, 10.0];

/// The one that a strength, given by its natural logarithm, was drawn about.
pub(crate) fn nearest(log_strength: f64) -> f64 {
    let far = |strength: &f64| (strength.ln() - log_strength).abs();
    STRENGTHS.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(STRENGTHS[0])
}
