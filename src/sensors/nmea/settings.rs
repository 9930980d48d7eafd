//! What is set about the third UART.

/// What a sensor that tells metres below itself, or its depth, is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthIs {
    /// A pressure sensor that sends its depth below the surface as if it were an echo sounder.
    Depth,
    /// An echo sounder that looks down: the metres below it are the altitude of the body.
    #[default]
    Altitude,
}

/// Settings of the third UART and of what is read from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NmeaSettings {
    /// Baud rate, 4,800 to 115,200.
    pub baud: u32,
    /// What DPT and DBT tell.
    pub depth_is: DepthIs,
    /// What the pressure sensor shows at the surface, dbar, 0 to 20: 0 where it was set to zero there, about 10.1 where it
    /// shows the air's pressure as well.
    pub surface_dbar: f64,
}

impl Default for NmeaSettings {
    /// The baud rate of the standard.
    fn default() -> Self {
        Self { baud: 4_800, depth_is: DepthIs::default(), surface_dbar: 0.0 }
    }
}
