//! Statistics that a pass feeds row by row. What they remember does not grow with the recording.

mod continuity;
mod envelope;
mod figure_of_merit;
mod fourth_difference;
mod heading;
mod noise_floor;
mod running_std;
mod welch;

pub use self::envelope::{Bin, Envelope, EnvelopeCollector};
pub use self::figure_of_merit::{FigureOfMerit, MANOEUVRES, MeritCell, MeritCollector};
pub use self::fourth_difference::FourthDifference;
pub use self::heading::{HeadingSectors, HeadingStd, SECTORS, SectorStd};
pub use self::noise_floor::NoiseFloor;
pub use self::running_std::RunningStd;
pub use self::welch::{AmplitudeSpectrum, Welch};
