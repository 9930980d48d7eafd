//! Which cells a map has.

use crate::navigation::Navigation;
use crate::tow::Tow;

/// More would take more than a few seconds and 16 MB.
const MOST_CELLS: f64 = 4e6;

/// Why there is no grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// Cells too small for the area.
    #[error(
        "cells of {cell_m} m make a grid of {width} by {height}, at most {MOST_CELLS} cells are made: give larger ones"
    )]
    TooManyCells {
        /// As asked for.
        cell_m: f64,
        /// Cells from west to east.
        width: f64,
        /// Cells from south to north.
        height: f64,
    },
    /// The places cannot be triangulated.
    #[error("the track cannot be gridded: {0}")]
    Triangulation(#[from] spade::InsertionError),
}

/// Whether cells of this size are not too many for where the readings of recordings are: to be asked before they are surveyed.
///
/// # Errors
///
/// When the cells are too small.
pub fn check_cells(tows: &[Tow], navigation: &Navigation, cell_m: f64) -> Result<(), MapError> {
    let tracks =
        tows.iter().zip(&navigation.tows).filter_map(|(tow, navigated)| Some((tow, navigated.track.as_ref()?)));
    let places = tracks.flat_map(|(tow, track)| {
        let of_row = |row: usize| [track.easting_m[row], track.northing_m[row]];
        (0..tow.len()).filter(|row| tow.is_usable[*row]).map(of_row)
    });
    let places = places.filter(|place_m| place_m.iter().all(|metres| metres.is_finite()));
    // Without a place there is no map.
    if places.clone().next().is_none() { Ok(()) } else { Frame::around(places, cell_m).checked().map(|_| ()) }
}

/// Edges in cells from the origin of the grid, so that maps of two days lie cell on cell.
pub(super) struct Frame {
    pub(super) cell_m: f64,
    pub(super) west: f64,
    pub(super) north: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Frame {
    /// All places, and a cell more on each side.
    pub(super) fn around(places: impl Iterator<Item = [f64; 2]> + Clone, cell_m: f64) -> Self {
        let ends = |axis: usize| {
            let cells = || places.clone().map(move |place_m| (place_m[axis] / cell_m).floor());
            [cells().fold(f64::INFINITY, f64::min) - 1.0, cells().fold(f64::NEG_INFINITY, f64::max) + 2.0]
        };
        let ([west, east], [south, north]) = (ends(0), ends(1));
        Self { cell_m, west, north, width: east - west, height: north - south }
    }

    /// How many cells that is.
    pub(super) fn cells(&self) -> f64 {
        self.width * self.height
    }

    /// `self`, if that is not too many cells.
    pub(super) fn checked(self) -> Result<Self, MapError> {
        let Self { cell_m, width, height, .. } = self;
        if self.cells() > MOST_CELLS { Err(MapError::TooManyCells { cell_m, width, height }) } else { Ok(self) }
    }
}
