//! What whoever diagnoses is asked.

/// One recording to diagnose. Nothing in it tells what it hides.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// What messages call the recording, such as `recording 7`.
    pub name: &'a str,
    /// The recording, as the text of a CSV file.
    pub recording: &'a str,
    /// A second recording of the same body on another course, to try the findings on: what `diagnose --confirm` takes.
    pub confirm: Option<&'a str>,
    /// A simulation of the recording's track, at another rate and by another clock: what `diagnose --simulation` takes.
    pub simulation: Option<&'a str>,
    /// Effects to leave out of the library: `diagnose --withhold`.
    pub withheld: &'a [String],
    /// Seed of everything that the diagnosis draws.
    pub seed: u64,
}
