//! Statistics that a pass feeds row by row. What they remember does not grow with the recording.

mod continuity;
mod envelope;
mod heading;
mod running_std;
mod welch;

pub use self::envelope::{Bin, Envelope, EnvelopeCollector};
pub use self::heading::{HeadingSectors, HeadingStd, SECTORS, SectorStd};
pub use self::running_std::RunningStd;
pub use self::welch::{AmplitudeSpectrum, Welch};
