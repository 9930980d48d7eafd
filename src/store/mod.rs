//! What the body keeps through a power cut besides its log: all that an operator can set, and the 18 coefficients.
//!
//! ```text
//! console: set name value -> Parameter -> BodySettings --+
//!          calibrate accept -> Coefficients -------------+-> Stored -> image with CRC-32 -> SettingsStore -> flash
//! ```

mod body_settings;
mod error;
mod flash;
mod image;
mod in_flash;
mod parameter;
mod scan;

pub use body_settings::{BodySettings, CABLE_BAUD, CABLE_BAUDS, LOG_FILE_HOURS, SCALAR_BAUD, Stored};
pub use error::StoreError;
pub use flash::SettingsStore;
pub use image::{IMAGE_VERSION, SLOT_LEN};
pub use in_flash::{SaveError, SettingsInFlash};
pub use parameter::{LONGEST_NAME, Parameter, SetError, ValueText};
pub use scan::{Condition, FlashSectors, Opened};
