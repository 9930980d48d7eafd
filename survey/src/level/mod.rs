//! The field at its level: all 18 terms, coefficients that move, and the background as a slow random process.
