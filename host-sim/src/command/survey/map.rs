//! `grid.tif`: the anomaly on a grid.

use towmag_export::{Raster, geotiff};
use towmag_survey::map::{MapError, anomaly_map, check_cells};
use towmag_survey::navigation::Navigation;
use towmag_survey::{Survey, Tow};

use super::summary::GridSummary;
use crate::error::HostError;
use crate::output::OutputDir;

/// Whether cells of this size are not too many for where the recordings were.
pub(super) fn check(tows: &[Tow], navigation: &Navigation, cell_m: Option<f64>) -> Result<(), HostError> {
    cell_m.map_or(Ok(()), |cell_m| check_cells(tows, navigation, cell_m).map_err(of_option))
}

fn of_option(error: MapError) -> HostError {
    HostError::Usage(format!("--grid-m: {error}"))
}

/// Write it, where there are positions.
pub(super) fn write(
    output: &OutputDir,
    survey: &Survey,
    cell_m: Option<f64>,
) -> Result<Option<GridSummary>, HostError> {
    let Some(grid) = survey.grid else { return Ok(None) };
    let epsg = grid.epsg();
    let Some(raster) = anomaly_map(&survey.tows, cell_m).map_err(of_option)? else {
        return Ok(None);
    };
    let towmag_survey::map::Raster { west_m, north_m, cell_m, width, height, values, line_distance_m } = raster;
    output.write("grid.tif", geotiff(&Raster { epsg, west_m, north_m, cell_m, width, values: &values })?)?;
    Ok(Some(GridSummary { epsg, cell_m, width, height, line_distance_m }))
}
