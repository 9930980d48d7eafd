//! What a test of the residual says.

/// What one of the tests says.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub(crate) what: &'static str,
    /// Logarithm of its chance under noise, all tries of the test counted.
    pub(crate) log_p: f64,
    /// Whitened power that it is about, over what noise has.
    pub(crate) excess: f64,
}
