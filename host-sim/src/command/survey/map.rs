//! `grid.tif`: the anomaly on a grid.

use towmag_export::{Raster, geotiff};
use towmag_survey::Survey;
use towmag_survey::map::anomaly_map;

use super::summary::GridSummary;
use crate::error::HostError;
use crate::output::OutputDir;

/// Write it, where there are positions.
pub(super) fn write(
    output: &OutputDir,
    survey: &Survey,
    cell_m: Option<f64>,
) -> Result<Option<GridSummary>, HostError> {
    let Some(grid) = survey.grid else { return Ok(None) };
    let epsg = grid.epsg();
    let Some(raster) =
        anomaly_map(&survey.tows, cell_m).map_err(|error| HostError::Usage(format!("--grid-m: {error}")))?
    else {
        return Ok(None);
    };
    let towmag_survey::map::Raster { west_m, north_m, cell_m, width, height, values, line_distance_m } = raster;
    output.write("grid.tif", geotiff(&Raster { epsg, west_m, north_m, cell_m, width, values: &values })?)?;
    Ok(Some(GridSummary { epsg, cell_m, width, height, line_distance_m }))
}
