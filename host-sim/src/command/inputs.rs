//! What a command reads is never what it writes, and what it writes is nobody else's.

use std::path::Path;

use crate::error::HostError;
use crate::output::OutputDir;

/// Refuse to write a result over what it is made from, or over a file that this program has not written.
pub(super) fn keep_inputs(inputs: &[&Path], out: &Path, results: &[&str]) -> Result<(), HostError> {
    for input in inputs {
        let Ok(input_found) = input.canonicalize() else { continue };
        if results.iter().any(|result| out.join(result).canonicalize().is_ok_and(|found| found == input_found)) {
            let (input, out) = (input.display(), out.display());
            return Err(HostError::Usage(format!(
                "{input} would be replaced by a result: choose another --out than {out}"
            )));
        }
    }
    Ok(OutputDir::check(out, results)?)
}
